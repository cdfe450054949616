// The same order by AVX-512: numbers of eight directions are the same bytes whichever vectors work on them, and so are the tables
// and inner sums over them, which are passed as such.
#pragma once

#include "series/lane_kinds.hpp"
#include "series/order.hpp"

namespace achilles {

#ifdef ACHILLES_HAS_AVX512
void make_directed_order_by_avx512(const SeriesPlan& plan, const void* sums, const void* tables, void* row,
                                   std::size_t k);
#endif

}  // namespace achilles
