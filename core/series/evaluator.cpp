#include "series/evaluator.hpp"

namespace achilles {

template class SeriesEvaluator<double>;

}  // namespace achilles
