// The functions of one vector size, ACHILLES_LANE_BYTES. Included only by the source file of that size, after the
// pragma that selects these vectors. Functions of lane_headers.hpp that take or return lanes are instantiated by name.
#include "series/lane_steps.hpp"

namespace achilles {

using LanesOfFile = Lanes<ACHILLES_LANE_BYTES>;
template LanesOfFile scalar_pi<LanesOfFile>();
template LanesOfFile integer_power<LanesOfFile>(const LanesOfFile&, int);
template void Evaluator<LanesOfFile>::execute(std::size_t, std::size_t);
template void SeriesProgram::fix(const LanesOfFile*, LanesOfFile*, std::array<LanesOfFile, 3>*) const;
template void SeriesProgram::start(LanesOfFile*, const LanesOfFile*, std::array<LanesOfFile, 3>*) const;

template struct LaneKind<ACHILLES_LANE_BYTES>;

}  // namespace achilles
