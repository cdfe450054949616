// Stand-in for TBB on a page, where a sweep has one thread.
#pragma once

namespace tbb {
template <class Value>
class enumerable_thread_specific {
 public:
    Value& local() { return value_; }

 private:
    Value value_{};
};
}  // namespace tbb
