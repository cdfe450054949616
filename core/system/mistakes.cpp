#include "system/mistakes.hpp"

#include <algorithm>
#include <tuple>

#include "system/input_error.hpp"

namespace achilles {

namespace {

constexpr std::size_t most_kept = 1000;  // in the order of reading; nobody corrects more at once
constexpr std::size_t most_told = 10;

}  // namespace

void Mistakes::add(Mistake mistake) {
    ++count_;
    if (kept_.size() < most_kept) kept_.push_back(std::move(mistake));
}

void Mistakes::raise(const SystemDescription& system) const {
    if (count_ == 0) return;
    std::vector<Mistake> sorted = kept_;
    const auto place = [](const Mistake& mistake) { return std::tuple(mistake.at.line, mistake.at.column); };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Mistake& a, const Mistake& b) { return place(a) < place(b); });
    std::vector<InputError> told;
    for (std::size_t i = 0; i < std::min(sorted.size(), most_told); ++i)
        told.emplace_back(system.file, sorted[i].at, sorted[i].message, sorted[i].hint,
                          sorted[i].has_line ? line_of(system.source_text, sorted[i].at.line) : "");
    const std::size_t more = count_ - told.size();
    throw InputErrors(std::move(told), more);
}

}  // namespace achilles
