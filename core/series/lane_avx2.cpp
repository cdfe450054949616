// Eight runs in two vectors of AVX2.
#include "series/lane_headers.hpp"

#ifdef ACHILLES_HAS_WIDE_LANES
#pragma GCC target("avx2")
#define ACHILLES_LANE_BYTES 32
#include "series/lane_instances.hpp"
#endif
