// When a motion leaves the domain of its equations, the run ends and reports which expression becomes undefined, when,
// and in which state. It neither hangs nor continues.
#include "simulate/domain_monitor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "core/systems.hpp"
#include "model/degenerate_gap.hpp"
#include "simulate/contact_cache.hpp"
#include "simulate/simulate.hpp"
#include "simulate/stepper.hpp"

namespace achilles {
namespace {

struct BoundaryCase {
    std::string name, start, rate, kinetic, potential, gap;
    Outcome::Kind kind;
    std::string beginning;  // start of the message
    double t;               // the instant, known in closed form
};

void PrintTo(const BoundaryCase& edge, std::ostream* out) { *out << edge.name; }

// A gap is degenerate if dh vanishes as h tends to 0. A distance has dh = 0 at its center only, and a normal where it
// closes.
TEST(DegenerateGap, IsNotADistanceFarFromWhereItCloses) {
    const auto with_gap = [](const std::string& gap) {
        return test::typed(
            "title = \"flat\"\n[[coordinate]]\nname = \"x\"\n[[coordinate]]\nname = \"y\"\nstart = -0.3\n"
            "[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n[[constraint]]\ngap = \"" +
            gap + "\"\nrestitution = 0.5\n");
    };
    for (const auto& [gap, flat] :
         {std::pair{"1 - sqrt(x^2 + y^2)", false}, {"y^2", true}, {"y^4", true}, {"-y", false}}) {
        const auto model = with_gap(gap);
        const auto run = model->default_run();
        EXPECT_EQ(is_flat(*model, run.parameters, run.start()), flat) << gap;
    }
}

class DomainBoundaries : public testing::TestWithParam<BoundaryCase> {};

TEST_P(DomainBoundaries, EndTheRunWithAReason) {
    const BoundaryCase& edge = GetParam();
    const auto model =
        test::typed("title = \"edge\"\n[[coordinate]]\nname = \"x\"\nstart = " + edge.start + "\nrate = " + edge.rate +
                    "\n[lagrangian]\nkinetic = \"" + edge.kinetic + "\"\npotential = \"" + edge.potential +
                    "\"\n[[constraint]]\ngap = \"" + edge.gap + "\"\nrestitution = 0.5\n[run]\nend_time = 5.0\n");
    const Trajectory trajectory = simulate(model, model->default_run());
    const std::string& message = trajectory.outcome.message;
    EXPECT_EQ(trajectory.outcome.kind, edge.kind) << message;
    EXPECT_EQ(message.substr(0, edge.beginning.size()), edge.beginning) << message;
    // The message gives the instant and the state.
    const std::size_t t = message.find(" t = ");
    ASSERT_NE(t, message.npos) << message;
    EXPECT_NEAR(std::stod(message.substr(t + 5)), edge.t, 1e-4 * edge.t) << message;
    EXPECT_NE(message.find(", q = (", t), message.npos) << message;
    EXPECT_NE(message.find("), v = (", t), message.npos) << message;
    EXPECT_NEAR(trajectory.end_time, edge.t, 1e-4 * edge.t);
    EXPECT_EQ(message.find("nan"), message.npos) << message;
}

constexpr auto left = Outcome::Kind::left_the_domain;
const double pi = std::acos(-1.0);

const BoundaryCase edges[] = {
    // x'' = -1/x from rest at 1: t = sqrt(pi/2)
    {"log", "1.0", "0.0", "x'^2/2", "log(x)", "x + 1", left,
     "log(x) in the potential becomes undefined, with x = ", std::sqrt(pi / 2)},
    {"sqrt", "1.0", "-1.0", "x'^2/2", "0*x + 1e-9*sqrt(x)", "x + 1", left,
     "sqrt(x) in the potential becomes undefined, with x = ", 1.0},
    // No force: x = 1 - t. The gap is undefined for x < 1/2.
    {"gap", "1.0", "-1.0", "x'^2/2", "0", "sqrt(x - 1/2) + 1/2", left,
     "sqrt(x - 1/2) in the gap becomes undefined, with x - 1/2 = ", 0.5},
    {"pole_of_the_gap", "1.0", "1.0", "x'^2/2", "0", "1/(2 - x)", left,
     "1/(2 - x) in the gap becomes undefined, with 2 - x = ", 1.0},
    // x'' = -1/x^2 from x' = -1: the cycloid x = 1/2 (1 + cos(u)), t = pi/2 - 1
    {"division", "1.0", "-1.0", "x'^2/2", "-1/x", "x + 1", left,
     "(-1)/x in the potential becomes undefined, with x = ", pi / 2 - 1},
    // x x'^2 is constant: x^(3/2) = 1 - 3/2 t
    {"mass", "1.0", "-1.0", "x*x'^2/2", "0", "x + 1", left,
     "the mass matrix is no longer positive definite: the pivot of 'x' is ", 2.0 / 3},
    // x = 1 - t^2/2 meets h = x^3 at its degenerate zero.
    {"flat_contact", "1.0", "0.0", "x'^2/2", "x", "x^3", left,
     "dh = 0 at the contact: the normal is not defined, at t = ", std::sqrt(2.0)},
    // h = x^2 only touches zero: no precision decides whether there is an impact.
    {"touching_contact", "1.0", "0.0", "x'^2/2", "x", "x^2", Outcome::Kind::undecided,
     "the gap is within integration error (7e-14) of zero, and dh vanishes where h = 0, so the contact has no normal, "
     "just after t = ",
     std::sqrt(2.0)},
};

INSTANTIATE_TEST_SUITE_P(Domain, DomainBoundaries, testing::ValuesIn(edges),
                         [](const auto& edge) { return edge.param.name; });

// The error at the end of the run includes advice on how to correct the file.
TEST(Domain, AFlatGapIsToldWithAdvice) {
    const auto model = test::typed(
        "title = \"flat\"\n[[coordinate]]\nname = \"x\"\nstart = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n"
        "potential = \"x\"\n[[constraint]]\ngap = \"x^3\"\nrestitution = 0.5\n");
    const std::string message = simulate(model, model->default_run()).outcome.message;
    EXPECT_NE(message.find("; write a gap whose dh is not 0 where h = 0"), std::string::npos) << message;
}

// Where two factors of a gap vanish there is no normal. The advice is one constraint for each factor.
TEST(Domain, AProductOfGapsIsToldWithAdvice) {
    const auto with_gap = [](const std::string& gap) {
        const auto model = test::typed(
            "title = \"corner\"\n[[coordinate]]\nname = \"x\"\nstart = 0.5\nrate = 0.2\n[[coordinate]]\nname = \"y\"\n"
            "start = 0.9\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"9.81*y\"\n[[constraint]]\ngap = "
            "\"" +
            gap + "\"\nrestitution = 0.5\n");
        return simulate(model, model->default_run()).outcome;
    };
    const Outcome corner = with_gap("2*y*(y - x + 1)");
    EXPECT_EQ(corner.kind, Outcome::Kind::undecided);
    EXPECT_NE(corner.message.find("; the gap is a product; write one [[constraint]] for each factor: gap = \""),
              std::string::npos)
        << corner.message;
    EXPECT_NE(corner.message.find("gap = \"y - x + 1\""), std::string::npos) << corner.message;
}

// A motion to infinity crosses no domain boundary. It has another outcome.
TEST(Domain, InfinityIsNoDomainBoundary) {
    const auto model = test::typed(
        "title = \"away\"\n[[coordinate]]\nname = \"x\"\nstart = 1.0\nrate = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n"
        "potential = \"-x^4\"\n[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n[run]\nend_time = 5.0\n");
    const Trajectory trajectory = simulate(model, model->default_run());
    EXPECT_NE(trajectory.outcome.kind, Outcome::Kind::left_the_domain) << trajectory.outcome.message;
    EXPECT_NE(trajectory.outcome.kind, Outcome::Kind::end_time);
}

// ---- steps that are safe without the polynomials of their motion ----

// A stepper that does not tell its series in time.
class WithoutTimeSeries : public Stepper {
 public:
    explicit WithoutTimeSeries(Stepper& stepper) : stepper_(&stepper) {}
    void initialize(Mode mode, const State& state, std::span<const Gap> gaps) override {
        stepper_->initialize(mode, state, gaps);
    }
    StepFailure do_step(double time, double longest, double first, double least) override {
        return stepper_->do_step(time, longest, first, least);
    }
    StepFailure redo_step(double duration, double least) override { return stepper_->redo_step(duration, least); }
    double current_time() const override { return stepper_->current_time(); }
    const State& current_state() override { return stepper_->current_state(); }
    void event_function(std::size_t contact, Polynomial& p) const override { stepper_->event_function(contact, p); }
    std::uint32_t coefficients(std::vector<double>& all) const override { return stepper_->coefficients(all); }
    double remainder(std::size_t contact, const Polynomial& p) const override {
        return stepper_->remainder(contact, p);
    }
    void add_error(std::size_t contact, const Polynomial& p, Gap& end) const override {
        stepper_->add_error(contact, p, end);
    }
    bool is_expansion() const override { return true; }
    long evaluations() const override { return stepper_->evaluations(); }

