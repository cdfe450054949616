#include "enclose/event_maps.hpp"

#include "contacts/impact_law.hpp"
#include "number/jet.hpp"

namespace achilles {

namespace {

// The programs of a contact while others are held, for one number type.
template <class Number>
class Programs {
 public:
    Programs(const Model& model, const Coordinates& coordinates, std::size_t contact, Mode mode)
        : z_(coordinates),
          layout_(model.layout()),
          h_(coordinates.h(contact)),
          u_(coordinates.u(contact)),
          terms_(Evaluator<Number>(model.programs_of(contact, mode).contact_terms), coordinates.dof),
          release_(Evaluator<Number>(model.programs_of(contact, mode).release_terms), coordinates.dof),
          restitution_(model.restitution(contact)) {
        for (std::size_t i = 0; i < model.contacts(); ++i)
            if (i != contact && !mode.is_held(i))
                others_.push_back(
                    {coordinates.u(i), ContactTerms<Evaluator<Number>>(
                                           Evaluator<Number>(model.programs_of(i).contact_terms), coordinates.dof)});
    }

    std::vector<Number> numbers(const Intervals& box) {
        std::vector<Number> z = z_.numbers<Number>(box, z_.of_maps());
        const std::vector<Number> parameters = z_.parameter_numbers(z);
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            terms_.input(layout_.parameter(i)) = release_.input(layout_.parameter(i)) =
                restitution_.input(layout_.parameter(i)) = parameters[i];
            for (OpenContact& other : others_) other.terms.input(layout_.parameter(i)) = parameters[i];
        }
        for (OpenContact& other : others_) other.terms.fix();
        terms_.fix();
        release_.fix();
        restitution_.fix();
        return z;
    }

    void measure_gap(std::vector<Number>& z) {
        evaluate(terms_, z);
        z[h_] = terms_.h();
        z[u_] = terms_.hdot();
    }
    void take_rate_out(std::vector<Number>& z) {
        evaluate(terms_, z);
        strike(z, z[u_]);
    }
    void impact(std::vector<Number>& z) {
        evaluate(terms_, z);
        restitution_.run();
        const Number e = restitution_.output(0);
        strike(z, newton::removed_rate(e, z[u_]));
        z[u_] = newton::rate_after(e, z[u_]);
    }
    void retract(std::vector<Number>& z) {
        evaluate(terms_, z);
        shift(z, Number(terms_.h()));
        push(z, Number(terms_.hdot()));
    }
    void project(std::vector<Number>& z) {
        evaluate(terms_, z);
        shift(z, terms_.h() - z[h_]);
        push(z, terms_.hdot() - z[u_]);
    }

    const ContactTerms<Evaluator<Number>>& terms(const std::vector<Number>& z) {
        evaluate(terms_, z);
        return terms_;
    }
    const ReleaseTerms<Evaluator<Number>>& release(const std::vector<Number>& z) {
        evaluate(release_, z);
        return release_;
    }

 private:
    template <class Terms>
    void evaluate(Terms& terms, const std::vector<Number>& z) {
        for (std::size_t i = 0; i < 2 * z_.dof; ++i) terms.input(i) = z[z_.q(i)];
        terms.clock() = z[Coordinates::t()];
        terms.run();
    }
    // q -= n h; the terms are then evaluated at the new position.
    void shift(std::vector<Number>& z, const Number& h) {
        move_along(z[z_.q(0)], h);
        evaluate(terms_, z);
    }
    // v -= n rate.
    void push(std::vector<Number>& z, const Number& rate) { move_along(z[z_.v(0)], rate); }
    void move_along(Number& first, const Number& amount) {
        newton::move_along(
            &first, z_.dof, [&](std::size_t i) -> const Number& { return terms_.impulse_direction(i); }, amount);
    }

    // v -= n rate, and updates the rates of the other open gaps.
    void strike(std::vector<Number>& z, const Number& rate) {
        push(z, rate);
        for (OpenContact& other : others_) {
            evaluate(other.terms, z);
            Number passed(0.0);
            for (std::size_t i = 0; i < z_.dof; ++i)
                passed = passed + other.terms.gradient(i) * terms_.impulse_direction(i);
            z[other.u] = z[other.u] - passed * rate;
        }
    }

