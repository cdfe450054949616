// Eight runs in one vector of AVX-512.
#include "series/lane_headers.hpp"

#ifdef ACHILLES_HAS_WIDE_LANES
#pragma GCC target("avx512f")
#define ACHILLES_LANE_BYTES 64
#include "series/lane_instances.hpp"
#endif
