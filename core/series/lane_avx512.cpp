// Everything below the pragma is compiled for AVX-512. Headers included above it are not, even if their templates are
// instantiated below, because other files may share them. Their functions that take or return lanes are instantiated by
// name.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <type_traits>
#include <vector>

#include "contacts/contact_law.hpp"
#include "number/angle.hpp"
#include "number/double8.hpp"
#include "number/polynomial.hpp"
#include "program/machine.hpp"
#include "program/program.hpp"
#include "series/lane_kinds.hpp"
#include "series/lane_stepper.hpp"
#include "series/order.hpp"
#include "series/series.hpp"

#ifdef ACHILLES_HAS_AVX512
#pragma GCC target("avx512f")
#include "series/lane_steps.hpp"

namespace achilles {

using Wide = Lanes<64>;
template Wide scalar_pi<Wide>();
template Wide integer_power<Wide>(const Wide&, int);
template void Evaluator<Wide>::execute(std::size_t, std::size_t);
template void SeriesProgram::fix(const Wide*, Wide*, std::array<Wide, 3>*) const;
template void SeriesProgram::start(Wide*, const Wide*, std::array<Wide, 3>*) const;

template struct LaneKind<64>;

}  // namespace achilles
#endif
