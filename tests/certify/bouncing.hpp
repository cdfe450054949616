// What really happens after a collision, in 34 digits: the bouncing of a contact to its Zeno point, impact by impact,
// while others are held, and the constrained motion from a restart. Certificates (core/certify) are judged by it.
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
    std::vector<List<Number>> velocities;  // after each impact and before the next: the largest excursions on the way
    struct Flown {
        PointOf<Number> start;
        Number time, duration;  // time: of its start
    };
    std::vector<Flown> flights;  // the first ones
};
using ZenoPoint = ZenoPointOf<Real>;

// Where a motion is at a time after tau_k.
template <class Number>
struct InstantOf {
    Number time;
    PointOf<Number> point;
};
using Instant = InstantOf<Real>;

// How many instants of each of the first flights are looked at: the highest need most. 30 in all.
constexpr std::size_t flights_kept = 6;
constexpr std::array<std::size_t, flights_kept> instants_of_flight{10, 6, 5, 4, 3, 2};

// Motion underway. At the start of a flight the gap has a root of this multiplicity: 1 after an impact, 3 after a
// release.
template <class Number>
struct FlightOf {
    PointOf<Number> point;
    Number time;
    int known = 0;
};
using Flight = FlightOf<Real>;

// Evaluators with the parameters in place.
template <class Number>
Evaluator<Number> evaluator(const Model& model, const Program& program, const List<Number>& parameters) {
    Evaluator<Number> result(program);
    for (std::size_t i = 0; i < parameters.size(); ++i) result.input(model.layout().parameter(i)) = parameters[i];
    result.fix();
    return result;
}
template <class Number, template <class> class TermsOf>
TermsOf<Evaluator<Number>> evaluator(const Model& model, const ProgramOf<TermsOf>& program,
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

    // A series does not see a thin post from afar, where all terms that there are vanish: steps are at most that
    // long.
    TrueMotionOf(const Model& model, const Run& run, double longest_step = 1e300, std::size_t contact = 0,
                 Mode mode = {})
        : TrueMotionOf(model, Numbers(run.parameters.begin(), run.parameters.end()), longest_step, contact, mode) {}
    TrueMotionOf(const Model& model, const Numbers& parameters, double longest_step = 1e300, std::size_t contact = 0,
                 Mode mode = {});

    // The collision that a computed state stands for: q moved along n until h = 0 to working precision, of what is
    // held as well, whose hdot becomes 0; else v as it is.
    Point collision(const State& before);
    // Where Def. 7 (Euclidean) or the plastic impact (kinetic) restarts from it.
    Point restart(const Point& collision, Reinitialization kind);
    // Follows the impacts until their speed has fallen by the factor `until`; what is left is a geometric series, up
    // to terms in the square of that speed. Nothing if the bouncing does not behave like one.
    std::optional<ZenoPoint> zeno(const Point& collision, double until = 1e-8);
    // Instants within its first flights, in time: spread evenly, and the top of each.
    std::vector<Instant> inside(const ZenoPoint& zeno, double tolerance);
    // The motion that keeps contact, for a time, whatever the force.
    Point constrained(Point start, const Number& duration, double tolerance);
    // Where the motion is at these times after the start, which ascend: in contact whatever the force, or free
    // whatever the gap.
    std::vector<Point> contact_at(const Point& start, const Numbers& times, double tolerance);
    std::vector<Point> flight_at(const Point& start, const Numbers& times, double tolerance);

    // Flies to the next impact, for `longest` at most, in steps of at most `expected`. False if none came.
    bool fly(Flight& flight, const Number& longest, double expected, double tolerance);
    // Flies until the gap stops falling and rises, likewise.
    bool fly_to_dip(Flight& flight, const Number& longest, double expected, double tolerance);
    // Keeps contact until the force vanishes, for `longest` at most. True if it did.
    bool stay(Flight& contact, const Number& longest, double tolerance);
    // Keeps contact, whatever the force, until that stops falling and rises, likewise.
    bool stay_to_dip(Flight& contact, const Number& longest, double tolerance);

    struct Contact {
        Number h, hdot;
        Numbers n, g;
    };
    Contact contact(const Point& point);
    // hddot of the free motion, and its rate h''' along the constrained one.
    Number normal_acceleration(const Point& point);
    Number jerk(const Point& point);
    // What a certificate says of the other contacts while this one is in the air: the forces that hold what is held,
    // the gaps of what is open, and what an impulse is passed on by, all in ascending order of the contacts.
    struct Others {
        Numbers forces, gaps, transmissions;
    };
    Others others(const Point& point);
    // A state in contact after a short time, to first order.
    Point drift(const Point& slid, const Number& time);

 private:
    using Coefficients = std::vector<Point>;  // by order
    enum class Until { impact, dip, release, least_force };
    Coefficients expand(Evaluator<Series<Number>>& motion, const Point& from, double duration, double tolerance);
    Numbers along(const Coefficients& path, Evaluator<Series<Number>>& program, std::size_t output, double& step,
                  double tolerance);
    bool move(Flight& flight, Until until, const Number& longest, double expected, double tolerance);
    std::vector<Point> follow(Evaluator<Series<Number>>& motion, Point point, const Numbers& times, double tolerance);

    template <class Terms>
    void set(Terms& terms, const Point& point) const;

    std::size_t dof_, clock_;
    double longest_step_;
    Number e_;
    Evaluator<Series<Number>> flight_, contact_motion_, gap_, release_;
    ContactTerms<Evaluator<Number>> surface_, free_surface_;  // while the others are held, and while none is
    ReleaseTerms<Evaluator<Number>> normal_;
    MotionTerms<Evaluator<Number>> acceleration_;
    // Of every other contact that is held: with this one and the rest held, and with the rest alone.
    struct Held {
        ContactTerms<Evaluator<Number>> with, without;
        Evaluator<Number> force;
    };
    std::vector<Held> held_;
    std::vector<Evaluator<Number>> open_;  // the gaps
};
using TrueMotion = TrueMotionOf<Real>;

Real distance(const Reals& a, const Reals& b);

}  // namespace achilles::test
