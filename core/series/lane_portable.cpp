// Lanes and slopes by the vectors that every processor has.
#include "series/lane_steps.hpp"
#include "series/slope_order.hpp"

namespace achilles {

template struct LaneKind<16>;

template struct SlopeKind<16>;

}  // namespace achilles
