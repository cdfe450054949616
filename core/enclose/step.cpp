#include "enclose/step.hpp"

#include <algorithm>
#include <cmath>

#include "number/double_double.hpp"
#include "number/jet.hpp"
#include "series/series_over.hpp"

namespace achilles {

namespace {

constexpr int K = EnclosureStepper::order;

Interval power(const Interval& x, int n) { return integer_power(x, n); }

// The intersection; the first interval if rounding has made the intersection empty.
Interval intersection(const Interval& a, const Interval& b) {
    const double lo = std::max(a.lo(), b.lo()), hi = std::min(a.hi(), b.hi());
    return lo <= hi ? Interval(lo, hi) : a;
}

}  // namespace

// sum_k table_k tau^k, for every coordinate.
Intervals EnclosureStep::along(const Intervals& table, const Interval& tau) const {
    Intervals result(table.end() - static_cast<std::ptrdiff_t>(size_), table.end());
    for (int k = K - 1; k >= 0; --k) {
        const Interval* const row = coefficients(table, k);
        for (std::size_t i = 0; i < size_; ++i) result[i] = times(result[i], tau) + row[i];
    }
    return result;
}

Intervals EnclosureStep::center_at(const Interval& tau) const { return along(center_, tau); }

Intervals EnclosureStep::rate_at(const Interval& tau) const {
    Intervals result(size_);
    for (int k = K; k >= 1; --k) {
        const Interval* const row = coefficients(center_, k);
        for (std::size_t i = 0; i < size_; ++i)
            result[i] = times(result[i], tau) + times(Interval(static_cast<double>(k)), row[i]);
    }
    return result;
}

IntervalMatrix EnclosureStep::slope_at(const Interval& tau) const {
    IntervalMatrix result = slopes_.back();
    for (std::size_t k = slopes_.size() - 1; k-- > 0;)
        for (std::size_t i = 0; i < size_; ++i)
            for (std::size_t j = 0; j < size_; ++j) result(i, j) = times(result(i, j), tau) + slopes_[k](i, j);
    return result;
}

Intervals EnclosureStep::remainder_at(const Interval& tau) const {
    Intervals result;
    const Interval scale = power(tau, K + 1);
    for (const Interval& entry : remainder_) result.push_back(times(entry, scale));
    return result;
}

Intervals EnclosureStep::box_over(const Doubleton& set, const Interval& tau) const {
    const Interval middle(mid(tau));
    Intervals plain = along(hull_, tau), sharp = center_at(middle);
    const Intervals rate = rate_at(tau), remainder = remainder_at(tau);
    const IntervalMatrix slope = slope_at(tau);
    for (std::size_t i = 0; i < size_; ++i) {
        sharp[i] = sharp[i] + times(rate[i], tau - middle) + set.along(slope.row(i));
        plain[i] = intersection(sharp[i], plain[i]) + remainder[i];
    }
    return plain;
}

void EnclosureStep::advance(Doubleton& set, double tau) const {
    const Interval at(tau);
    Intervals center = center_at(at);
    const Intervals remainder = remainder_at(at);
    for (std::size_t i = 0; i < size_; ++i) center[i] += remainder[i];
    set.map(center, slope_at(at));
}

EnclosureStepper::EnclosureStepper(const Model& model, const Coordinates& coordinates, Mode mode)
    : coordinates_(coordinates),
      mode_(mode),
      variables_(coordinates.of_motion()),
      at_center_(make_expansion(model.hddot_series(mode), coordinates, ExpansionMode::point)),
      over_hull_(make_expansion(model.hddot_series(mode), coordinates, ExpansionMode::box_with_derivatives)),
      over_box_(make_expansion(model.hddot_series(mode), coordinates, ExpansionMode::box)) {}

// The scale of each coordinate along a step, for error tolerances. For h and u it is the scale of the flight, because
// after an impact their relative accuracy is kept.
std::vector<double> EnclosureStepper::scales(const Intervals& hull, double length) const {
    const std::size_t n = coordinates_.dof;
    std::vector<double> result(coordinates_.size(), 0.0);
    double position = 0.0, velocity = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double v = mag(hull[coordinates_.v(i)]), a = std::abs(mid(at_center_->value(1, n + i)));
        position = std::max(position, result[coordinates_.q(i)] = mag(hull[coordinates_.q(i)]) + v * length);
        velocity = std::max(velocity, result[coordinates_.v(i)] = v + a * length);
    }
    for (std::size_t i = 0; i < n; ++i) {
        result[coordinates_.q(i)] = std::max(result[coordinates_.q(i)], 0.01 * position);
        result[coordinates_.v(i)] = std::max(result[coordinates_.v(i)], 0.01 * velocity);
    }
    for (std::size_t i = 0; i < coordinates_.contacts; ++i) {
        const std::size_t h = coordinates_.h(i), u = coordinates_.u(i);
        result[u] = mag(hull[u]) + std::abs(mid(at_center_->value(0, event(i)))) * length;
        result[h] = mag(hull[h]) + result[u] * length;
    }
    return result;
}

