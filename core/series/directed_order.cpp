#include "series/directed_order.hpp"

#include "series/directed_kinds.hpp"
#include "series/lane_stepper.hpp"
#include "series/recurrence.hpp"

namespace achilles {

#ifdef ACHILLES_HAS_AVX512

void make_directed_order(const SeriesPlan& plan, const InnerSums<Directed<16>>& sums,
                         const SeriesTablesOver<Directed<16>>& tables, Directed<16>* row, std::size_t k) {
    static const bool is_wide = possible_vectors().front() != Vectors::portable;
    if (is_wide) return make_directed_order_by_avx512(plan, &sums, &tables, row, k);
    make_motion_order(plan, sums, tables, row, k);
}

#else

void make_directed_order(const SeriesPlan& plan, const InnerSums<Directed<16>>& sums,
                         const SeriesTablesOver<Directed<16>>& tables, Directed<16>* row, std::size_t k) {
    make_motion_order(plan, sums, tables, row, k);
}

#endif

}  // namespace achilles
