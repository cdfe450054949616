#include "enclose/expansion.hpp"

#include "number/fine.hpp"
#include "number/jet.hpp"
#include "series/series_over.hpp"

namespace achilles {

template <>
inline Fine scalar_from<Fine>(const Constant& constant) {
    const auto whole = [](const std::string& digits) {
        Fine result;
        for (const char digit : digits)
            if (digit != '-') result = result * Fine(10.0) + Fine(static_cast<double>(digit - '0'));
        return digits.starts_with('-') ? -result : result;
    };
    return whole(constant.numerator) / whole(constant.denominator);
}
template <>
inline Fine scalar_pi<Fine>() {
    return Fine::half_pi() * Fine(2.0);
}

namespace {

Interval range_of(const Fine& x) { return x.range(); }
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

std::unique_ptr<Expansion> make_expansion(const SeriesProgram& series, const Coordinates& coordinates, Expanded what) {
    if (what == Expanded::at_a_point) return std::make_unique<ExpansionOver<Fine>>(series, coordinates);
    if (what == Expanded::over_a_box) return std::make_unique<ExpansionOver<Jet<Interval, 0>>>(series, coordinates);
    return with_directions(coordinates.of_motion().size(), [&]<std::size_t N>() -> std::unique_ptr<Expansion> {
        return std::make_unique<ExpansionOver<Jet<Interval, N>>>(series, coordinates);
    });
}

}  // namespace achilles
