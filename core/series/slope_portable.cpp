#include "series/slope_order.hpp"

namespace achilles {

template struct SlopeKind<16>;

}  // namespace achilles
