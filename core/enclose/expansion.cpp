#include "enclose/expansion.hpp"

#include "series/series_over.hpp"

namespace achilles {

namespace {

template <std::size_t N>
class ExpansionOver : public Expansion {
    using Number = Jet<Interval, N>;

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
    Interval value(int k, std::size_t i) const override { return series_.coefficient(k, i).value; }
    Interval slope(int k, std::size_t i, std::size_t j) const override {
        if constexpr (N == 0)
            return Interval::undefined();
        else
            return series_.coefficient(k, i).slope[j];
    }
    bool has_mass() override {
        bool positive = true;
        for (std::size_t i = 0; i < coordinates_.dof; ++i)
            positive = positive && certainly_positive(series_.start(coordinates_.dof + contacts_ + i).value);
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
                                          bool with_derivatives) {
    if (!with_derivatives) return std::make_unique<ExpansionOver<0>>(series, coordinates);
    return with_directions(coordinates.of_motion().size(), [&]<std::size_t N>() -> std::unique_ptr<Expansion> {
        return std::make_unique<ExpansionOver<N>>(series, coordinates);
    });
}

}  // namespace achilles