// The length at which the last two terms at the center are small compared with the present uncertainty.
double EnclosureStepper::first_length(const Doubleton&, const Intervals& hull, double longest) const {
    const std::size_t n = coordinates_.dof;
    double length = longest;
    const auto limit = [&](double coefficient, double tolerance, int k) {
        if (coefficient > 0.0 && tolerance > 0.0)
            length = std::min(length, std::pow(tolerance / coefficient, 1.0 / static_cast<double>(k)));
    };
    const std::vector<double> scale = scales(hull, std::min(longest, last_ > 0.0 ? last_ : 1.0));
    for (const int k : {K - 1, K}) {
        for (std::size_t i = 0; i < 2 * n; ++i) {
            const std::size_t row = coordinates_.q(i);
            limit(std::abs(mid(at_center_->value(k, i))), std::max(3e-18 * scale[row], 1e-6 * rad(hull[row])), k);
        }
        for (std::size_t i = event(0); i < event(coordinates_.contacts); ++i) {
            const double size =
                std::abs(mid(at_center_->value(0, i))) + std::abs(mid(at_center_->value(1, i))) * length;
            limit(std::abs(mid(at_center_->value(k, i))), 3e-18 * size + 1e-6 * rad(over_hull_->value(0, i)), k);
        }
    }
    return length;
}

// Finds the a-priori box: the polynomial over [0, length] plus +-eps. It is accepted if the remainder over it is
// strictly less than eps.
bool EnclosureStepper::enclose(EnclosureStep& step, const Intervals& hull, double length) {
    const std::size_t n = coordinates_.dof;
    const Interval span(0.0, length), middle(0.5 * length), whole = power(Interval(length), K + 1);
    Intervals box = hull;
    box[Coordinates::t()] = hull[Coordinates::t()] + span;
    std::vector<double> eps(2 * n);
    const std::vector<double> scale = scales(hull, length);
    Intervals base(2 * n);
    for (std::size_t i = 0; i < 2 * n; ++i) {
        Interval plain = over_hull_->value(K, i), at = plain, rate = times(Interval(K), plain);
        for (int k = K - 1; k >= 0; --k) {
            const Interval c = over_hull_->value(k, i);
            plain = times(plain, span) + c;
            at = times(at, middle) + c;
            if (k > 0) rate = times(rate, span) + times(Interval(k), c);
        }
        base[i] = intersection(plain, at + times(rate, span - middle));
        eps[i] = 4.0 * mag(times(over_hull_->value(K + 1, i), whole)) + 0x1p-200 * scale[coordinates_.q(i)];
        if (!std::isfinite(eps[i])) return false;
    }
    for (int round = 0; round < 6; ++round) {
        for (std::size_t i = 0; i < 2 * n; ++i) box[coordinates_.q(i)] = base[i] + Interval(-eps[i], eps[i]);
        over_box_->expand(box, K);
        bool strict = over_box_->has_mass();
        for (std::size_t i = 0; i < 2 * n; ++i) {
            const double remainder = mag(times(over_box_->value(K + 1, i), whole));
            if (!std::isfinite(remainder)) return false;
            if (remainder < eps[i]) continue;
            strict = false;
            eps[i] = 2.0 * remainder;
        }
        if (!strict) continue;
        step.length_ = length;
        step.remainder_.assign(coordinates_.size(), Interval(0.0));
        for (std::size_t i = 0; i < 2 * n; ++i) step.remainder_[coordinates_.q(i)] = over_box_->value(K + 1, i);
        for (std::size_t i = 0; i < coordinates_.contacts; ++i) {
            if (keeps_gap(i)) continue;
            step.remainder_[coordinates_.h(i)] = over_box_->value(K - 1, event(i)) / Interval(K * (K + 1));
            step.remainder_[coordinates_.u(i)] = over_box_->value(K, event(i)) / Interval(K + 1);
        }
        return true;
    }
    return false;
}

