#include "study/bounds_along.hpp"

namespace achilles {

std::optional<BoundsAlong> BoundsAlong::of(const Model& model, const Program& section,
                                           std::span<const double> parameters) {
    const Layout& layout = model.layout();
    const std::vector<bool> asked = section.inputs_of(1);
    bool is_known = !asked[layout.work()];
    for (std::size_t i = 0; i < layout.contacts; ++i)
        is_known = is_known && !asked[layout.acceleration(i)] && !asked[layout.force(i)];
    if (!is_known) return std::nullopt;
    return BoundsAlong(model, section, parameters);
}

BoundsAlong::BoundsAlong(const Model& model, const Program& section, std::span<const double> parameters)
    : layout_(model.layout()),
      variables_(2 * layout_.dof),
      section_(model.evaluator<Interval>(section, parameters)),
      rates_(variables_) {}

Interval BoundsAlong::value(const Trajectory& trajectory, const Piece& piece, double from, double to) {
    const Interval start(piece.start), length = Interval(piece.end) - start;
    const Interval theta = (Interval(from, to) - start) / length;
    const double* const coefficients = trajectory.coefficients.data() + piece.first;
    for (std::size_t i = 0; i < variables_; ++i) {
        Interval sum(0.0), slope(0.0);  // by theta
        for (std::size_t k = piece.degree + 1; k-- > 0;) {
            const Interval c(coefficients[variables_ * k + i]);
            if (k > 0) slope = slope * theta + Interval(static_cast<double>(k)) * c;
            sum = sum * theta + c;
        }
        section_.input(i) = sum;
        rates_[i] = slope / length;
    }
    section_.clock() = Interval(from, to);
    section_.input(layout_.contact()) = Interval(piece.held.empty() ? 0.0 : 1.0);
    section_.input(layout_.loss()) = Interval(piece.loss);
    section_.run();
    return section_.output(0);
}

Interval BoundsAlong::rate() {
    Interval sum = section_.output(1);
    for (std::size_t i = 0; i < variables_; ++i) sum = sum + section_.output(2 + i) * rates_[i];
    return sum;
}

}  // namespace achilles
