#include "figure/drag.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "number/angle.hpp"
#include "system/input_error.hpp"

namespace achilles {

Vector start_towards(const Model& model, const Run& run, const Vector& q) {
    Run moved = run;
    const auto can_start = [&](double share) {
        moved.q = share == 1.0 ? q : Vector(run.q + share * (q - run.q));
        try {
            model.check(moved);
            return true;
        } catch (const InputError&) {
            return false;
        }
    };
    if (can_start(1.0)) return q;
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 30; ++i) {
        const double middle = 0.5 * (low + high);
        (can_start(middle) ? low : high) = middle;
    }
    return run.q + low * (q - run.q);
}

namespace {

// The gaps of a start as constraints on its coordinates.
class DraggedGaps {
 public:
    DraggedGaps(const Model& model, const Run& run) : state_(run.start()) {
        for (std::size_t i = 0; i < model.contacts(); ++i)
            terms_.push_back(model.evaluator(model.programs_of(i).contact_terms, run.parameters));
    }

    // The contact that is penetrated most, in units of the coordinates, apart from those that are kept.
    std::optional<std::size_t> deepest(const Vector& q, ContactSet kept) {
        std::optional<std::size_t> found;
        double most = 0.0;
        for (std::size_t i = 0; i < terms_.size(); ++i) {
            if (kept.contains(i)) continue;
            const auto [h, gradient] = at(i, q);
            const double depth = -h / gradient.norm();
            if (depth > most) most = depth, found = i;
        }
        return found;
    }

    // The least gap, in units of the coordinates.
    double least(const Vector& q) {
        double least = HUGE_VAL;
        for (std::size_t i = 0; i < terms_.size(); ++i) {
            const auto [h, gradient] = at(i, q);
            least = std::min(least, h / gradient.norm());
        }
        return least;
    }

    // Gaps that are kept a little above 0, so that rounding does not make a start that is refused.
    KeptFunctions kept(const Vector& q, ContactSet contacts) {
        constexpr double above = 1e-9;  // in units of the coordinates
        KeptFunctions result{Eigen::VectorXd(contacts.count()), Eigen::MatrixXd(contacts.count(), q.size())};
        Eigen::Index row = 0;
        for (const std::size_t contact : contacts) {
            const auto [h, gradient] = at(contact, q);
            result.values[row] = h - above * gradient.norm();
            result.gradients.row(row++) = gradient.transpose();
        }
        return result;
    }

 private:
    std::pair<double, Vector> at(std::size_t contact, const Vector& q) {
        auto& terms = terms_[contact];
        state_.q = q;
        set_state(terms, state_);
        terms.run();
        Vector gradient(q.size());
        for (Eigen::Index i = 0; i < q.size(); ++i) gradient[i] = terms.gradient(static_cast<std::size_t>(i));
        return {terms.h(), gradient};
    }

    State state_;
    std::vector<ContactTerms<Evaluator<double>>> terms_;
};

}  // namespace

Vector dragged_start(const Model& model, const Run& run, AnchorPoint& point, const Point& place) {
    State state = run.start();
    const auto distance = [&](const Vector& q) {
        state.q = q;
        const Point at = point.at(state.t, state).at;
        return std::hypot(at.x - place.x, at.y - place.y);
    };
    DraggedGaps gaps(model, run);
    ContactSet kept;
    std::vector<Vector> wanted;  // with ever more gaps kept
    for (bool is_penetrated = true; is_penetrated;) {
        const auto q =
            held_at(point, state.t, run.start(), place, [&](const Vector& at) { return gaps.kept(at, kept); });
        if (!q) break;
        wanted.push_back(*q);
        const auto next = gaps.deepest(*q, kept);
        is_penetrated = next.has_value();
        if (next) kept = kept.with(*next);
    }
    // The last one lies on the surfaces. The first one is tried where the run cannot start from there.
    for (const Vector* q : {wanted.empty() ? nullptr : &wanted.back(), wanted.empty() ? nullptr : &wanted.front()}) {
        if (q == nullptr) break;
        const Vector start = start_towards(model, run, *q);
        if (distance(start) < distance(run.q)) return start;
    }
    return run.q;
}

Vector change_per_pixel(const Body& body, Eigen::Index count, double unit) {
    Vector most = Vector::Zero(count);
    for (const Point& pixel : {Point{1.0 / unit, 0.0}, Point{0.0, 1.0 / unit}})
        if (const auto change = body.rates(Vector::Zero(count), pixel)) most = most.cwiseMax(change->cwiseAbs());
    return most;
}

Vector rounded_values(const Model& model, const Vector& values, const Vector& per_pixel) {
    Vector rounded = values;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        const bool is_angle = model.description().coordinates[static_cast<std::size_t>(i)].unit == "rad";
        const double unit = is_angle ? degrees(1.0) : 1.0, pixel = per_pixel[i] * unit;
        if (!(pixel > 0.0) || !std::isfinite(pixel)) continue;
        const int decimals = -static_cast<int>(std::floor(std::log10(pixel)));
        const double scale = std::pow(10.0, std::abs(decimals));
        // Divided by a whole power of ten the result is the double nearest to the short decimal number.
        rounded[i] = (decimals >= 0 ? std::round(values[i] * unit * scale) / scale
                                    : std::round(values[i] * unit / scale) * scale) /
                     unit;
    }
    return rounded;
}

Vector rounded_start(const Model& model, const Run& run, const Vector& q, const Vector& per_pixel) {
    constexpr double on_surface = 1e-6;  // in units of the coordinates; dragged_start() keeps 1e-9
    if (DraggedGaps(model, run).least(q) < on_surface) return q;
    const Vector rounded = rounded_values(model, q, per_pixel);
    return start_towards(model, run, rounded) == rounded ? rounded : q;
}

}  // namespace achilles
