// What is below the pragma is compiled for AVX-512; see lane_avx512.cpp.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "number/choice.hpp"
#include "series/directed_kinds.hpp"
#include "series/lane_order.hpp"
#include "series/order.hpp"

#ifdef ACHILLES_HAS_AVX512
#pragma GCC target("avx512f")
#include "number/directed.hpp"
#include "series/recurrence.hpp"

namespace achilles {

using Wide = Directed<64>;
template void make_order<Wide>(const SeriesPlan&, const InnerSums<Wide>&, const SeriesTablesOver<Wide>&, std::size_t);
template void make_motion_order<Wide>(const SeriesPlan&, const InnerSums<Wide>&, const SeriesTablesOver<Wide>&, Wide*,
                                      std::size_t);

void make_directed_order_by_avx512(const SeriesPlan& plan, const void* sums, const void* tables, void* row,
                                   std::size_t k) {
    make_motion_order(plan, *static_cast<const InnerSums<Wide>*>(sums),
                      *static_cast<const SeriesTablesOver<Wide>*>(tables), static_cast<Wide*>(row), k);
}

}  // namespace achilles
#endif
