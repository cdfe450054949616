#include "check/simplified.hpp"

#include "check/zeno_condition.hpp"

namespace achilles {

namespace {

// For one formula: a tenth of a second or so. A double pendulum takes a hundredth of it, the general hddot of a triple
// one more.
constexpr long work_of_a_formula = 400000;

}  // namespace

std::optional<Fraction> Simplified::simplify(Expression expression) {
    algebra_->work() = Work{work_of_a_formula};
    try {
        return algebra_->simplify(graph_.adopt(expression));
    } catch (const TooLong&) {
    } catch (const TooLarge&) {
    }
    return std::nullopt;
}

Simplified::Simplified(const Model& model, const Run& run)
    : graph_(model.equations().energy.graph()), algebra_(std::make_unique<Algebra>(graph_, Work{})) {
    const Equations& e = model.equations();
    const ContactEquations& c = e.free.contacts[0];
    const Layout& layout = model.layout();
    ranks_.assign(layout.count(), 0);
    for (std::size_t i = 0; i < layout.dof; ++i) {
        ranks_[layout.q(i)] = 1;
        ranks_[layout.v(i)] = 2;
    }
    for (const Expression entry : e.M) M.push_back(simplify(entry));
    for (const Expression entry : e.bias) bias.push_back(simplify(entry));
    for (const Expression entry : c.g) dh.push_back(simplify(entry));
    hdot = simplify(c.hdot);
    W = simplify(c.W);
    hddot = simplify(c.hddot);
    // lambda = -hddot/W: its own divisions, done before, would be done again.
    if (hddot && W) {
        algebra_->work() = Work{work_of_a_formula};
        try {
            lambda = algebra_->divide({-hddot->numerator, hddot->denominator}, *W);
        } catch (const TooLong&) {
        }
    }
    zeno = zeno_condition(model, run, graph_);
}

}  // namespace achilles