// The Taylor coefficients of all coordinates: h'' = hddot for an open contact; h and u of a held contact are constant.
void EnclosureStepper::tabulate(EnclosureStep& step, const Doubleton& set, const std::vector<OpenGapBound>& openings) {
    const Coordinates& z = coordinates_;
    const std::size_t size = z.size(), n = z.dof;
    step.size_ = size;
    step.center_.assign((K + 1) * size, Interval(0.0));
    step.hull_.assign((K + 1) * size, Interval(0.0));
    step.slopes_.assign(K + 1, IntervalMatrix(size, size));
    const auto fill = [&](int k, std::size_t row, const Interval& center, const Interval& hull) {
        step.center_[static_cast<std::size_t>(k) * size + row] = center;
        step.hull_[static_cast<std::size_t>(k) * size + row] = hull;
    };
    const auto copy = [&](int k, std::size_t row, int from, std::size_t i, const Interval& share) {
        fill(k, row, times(at_center_->value(from, i), share), times(over_hull_->value(from, i), share));
        for (std::size_t j = 0; j < variables_.size(); ++j)
            step.slopes_[static_cast<std::size_t>(k)](row, variables_[j]) = times(over_hull_->slope(from, i, j), share);
    };
    for (std::size_t i = 0; i < size; ++i) {
        fill(0, i, Interval(set.center(i)), set.hull(i));
        step.slopes_[0](i, i) = Interval(1.0);
    }
    fill(1, Coordinates::t(), Interval(1.0), Interval(1.0));
    for (int k = 1; k <= K; ++k)
        for (std::size_t i = 0; i < 2 * n; ++i) copy(k, z.q(i), k, i, Interval(1.0));
    for (std::size_t i = 0; i < z.contacts; ++i) {
        if (keeps_gap(i)) continue;
        const std::size_t h = z.h(i), u = z.u(i);
        fill(1, h, Interval(set.center(u)), set.hull(u));
        step.slopes_[1](h, u) = Interval(1.0);
        for (int k = openings[i].known == KnownRoot::released ? 1 : 0; k < K; ++k) {
            copy(k + 1, u, k, event(i), Interval(1.0) / Interval(k + 1));
            if (k + 2 <= K) copy(k + 2, h, k, event(i), Interval(1.0) / Interval((k + 1) * (k + 2)));
        }
    }
}

Intervals EnclosureStepper::watch(const EnclosureStep& step, const Doubleton& set, std::size_t contact,
                                  const OpenGapBound& opening) const {
    switch (law_of(mode_.state(contact)).watched) {
        case WatchedFunction::gap:
            return watch_gap(step, set, contact, opening);
        case WatchedFunction::normal_force:
            return watch_force(set, contact);
    }
    return {};
}

Intervals EnclosureStepper::watch_force(const Doubleton& set, std::size_t contact) const {
    Intervals result, row(coordinates_.size());
    for (int k = 0; k < K; ++k) {
        for (std::size_t j = 0; j < variables_.size(); ++j)
            row[variables_[j]] = over_hull_->slope(k, event(contact), j);
        result.push_back(-intersection(at_center_->value(k, event(contact)) + set.along(row.data()),
                                       over_hull_->value(k, event(contact))));
    }
    result.push_back(-over_box_->value(K, event(contact)));
    return result;
}

Intervals EnclosureStepper::watch_gap(const EnclosureStep& step, const Doubleton& set, std::size_t contact,
                                      const OpenGapBound& opening) const {
    const std::size_t size = coordinates_.size(), h = coordinates_.h(contact);
    Intervals result;
    for (int k = static_cast<int>(opening.known); k <= K; ++k) {
        const std::size_t at = static_cast<std::size_t>(k) * size + h;
        const Interval sharp = step.center_[at] + set.along(step.slopes_[static_cast<std::size_t>(k)].row(h));
        result.push_back(intersection(sharp, step.hull_[at]));
    }
    result.push_back(step.remainder_[h]);
    if (opening.known == KnownRoot::none) result.front() = intersection(result.front(), opening.gap);
    return result;
}

