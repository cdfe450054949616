// Stand-in for TBB on a page, where a sweep has one thread.
#pragma once

namespace tbb::info {
inline int default_concurrency() { return 1; }
}  // namespace tbb::info
