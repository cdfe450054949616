// What is below the pragma is compiled for AVX-512; see lane_avx512.cpp.
#include <array>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <numbers>
#include <vector>

#include "number/choice.hpp"
#include "series/lane_kinds.hpp"

#ifdef ACHILLES_HAS_AVX512
#pragma GCC target("avx512f")
#include "series/slope_order.hpp"

namespace achilles {

template struct SlopeKind<64>;

}  // namespace achilles
#endif