EnclosureStep EnclosureStepper::make(const Doubleton& set, double longest, const std::vector<OpenGapBound>& openings) {
    const Intervals hull = set.hull();
    at_center_->expand(set.center(), K);
    over_hull_->expand(hull, K);
    double length = first_length(set, hull, longest);
    if (last_ > 0.0) length = std::min(length, 1.3 * last_);
    const double least = 0x1p-50 * std::max(mag(hull[Coordinates::t()]), 0x1p-20 * longest);
    const double fine = mode_.is_free() ? 2e-17 : 1e-15;
    EnclosureStep step;
    tabulate(step, set, openings);
    for (int round = 0; round < 60 && length > least; ++round) {
        if (!enclose(step, hull, length)) {
            length *= 0.7;
            continue;
        }
        const std::vector<double> scale = scales(hull, length);
        const Intervals rho = step.remainder_at(Interval(length));
        double excess = 0.0;
        for (std::size_t i = 0; i < rho.size(); ++i) {
            const double allowed = std::max(fine * scale[i], 1e-7 * rad(hull[i]));
            if (mag(rho[i]) > 0.0) excess = std::max(excess, mag(rho[i]) / allowed);
        }
        if (!(excess > 1.0)) {
            last_ = length;
            for (std::size_t i = 0; i < coordinates_.contacts; ++i)
                step.watched_.push_back(watch(step, set, i, openings[i]));
            return step;
        }
        length *= std::clamp(std::pow(excess, -0.7 / (K + 1)), 0.5, 0.95);
    }
    throw ProofStopped{"no enclosure found even for a very short step"};
}

template <>
inline DoubleDoubleBall scalar_from<DoubleDoubleBall>(const Constant& constant) {
    const auto whole = [](const std::string& digits) {
        DoubleDoubleBall result;
        for (const char digit : digits)
            if (digit != '-')
                result = result * DoubleDoubleBall(10.0) + DoubleDoubleBall(static_cast<double>(digit - '0'));
        return digits.starts_with('-') ? -result : result;
    };
    return whole(constant.numerator) / whole(constant.denominator);
}
template <>
inline DoubleDoubleBall scalar_pi<DoubleDoubleBall>() {
    return DoubleDoubleBall::half_pi() * DoubleDoubleBall(2.0);
}

namespace {

Interval range_of(const DoubleDoubleBall& x) { return x.range(); }
template <std::size_t N>
Interval range_of(const Jet<Interval, N>& x) {
    return x.value;
}

template <class Number>
class ExpansionOver : public Expansion {
 public:
    ExpansionOver(const SeriesProgram& program, const Coordinates& coordinates)
        : coordinates_(coordinates),
          variables_(coordinates.of_motion()),
          contacts_(program.events()),
          series_(program) {}

    void expand(const Intervals& box, int last) override {
        const std::vector<Number> state = coordinates_.numbers<Number>(box, variables_);
        Intervals varied(box.begin() + static_cast<std::ptrdiff_t>(coordinates_.parameter(0)), box.end());
        if (!fixed_ || !same(varied, fixed_at_)) {
            const std::vector<Number> parameters = coordinates_.parameter_numbers(state);
            series_.fix(parameters);
            fixed_at_ = varied;
            fixed_ = true;
        }
        series_.expand(&state[coordinates_.q(0)], state[Coordinates::t()], last);
    }
    Interval value(int k, std::size_t i) const override { return range_of(series_.coefficient(k, i)); }
    Interval slope(int k, std::size_t i, std::size_t j) const override {
        if constexpr (has_directions<Number>)
            return series_.coefficient(k, i).slope[j];
        else
            return Interval::undefined();
    }
    bool has_mass() override {
        bool positive = true;
        for (std::size_t i = 0; i < coordinates_.dof; ++i)
            positive = positive && certainly_positive(range_of(series_.start(coordinates_.dof + contacts_ + i)));
        return positive;
    }

 private:
    static bool same(const Intervals& a, const Intervals& b) {
        for (std::size_t i = 0; i < a.size(); ++i)
            if (a[i].lo() != b[i].lo() || a[i].hi() != b[i].hi()) return false;
        return true;
    }

    Coordinates coordinates_;
    std::vector<std::size_t> variables_;
    std::size_t contacts_;
    SeriesOver<Number> series_;
    Intervals fixed_at_;
    bool fixed_ = false;
};

}  // namespace

std::unique_ptr<Expansion> make_expansion(const SeriesProgram& series, const Coordinates& coordinates,
                                          ExpansionMode what) {
    if (what == ExpansionMode::point) return std::make_unique<ExpansionOver<DoubleDoubleBall>>(series, coordinates);
    if (what == ExpansionMode::box) return std::make_unique<ExpansionOver<Jet<Interval, 0>>>(series, coordinates);
    return with_directions(coordinates.of_motion().size(), [&]<std::size_t N>() -> std::unique_ptr<Expansion> {
        return std::make_unique<ExpansionOver<Jet<Interval, N>>>(series, coordinates);
    });
}

}  // namespace achilles
