#include "check/simplified.hpp"

#include "check/zeno_condition.hpp"

namespace achilles {

namespace {

// For one formula: a tenth of a second or so. A double pendulum takes a hundredth of it, the general hddot of a triple
// one more.
constexpr long work_of_a_formula = 400000;

bool holds_some(const Model& model) { return model.contacts() > 1 && model.contacts() <= Simplified::few_contacts; }

// That hold one contact, where these are looked at and are not too large; else null.
std::unique_ptr<HeldMotions> derived_motions(const Model& model) {
    if (!holds_some(model)) return nullptr;
    try {
        auto motions = std::make_unique<HeldMotions>(model.equations(), model.layout());
        for (std::size_t j = 0; j < model.contacts(); ++j) motions->of(ContactSet::of(j));
        return motions;
    } catch (const TooLarge&) {
        return nullptr;
    }
}

}  // namespace

std::optional<Fraction> Simplified::simplify(Expression expression) {
    if (stop_.stop_requested()) return std::nullopt;
    algebra_->work() = Work{work_of_a_formula};
    try {
        return algebra_->simplify(graph_.adopt(expression));
    } catch (const TooLong&) {
    } catch (const TooLarge&) {
    }
    return std::nullopt;
}

std::optional<ZenoCondition> Simplified::condition(const Model& model, const Run& run,
                                                   const std::vector<const ContactEquations*>& involved) {
    if (stop_.stop_requested()) return std::nullopt;
    return zeno_condition(model, run, involved, graph_);
}

SimplifiedContact Simplified::simplify(const Model& model, const Run& run, std::size_t contact) {
    const ContactEquations& c = model.equations().free.contacts[contact];
    SimplifiedContact result;
    for (const Expression entry : c.g) result.dh.push_back(simplify(entry));
    result.hdot = simplify(c.hdot);
    result.W = simplify(c.W);
    result.hddot = simplify(c.hddot);
    // lambda = -hddot/W: its own divisions, done before, would be done again.
    if (result.hddot && result.W) {
        algebra_->work() = Work{work_of_a_formula};
        try {
            result.lambda = algebra_->divide({-result.hddot->numerator, result.hddot->denominator}, *result.W);
        } catch (const TooLong&) {
        }
    }
    result.zeno = this->condition(model, run, {&c});
    return result;
}

Simplified::Simplified(const Model& model, const Run& run, std::stop_token stop)
    : motions_(derived_motions(model)),
      graph_(motions_ ? motions_->graph() : model.equations().energy.graph()),
      algebra_(std::make_unique<Algebra>(graph_, Work{})),
      stop_(std::move(stop)) {
    const Equations& e = model.equations();
    const Layout& layout = model.layout();
    ranks_.assign(layout.count(), 0);
    for (std::size_t i = 0; i < layout.dof; ++i) {
        ranks_[layout.q(i)] = 1;
        ranks_[layout.v(i)] = 2;
    }
    for (const Expression entry : e.M) M.push_back(simplify(entry));
    for (const Expression entry : e.bias) bias.push_back(simplify(entry));
    for (const Expression entry : e.Q) Q.push_back(simplify(entry));
    for (std::size_t i = 0; i < model.contacts(); ++i) contacts.push_back(simplify(model, run, i));
    for (std::size_t i = 0; i < model.contacts(); ++i)
        for (std::size_t j = 0; j < model.contacts() && motions_; ++j) {
            if (i == j) continue;
            HeldCondition& condition = while_held.emplace_back();
            condition.contact = i;
            condition.held = ContactSet::of(j);
            condition.zeno = this->condition(model, run, {&held_equations(condition), &e.free.contacts[j]});
        }
}

}  // namespace achilles
