// Stand-in for TBB on a page, where a sweep has one thread.
#pragma once

namespace tbb {
struct auto_partitioner {};
struct simple_partitioner {};

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body, const auto_partitioner&) {
    body(range);
}
template <class Index, class Body, class Partitioner = auto_partitioner>
void parallel_for(Index first, Index end, const Body& body, const Partitioner& = {}) {
    for (Index i = first; i < end; ++i) body(i);
}
}  // namespace tbb
