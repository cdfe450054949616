#include "sensitivity/quantities.hpp"

#include <algorithm>
#include <limits>

#include "expression/parse.hpp"
#include "model/read_expressions.hpp"
#include "sensitivity/gradient.hpp"
#include "simulate/contact_forces.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

// The point where a run is evaluated: its end, or an event.
struct Quantities::EvaluationPoint {
    State state;
    Mode mode;
    ContactSet load_bearing;
    double work = 0.0, loss = 0.0, heat = 0.0;
    std::size_t events = 0;
    // Derivatives of the state, coordinate by direction, and of the time, by direction; empty if there are none.
    std::optional<Derivatives::FinalSensitivity> slopes{};
    RowVectorXd time_slope{};
};

// The inputs of a program at this point, by slot: values, and a row of derivatives if there is one.
class Quantities::Inputs {
 public:
    Inputs(const Trajectory& trajectory, const Derivatives& derivatives, const Model::MeasureProgram& measures,
           const EvaluationPoint& place)
        : trajectory_(trajectory),
          derivatives_(derivatives),
          place_(place),
          model_(*trajectory.model),
          layout_(model_.layout()) {
        K_ = static_cast<Index>(derivatives.refused.size());
        values_.assign(layout_.count() + measures.quantities.size(), 0.0);
        rows_.setZero(static_cast<Index>(values_.size()), K_);
        set_state();
        for (std::size_t i = 0; i < measures.quantities.size(); ++i)
            set_quantity(layout_.count() + i, measures.quantities[i]);
    }
    double value(std::size_t slot) const { return values_[slot]; }
    double row(std::size_t slot, Index k) const { return rows_(static_cast<Index>(slot), k); }
    std::size_t count() const { return values_.size(); }

 private:
    void set(std::size_t slot, double value) { values_[slot] = value; }
    void set(std::size_t slot, double value, const RowVectorXd& row) {
        values_[slot] = value;
        rows_.row(static_cast<Index>(slot)) = row;
    }

    void set_state() {
        const std::size_t n = layout_.dof;
        const auto& slopes = place_.slopes;
        const RowVectorXd none = RowVectorXd::Constant(K_, nothing);
        for (std::size_t i = 0; i < n; ++i) {
            const auto k = static_cast<Index>(i);
            set(layout_.q(i), place_.state.q[k], slopes ? RowVectorXd(slopes->q.row(k)) : none);
            set(layout_.v(i), place_.state.v[k], slopes ? RowVectorXd(slopes->v.row(k)) : none);
        }
        for (std::size_t i = 0; i < layout_.p; ++i) {
            set(layout_.parameter(i), trajectory_.run.parameters[i]);
            const auto column = static_cast<Index>(2 * n + i);
            rows_(static_cast<Index>(layout_.parameter(i)), column) = 1.0;
        }
        set(layout_.t(), place_.state.t, place_.time_slope);
        set(layout_.work(), place_.work, none);
        set(layout_.loss(), place_.loss, none);
        if (layout_.frictions > 0) set(layout_.heat(), place_.heat, none);
        if (!layout_.has_contact_inputs()) return set(layout_.contact(), place_.mode.is_free() ? 0.0 : 1.0);
        set_contacts(none);
    }

    // Sets hddot and lambda of each contact, and the forces of friction.
    void set_contacts(const RowVectorXd& none) {
        const auto& slopes = place_.slopes;
        const std::vector<double>& parameters = trajectory_.run.parameters;
        ContactForces forces(model_, parameters);
        forces.set(place_.state, place_.mode, place_.load_bearing);
        const TangentLayout tangent{layout_.dof, layout_.contacts, layout_.p};
        MatrixXd Z = MatrixXd::Zero(tangent.size(), K_);
        if (slopes) {
            Z.row(TangentLayout::t()) = place_.time_slope;
            Z.middleRows(tangent.q(0), static_cast<Index>(layout_.dof)) = slopes->q;
            Z.middleRows(tangent.v(0), static_cast<Index>(layout_.dof)) = slopes->v;
            for (std::size_t i = 0; i < layout_.p; ++i) Z(tangent.p(i), static_cast<Index>(2 * layout_.dof + i)) = 1.0;
        }
        const auto derivatives_of = [&](const Program& program, std::size_t output) {
            Gradient gradient(model_, program, tangent, parameters);
            gradient.at(place_.state);
            return RowVectorXd(gradient.row(output) * Z);
        };
        // The derivative of lambda or tau (output 0 or 1), which a program gives times a scale.
        const auto quotient_of = [&](std::size_t which, std::size_t output) {
            Gradient gradient(model_, model_.friction_force(which, place_.mode), tangent, parameters);
            gradient.at(place_.state);
            const double scale = gradient.value(2), value = gradient.value(output) / scale;
            return RowVectorXd((gradient.row(output) - value * gradient.row(2)) / scale * Z);
        };
        for (std::size_t k = 0; const auto& [which, law] : model_.equations().friction) {
            const bool acts = slopes && place_.mode.is_held(which);
            set(layout_.friction_force(k++), forces.friction_force(which),
                !slopes ? none
                : acts  ? quotient_of(which, 1)
                        : RowVectorXd(RowVectorXd::Zero(K_)));
        }
        for (std::size_t i = 0; i < layout_.contacts; ++i) {
            const bool held = place_.mode.is_held(i);
            const double a = forces.acceleration(i), f = forces.force(i);
            if (!slopes) {
                set(layout_.acceleration(i), a, none);
                set(layout_.force(i), f, none);
            } else if (held) {
                set(layout_.acceleration(i), a);
                set(layout_.force(i), f,
                    layout_.frictions > 0
                        ? quotient_of(i, 0)
                        : derivatives_of(model_.programs_of(i, model_.unconstrained(place_.mode, i)).force, 0));
            } else {
                set(layout_.force(i), f);
                set(layout_.acceleration(i), a,
                    derivatives_of(model_.motion(place_.mode).program, 2 * layout_.dof + i));
            }
        }
    }

