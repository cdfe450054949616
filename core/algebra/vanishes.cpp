#include "algebra/vanishes.hpp"

#include <stdexcept>

#include "algebra/algebra.hpp"

namespace achilles {

bool vanishes(Expression expression) {
    if (expression.is_zero()) return true;
    constexpr long work = 400000;
    Graph graph(expression.graph());
    Algebra algebra(graph, Work{work});
    try {
        return algebra.simplify(graph.adopt(expression)).is_zero();
    } catch (const TooLong&) {
    } catch (const std::domain_error&) {
    }
    return false;
}

}  // namespace achilles