 private:
    Stepper* stepper_;
};

struct StepCounts {
    int shown = 0, safe = 0, shortened = 0;
};

// Steps of a particle that passes the center at this distance. The part that is safe does not depend on whether the
// stepper tells its series in time.
void compare_safe_parts(const std::string& potential, double distance, double longest, StepCounts& counts) {
    const auto model = test::typed(
        "title = \"passage\"\n[[coordinate]]\nname = \"x\"\nstart = -1.0\nrate = 1.0\n[[coordinate]]\nname = \"y\"\n"
        "start = 0.0\n[[parameter]]\nname = \"b\"\nvalue = 1.0\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
        "potential = \"" +
        potential + "\"\n[[constraint]]\ngap = \"x + 10\"\nrestitution = 0.5\n");
    Run run = model->default_run();
    run.parameters[0] = distance;
    ContactCache surfaces(*model, run);
    const auto stepper = make_taylor(*model, run, surfaces);
    WithoutTimeSeries without(*stepper);
    DomainMonitor monitor(*model, run), other(*model, run);
    State state = run.start();
    for (int step = 0; step < 60 && state.t < 4.0; ++step) {
        const Contact contact = surfaces.of(0).at(state);
        const Gap gap{contact.h, contact.hdot};
        stepper->initialize(Mode(), state, std::span(&gap, 1));
        ASSERT_EQ(stepper->do_step(state.t, longest, 0.0, 1e-15), StepFailure::none);
        const double theta = monitor.safe_part(*stepper, state.t);
        EXPECT_EQ(theta, other.safe_part(without, state.t)) << distance << " " << longest << " at " << state.t;
        EXPECT_TRUE(other.has_motion());
        counts.shown += !monitor.has_motion();
        counts.safe += theta == 1.0;
        counts.shortened += theta < 1.0;
        if (theta < 1.0) {
            ASSERT_EQ(stepper->redo_step(theta * stepper->current_time(), 1e-15), StepFailure::none);
        }
        const double t = state.t + stepper->current_time();
        state = stepper->current_state();
        state.t = t;
    }
}

TEST(Domain, TheMotionInTimeShowsOnlySafeStepsToBeSafe) {
    StepCounts counts;
    for (const std::string potential : {"1e-9*sqrt(x^2 + (y - b)^2)", "1e-9*log(x^2 + (y - b)^2)",
                                        "1e-9*sqrt((x + 0.1*cos(9*t))^2 + b^2)", "1e-9*exp(5*x) + 1e-9*sqrt(b + x^2)"})
        for (const double distance : {0.01, 0.1, 0.5, 2.0})
            for (const double longest : {0.01, 0.1, 0.3, 0.8, 3.0})
                compare_safe_parts(potential, distance, longest, counts);
    EXPECT_GT(counts.shown, counts.safe / 2);
    EXPECT_GT(counts.shortened, 20);
}

}  // namespace
}  // namespace achilles
