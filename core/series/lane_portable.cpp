#include "series/lane_kind.hpp"

namespace achilles {

template struct LaneKind<16>;

}  // namespace achilles
