// Times and medians for the benchmark programs.
#pragma once

#include <time.h>

#include <algorithm>
#include <vector>

namespace achilles::bench {

inline double median(std::vector<double> x) {
    const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), middle, x.end());
    return *middle;
}

// Processor time of this thread, s. Other load on the machine does not count.
inline double thread_seconds() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double seconds(const Work& work) {
    const double begin = thread_seconds();
    work();
    return thread_seconds() - begin;
}

}  // namespace achilles::bench
