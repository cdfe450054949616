// Stand-in for TBB on a page, where a sweep has one thread.
#pragma once

namespace tbb {
template <class Index>
class blocked_range {
 public:
    blocked_range(Index begin, Index end) : begin_(begin), end_(end) {}
    Index begin() const { return begin_; }
    Index end() const { return end_; }

 private:
    Index begin_, end_;
};
}  // namespace tbb
