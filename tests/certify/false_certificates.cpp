#include "certify/false_certificates.hpp"

#include <algorithm>
#include <cmath>

namespace achilles::test {

namespace {

double norm(const Evaluator<double>& evaluator, std::size_t first, std::size_t n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) sum += evaluator.output(first + i) * evaluator.output(first + i);
    return std::sqrt(sum);
}

// |M g'|/W at the restart. Correct is the maximum of |M^-1 g'|/W around it.
double eta_with_M(const Model& model, const Run& run, const State& state) {
    const Equations& equations = model.equations();
    const ContactEquations& contact = equations.free.contacts[0];
    Graph graph(contact.W.graph());  // a copy, so that the model is unchanged
    const Layout& layout = model.layout();
    const auto n = static_cast<std::size_t>(model.dof());
    std::vector<Expression> outputs;
    for (std::size_t i = 0; i < n; ++i) {
        Expression sum = graph.number(0);
        for (std::size_t j = 0; j < n; ++j) sum = sum + graph.adopt(equations.M[i * n + j]) * graph.adopt(contact.g[j]);
        outputs.push_back(sum / graph.adopt(contact.W));
    }
    const Program program(outputs, Slots{layout.count(), 2 * layout.dof, 2 * layout.dof + layout.p});
    auto evaluator = model.evaluator(program, run.parameters);
    set_state(evaluator, state);
    evaluator.run();
    return norm(evaluator, 0, n);
}

// The interval of theory.md 4 with a_min and a_max exchanged.
void swap_accelerations(Certificate& c, double e, double w) {
    const double a_min = c.a_max, a_max = c.a_min, r = a_max / a_min;
    c.zeno_low = 2.0 * e * (1.0 + e) * w / (a_max * (1.0 - e * e / r));
    c.zeno_high = 2.0 * e * (1.0 + e) * w / (a_min * (1.0 - e * e * r));
}

}  // namespace

Certificate falsified(Certificate c, FalseCertificate lie, const Collision& collision, const Run& run,
                      const Model& model) {
    const double w = collision.speed;
    const double e = model.evaluator(model.restitution(), run.parameters).output(0);
    switch (lie) {
        case FalseCertificate::earliest_time:
            c.zeno_low *= 100.0;
            break;
        case FalseCertificate::latest_time:
            c.zeno_high /= 100.0;
            break;
        case FalseCertificate::position:
            c.position_bound /= 100.0;
            break;
        case FalseCertificate::velocity:
            c.velocity_bound /= 100.0;
            break;
        case FalseCertificate::shadowing_position:
            if (c.shadowing_position) *c.shadowing_position /= 100.0;
            break;
        case FalseCertificate::shadowing_velocity:
            if (c.shadowing_velocity) *c.shadowing_velocity /= 100.0;
            break;
        case FalseCertificate::uniform_position:
            if (c.uniform_position) *c.uniform_position /= 100.0;
            break;
        case FalseCertificate::swapped_accelerations:
            swap_accelerations(c, e, w);
            break;
        case FalseCertificate::eta_with_M:
            if (c.paper) {
                const bool kinetic = c.reinitialization == Reinitialization::kinetic;
                const double jumps = (e + (kinetic ? c.paper->e2 : 1.0)) / (1.0 - c.paper->e2);
                const double eta = eta_with_M(model, run, {collision.before.q, collision.restart});
                const double added = run.options.truncation.eps_v / c.paper->c3 * w;
                c.velocity_bound = std::min(c.velocity_bound, added + jumps * w * (eta - c.paper->eta));
            }
            break;
    }
    return c;
}

}  // namespace achilles::test
