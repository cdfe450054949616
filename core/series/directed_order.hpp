// One order of a motion with its derivatives in eight directions: make_motion_order() (recurrence.hpp), by the widest vectors
// that the processor has.
#pragma once

#include "number/directed.hpp"
#include "series/order.hpp"

namespace achilles {

template <class Number>
struct InnerSums;

void make_directed_order(const SeriesPlan& plan, const InnerSums<Directed<16>>& sums,
                         const SeriesTablesOver<Directed<16>>& tables, Directed<16>* row, std::size_t k);

}  // namespace achilles
