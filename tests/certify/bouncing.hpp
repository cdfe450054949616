// Reference motion after a collision, in 34 digits, against which certificates (core/certify) are tested. It follows
// every impact of a contact to its Zeno point while others are held, and the constrained motion from a restart.
#pragma once

#include <array>
#include <optional>

#include "certify/taylor.hpp"
#include "model/model.hpp"
#include "run/trajectory.hpp"

namespace achilles::test {

template <class Number>
struct PointOf {
    List<Number> q, v;
    Number t = 0;
};
using Point = PointOf<Real>;

template <class Number>
struct ZenoPointOf {
    Number time;  // tau_inf - tau_k
    PointOf<Number> point;
    int impacts = 0;
    std::vector<List<Number>> velocities;  // after each impact and before the next, where |v - v*| is largest
    struct FlightRecord {
        PointOf<Number> start;
        Number time, duration;  // `time` is that of its start
    };
    std::vector<FlightRecord> flights;  // the first ones
};
using ZenoPoint = ZenoPointOf<Real>;

// A state at `time` after tau_k.
template <class Number>
struct InstantOf {
    Number time;
    PointOf<Number> point;
};
using Instant = InstantOf<Real>;

// Number of sampled instants in each of the first flights, most in the highest. 30 in all.
constexpr std::size_t flights_kept = 6;
constexpr std::array<std::size_t, flights_kept> instants_of_flight{10, 6, 5, 4, 3, 2};

// The current state of a motion. `known` is the multiplicity of the root of the gap at the start of a flight: 1 after
// an impact, 3 after a release.
template <class Number>
struct FlightOf {
    PointOf<Number> point;
    Number time;
    int known = 0;
};
using Flight = FlightOf<Real>;

// Evaluators with the values of the parameters set.
template <class Number>
Evaluator<Number> evaluator(const Model& model, const Program& program, const List<Number>& parameters) {
    Evaluator<Number> result(program);
    for (std::size_t i = 0; i < parameters.size(); ++i) result.input(model.layout().parameter(i)) = parameters[i];
    result.fix();
    return result;
}
template <class Number, template <class> class TermsOf>
TermsOf<Evaluator<Number>> evaluator(const Model& model, const TypedProgram<TermsOf>& program,
                                     const List<Number>& parameters) {
    return {evaluator(model, static_cast<const Program&>(program), parameters), static_cast<std::size_t>(model.dof())};
}

template <class Number>
class TrueMotionOf {
 public:
    using Numbers = List<Number>;
    using Point = PointOf<Number>;
    using ZenoPoint = ZenoPointOf<Number>;
    using Instant = InstantOf<Number>;
    using Flight = FlightOf<Number>;

    // `longest_step` limits the steps. Far from a thin post all computed terms of a series may vanish, and a longer
    // step would pass over the post.
    TrueMotionOf(const Model& model, const Run& run, double longest_step = 1e300, std::size_t contact = 0,
                 Mode mode = {})
        : TrueMotionOf(model, Numbers(run.parameters.begin(), run.parameters.end()), longest_step, contact, mode) {}
    TrueMotionOf(const Model& model, const Numbers& parameters, double longest_step = 1e300, std::size_t contact = 0,
                 Mode mode = {});

    // The exact collision for a computed state. q is moved along n until h = 0 to working precision, for this contact
    // and for held ones. hdot of held contacts becomes 0; otherwise v is unchanged.
    Point collision(const State& before);
    // The restart after a collision: Def. 7 (Euclidean) or the plastic impact (kinetic).
    Point restart(const Point& collision, Reinitialization kind);
    // Follows the impacts until their speed has fallen by the factor `until`. The rest is a geometric series, up to
    // terms in the square of that speed. Returns nullopt if the impacts do not behave like one.
    std::optional<ZenoPoint> zeno(const Point& collision, double until = 1e-8);
    // Instants of the first flights, in order of time: evenly spaced ones and the top of each flight.
    std::vector<Instant> inside(const ZenoPoint& zeno, double tolerance);
    // The constrained motion for this duration, regardless of the sign of the force.
    Point constrained(Point start, const Number& duration, double tolerance);
    // States at these times after the start, in ascending order: in contact regardless of the force, or free regardless
    // of the gap.
    std::vector<Point> contact_at(const Point& start, const Numbers& times, double tolerance);
    std::vector<Point> flight_at(const Point& start, const Numbers& times, double tolerance);

    // Follows the flight to the next impact, for at most `longest`, with a first step of at most `expected`. False if
    // there is no impact.
    bool fly(Flight& flight, const Number& longest, double expected, double tolerance);
    // The same to the next local minimum of the gap.
    bool fly_to_dip(Flight& flight, const Number& longest, double expected, double tolerance);
    // Follows the constrained motion until the force vanishes, for at most `longest`. True if it does.
    bool stay(Flight& contact, const Number& longest, double tolerance);
    // The same to the next local minimum of the force, regardless of its sign.
    bool stay_to_dip(Flight& contact, const Number& longest, double tolerance);

    struct Contact {
        Number h, hdot;
        Numbers n, g;
    };
    Contact contact(const Point& point);
    // hddot of the free motion, and its rate h''' along the constrained motion.
    Number normal_acceleration(const Point& point);
    Number jerk(const Point& point);
    // Quantities of the other contacts while this one is open, in ascending order of contacts: forces of the held ones,
    // gaps of the open ones, and the transmissions kappa of an impulse to the held ones.
    struct OtherContacts {
        Numbers forces, gaps, transmissions;
    };
    OtherContacts others(const Point& point);
    // The state after a short time in contact, to first order.
    Point drift(const Point& slid, const Number& time);

 private:
    using Coefficients = std::vector<Point>;  // by order
    enum class StopCondition { impact, dip, release, least_force };
    Coefficients expand(Evaluator<Series<Number>>& motion, const Point& from, double duration, double tolerance);
    Numbers along(const Coefficients& path, Evaluator<Series<Number>>& program, std::size_t output, double& step,
                  double tolerance);
    bool move(Flight& flight, StopCondition until, const Number& longest, double expected, double tolerance);
    std::vector<Point> follow(Evaluator<Series<Number>>& motion, Point point, const Numbers& times, double tolerance);

    template <class Terms>
    void set(Terms& terms, const Point& point) const;

    std::size_t dof_, clock_;
    double longest_step_;
    Number e_;
    Evaluator<Series<Number>> flight_, contact_motion_, gap_, release_;
    ContactTerms<Evaluator<Number>> surface_, free_surface_;  // with the others held, and with none held
    ReleaseTerms<Evaluator<Number>> normal_;
    MotionTerms<Evaluator<Number>> acceleration_;
    // For every other held contact: `with` this contact and the remaining ones held, `without` this contact.
    struct HeldContact {
        ContactTerms<Evaluator<Number>> with, without;
        Evaluator<Number> force;
    };
    std::vector<HeldContact> held_;
    std::vector<Evaluator<Number>> open_;  // the gaps
};
using TrueMotion = TrueMotionOf<Real>;

Real distance(const Reals& a, const Reals& b);

}  // namespace achilles::test