    // Sets a quantity of the k-th event of a kind, or of the last one.
    void set_quantity(std::size_t slot, const RunQuantity& quantity) {
        using Kind = RunQuantity::Kind;
        const auto& events = trajectory_.events;
        const RowVectorXd none = RowVectorXd::Constant(K_, nothing);
        if (quantity.kind == Kind::least_gap) return set(slot, least_gap(trajectory_), none);
        int count = 0;
        std::optional<std::size_t> found;
        for (std::size_t i = 0; i < place_.events; ++i)
            if (events[i].kind == quantity.event && (++count == quantity.k || quantity.k == 0)) found = i;
        if (quantity.kind == Kind::count) return set(slot, count);
        if (!found) return set(slot, nothing, none);
        const bool is_speed = quantity.kind == Kind::speed;
        const double value = is_speed ? events[*found].impact_speed : events[*found].t;
        if (*found >= derivatives_.events.size()) return set(slot, value, none);
        const Derivatives::EventSensitivity& at = derivatives_.events[*found];
        set(slot, value, (is_speed ? at.impact_speed : at.t).transpose());
    }

    const Trajectory& trajectory_;
    const Derivatives& derivatives_;
    const EvaluationPoint& place_;
    const Model& model_;
    const Layout layout_;
    Index K_ = 0;
    std::vector<double> values_;
    MatrixXd rows_;
};

namespace {

// The reason why an expression has no derivatives.
std::string reason_of(const std::string& expression, const Derivatives& derivatives, double value) {
    if (!(value == value)) return "the quantity does not exist in this run";
    for (const std::string& name : names_in(expression))
        if (name == "work" || name == "loss" || name == "least_gap" || name == "heat")
            return "derivatives of " + name + " are not computed";
    if (!derivatives.broken.empty()) return derivatives.broken;
    return "the quantity has none there";
}

}  // namespace

Quantities::Quantities(std::shared_ptr<const Model> model, std::vector<std::string> expressions, const char* option)
    : model_(std::move(model)), expressions_(std::move(expressions)) {
    std::vector<Text> texts;
    for (const std::string& expression : expressions_) {
        compile_option(option, expression, [&](std::span<const Text> one) { return model_->compile_measures(one); });
        texts.push_back({expression, {}});
    }
    if (!texts.empty()) measures_ = model_->compile_measures(texts);
}

std::vector<Quantity> Quantities::of(const Trajectory& trajectory, const Derivatives& derivatives) const {
    const auto K = static_cast<Index>(derivatives.refused.size());
    const EvaluationPoint end{{trajectory.end.q, trajectory.end.v, trajectory.end_time},
                              trajectory.end_mode,
                              trajectory.phases.back().load_bearing,
                              trajectory.work,
                              trajectory.loss,
                              trajectory.heat,
                              trajectory.events.size(),
                              derivatives.end,
                              RowVectorXd::Zero(K)};
    return evaluated({trajectory, derivatives, measures_, end}, derivatives);
}

std::vector<Quantity> Quantities::at(const Trajectory& trajectory, const Derivatives& derivatives, std::size_t event,
                                     ContactSet load_bearing) const {
    const Event& now = trajectory.events[event];
    EvaluationPoint place{{now.q, now.v_after, now.t}, now.mode, load_bearing, now.work, now.loss, now.heat, event + 1};
    place.time_slope = RowVectorXd::Constant(static_cast<Index>(derivatives.refused.size()), nothing);
    if (event < derivatives.events.size()) {
        const Derivatives::EventSensitivity& slopes = derivatives.events[event];
        place.slopes = Derivatives::FinalSensitivity{slopes.q, slopes.v_after};
        place.time_slope = slopes.t.transpose();
    }
    return evaluated({trajectory, derivatives, measures_, place}, derivatives);
}

std::vector<Quantity> Quantities::evaluated(const Inputs& inputs, const Derivatives& derivatives) const {
    std::vector<Quantity> result;
    if (expressions_.empty()) return result;
    constexpr std::size_t lanes = 8;
    using Number = Jet<double, lanes>;
    const auto K = static_cast<Index>(derivatives.refused.size());
    for (const std::string& expression : expressions_)
        result.push_back({expression, nothing, Eigen::VectorXd::Constant(K, nothing), ""});
    for (Index first = 0; first < K; first += lanes) {
        const Index end = std::min(first + static_cast<Index>(lanes), K);
        Evaluator<Number> evaluator(measures_.program);
        for (std::size_t slot = 0; slot < inputs.count(); ++slot) {
            Number input(inputs.value(slot));
            for (Index k = first; k < end; ++k) input.slope[static_cast<std::size_t>(k - first)] = inputs.row(slot, k);
            evaluator.input(slot) = input;
        }
        evaluator.fix();
        evaluator.run();
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i].value = evaluator.output(i).value;
            for (Index k = first; k < end; ++k)
                result[i].derivatives[k] = evaluator.output(i).slope[static_cast<std::size_t>(k - first)];
        }
    }
    for (Quantity& quantity : result) {
        // Refused directions have no derivatives.
        bool any = false;
        for (Index k = 0; k < K; ++k) {
            if (!derivatives.refused[static_cast<std::size_t>(k)].empty()) quantity.derivatives[k] = nothing;
            any = any || quantity.derivatives[k] == quantity.derivatives[k];
        }
        if (!any) quantity.refused = reason_of(quantity.expression, derivatives, quantity.value);
    }
    return result;
}

}  // namespace achilles