    // Another open contact.
    struct OpenContact {
        std::size_t u;
        ContactTerms<Evaluator<Number>> terms;
    };
    Coordinates z_;
    Layout layout_;
    std::size_t h_, u_;
    std::vector<OpenContact> others_;
    ContactTerms<Evaluator<Number>> terms_;
    ReleaseTerms<Evaluator<Number>> release_;
    Evaluator<Number> restitution_;
};

template <std::size_t N>
class EventMapsOver : public EventMaps {
    using Value = Jet<Interval, 0>;
    using Gradient = Jet<Interval, N>;

 public:
    EventMapsOver(const Model& model, const Coordinates& coordinates, std::size_t contact, Mode mode)
        : z_(coordinates),
          variables_(coordinates.of_maps()),
          values_(model, coordinates, contact, mode),
          gradients_(model, coordinates, contact, mode) {}

    void measure_gap(Doubleton& set) override {
        apply(set, [](auto& programs, auto& z) { programs.measure_gap(z); });
    }
    void take_rate_out(Doubleton& set) override {
        apply(set, [](auto& programs, auto& z) { programs.take_rate_out(z); });
    }
    void impact(Doubleton& set) override {
        apply(set, [](auto& programs, auto& z) { programs.impact(z); });
    }
    void project(Doubleton& set) override {
        apply(set, [](auto& programs, auto& z) { programs.project(z); });
    }
    void retract(Doubleton& set) override {
        apply(set, [](auto& programs, auto& z) { programs.retract(z); });
    }

    GapAcceleration normal(const Intervals& box) override {
        const std::vector<Gradient> z = gradients_.numbers(box);
        const auto& terms = gradients_.release(z);
        GapAcceleration result{terms.hddot().value, terms.jerk().value, Intervals(z_.size())};
        for (std::size_t j = 0; j < variables_.size(); ++j) result.slope[variables_[j]] = terms.hddot().slope[j];
        return result;
    }
    GapValues surface(const Intervals& box) override {
        const std::vector<Value> z = values_.numbers(box);
        const auto& terms = values_.terms(z);
        GapValues result{terms.h().value, terms.hdot().value, {}, {}};
        for (std::size_t i = 0; i < z_.dof; ++i) {
            result.n.push_back(terms.impulse_direction(i).value);
            result.gradient.push_back(terms.gradient(i).value);
        }
        return result;
    }

 private:
    // A coordinate that the map leaves unchanged has derivative 1 by itself.
    template <class Map>
    void apply(Doubleton& set, const Map& map) {
        std::vector<Value> center = values_.numbers(set.center());
        std::vector<Gradient> over = gradients_.numbers(set.hull());
        const std::vector<Gradient> before = over;
        map(values_, center);
        map(gradients_, over);
        Intervals at_center;
        for (const Value& value : center) at_center.push_back(value.value);
        IntervalMatrix slope = IntervalMatrix::identity(z_.size());
        for (std::size_t i = 0; i < z_.size(); ++i) {
            if (is_same(over[i], before[i])) continue;
            slope(i, i) = Interval(0.0);
            for (std::size_t j = 0; j < variables_.size(); ++j) slope(i, variables_[j]) = over[i].slope[j];
        }
        set.map(at_center, slope);
    }
    static bool is_same(const Gradient& a, const Gradient& b) {
        const auto same = [](const Interval& x, const Interval& y) { return x.lo() == y.lo() && x.hi() == y.hi(); };
        bool result = same(a.value, b.value);
        for (std::size_t j = 0; j < N; ++j) result = result && same(a.slope[j], b.slope[j]);
        return result;
    }

    Coordinates z_;
    std::vector<std::size_t> variables_;
    Programs<Value> values_;
    Programs<Gradient> gradients_;
};

}  // namespace

std::unique_ptr<EventMaps> make_maps(const Model& model, const Coordinates& coordinates, std::size_t contact,
                                     Mode mode) {
    return with_directions(coordinates.of_maps().size(), [&]<std::size_t N>() -> std::unique_ptr<EventMaps> {
        return std::make_unique<EventMapsOver<N>>(model, coordinates, contact, mode);
    });
}

}  // namespace achilles
