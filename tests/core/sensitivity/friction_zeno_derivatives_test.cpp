// Derivatives and estimated errors of runs that pass Zeno points with dry friction (theory-friction.md 4 and 6): closed
// forms, differences of runs, ranks, and the order in the impact speed w of the cut.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>

#include "core/sensitivity/estimates.hpp"
#include "core/systems.hpp"
#include "sensitivity/derivatives.hpp"

namespace achilles::test {
namespace {

struct Tail {
    const char* name;
    std::string text;
    double end;
    Certificate::Tail kind;
    int rank;           // of the derivatives of the final state by the initial one
    double eps = 1e-5;  // of the cut whose error is estimated
    double rest = 0.1;  // the part of that error that is of higher order
};
void PrintTo(const Tail& tail, std::ostream* stream) { *stream << tail.name; }

// A body that bounces on a sine, with the coupling b of x and y in its mass matrix.
std::string body(const char* start, const char* values, const char* friction) {
    return fmt::format(R"-(parameter = [{}]
coordinate = [{}]
lagrangian.kinetic = "(x'^2 + y'^2 + 2*b*x'*y' + 2/5*phi'^2)/2"
lagrangian.potential = "y + phi*x/9"
[[constraint]]
gap = "y - A*sin(x)"
restitution = "e"
slip = "(x' + A*cos(x)*y')/sqrt(1 + A^2*cos(x)^2) + r*phi'"
friction = "{}"
)-",
                       values, start, friction);
}
constexpr const char* high =
    R"({name = "x", start = 2.6, rate = 0.7}, {name = "y", start = 0.75}, {name = "phi", rate = -0.5})";
constexpr const char* low =
    R"({name = "x", start = 2, rate = 0.3}, {name = "y", start = 0.6}, {name = "phi", rate = -0.5})";
// A = 1 or 0.3, r, b, e, mu.
std::string values(double A, double r, double b, double e, double mu) {
    return fmt::format(R"({{name = "A", value = {}}}, {{name = "r", value = {}}}, {{name = "b", value = {}}},
  {{name = "e", value = {}}}, {{name = "mu", value = {}}})",
                       A, r, b, e, mu);
}

// W = (1, 0.6, 1), mu = 0.4: all impacts stick although the contact at rest slides.
const char* const skew_body = R"-(parameter = [{name = "mu", value = 0.4}, {name = "e", value = 0.3},
  {name = "alpha", value = -0.2}]
coordinate = [{name = "x", rate = -0.2}, {name = "y", start = 0.5}]
lagrangian.kinetic = "(x'^2 + y'^2 - 1.2*x'*y')/1.28"
lagrangian.potential = "-(alpha + 0.6)/0.64*x + (1 + 0.6*alpha)/0.64*y + x^2*y/3"
constraint = [{gap = "y + x^2/20", restitution = "e", slip = "x' - x*y'/10", friction = "mu"}]
)-";

std::vector<Tail> tails() {
    using enum Certificate::Tail;
    return {{"slip", body(high, values(1, 0.5, 0, 0.5, 0.1).c_str(), "mu"), 2.9, slip, 4},
            {"slip_stribeck", body(high, values(1, 0.5, 0, 0.5, 0.1).c_str(), "mu/2 + mu/2*exp(-slip)"), 2.9, slip, 4},
            {"coupled_slip", body(low, values(0.3, 0.5, 0.4, 0.3, 0.1).c_str(), "mu"), 2.2, slip, 4},
            {"stick_e5", body(high, values(1, 0.5, 0, 0.5, 0.6).c_str(), "mu"), 3.0, stick, 3},
            {"stick_e7", body(low, values(0.3, 0.5, 0, 0.7, 0.8).c_str(), "mu"), 6.0, stick, 3},
            {"coupled_stick", body(low, values(0.3, 0.5, 0.4, 0.3, 1.2).c_str(), "mu"), 2.2, stick, 3},
            {"stick_then_slip", skew_body, 2.0, stick_then_slip, 2, 1e-4, 0.35}};
}

Trajectory run_of(const std::shared_ptr<const Model>& model, const Run& run) {
    Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    return trajectory;
}
Run start_of(const Model& model, double end, double eps) {
    Run run = with(model.default_run(), 1e-15, eps);
    run.options.end_time = end;
    return run;
}
std::size_t zeno_of(const Trajectory& run) {
    for (std::size_t i = 0; i < run.events.size(); ++i)
        if (run.events[i].is_zeno()) return i;
    ADD_FAILURE() << "no Zeno point";
    return 0;
}

// The final state and the Zeno time, and their derivatives.
Eigen::VectorXd results_of(const Trajectory& run) {
    const Eigen::Index n = run.end.q.size();
    Eigen::VectorXd all(2 * n + 1);
    all << run.end.q, run.end.v, run.events[zeno_of(run)].t;
    return all;
}
Eigen::MatrixXd derivatives_of(const Trajectory& run) {
    const Derivatives d = differentiate(run);
    EXPECT_EQ(d.broken, "");
    if (!d.end) return {};
    const Eigen::Index n = run.end.q.size();
    Eigen::MatrixXd all(2 * n + 1, static_cast<Eigen::Index>(d.directions.size()));
    all << d.end->q, d.end->v, d.events[zeno_of(run)].t.transpose();
    return all;
}

// A contact bounces while another one is held, which slides or sticks: derivatives by the parameters.
struct Beside {
    const char* name;
    const char* text;
    double end;
};
void PrintTo(const Beside& beside, std::ostream* stream) { *stream << beside.name; }
const Beside beside_held[] = {
    {"bead_carries_a_mass", R"-(coordinate = [
  {name = "x", start = -1, rate = 0.5}, {name = "y", start = "-0.5*sin(1)", rate = "0.25*cos(1)"},
  {name = "z", start = 0.5}]
parameter = [{name = "mu", value = 0.2}, {name = "e", value = 0.5}, {name = "g", value = 9.81}]
lagrangian.kinetic = "(x'^2 + y'^2)/2 + (x'^2 + z'^2)/4"
lagrangian.potential = "g*y + g/2*z"
constraint = [
  {name = "wire", gap = "y - 0.5*sin(x)", slip = "x' + 0.5*cos(x)*y'", friction = "mu", restitution = 0},
  {name = "seat", gap = "z - y - 0.2", restitution = "e"}]
)-",
     1.4},
    {"load_sticks_to_a_block", R"-(coordinate = [{name = "x"}, {name = "y"}, {name = "s"}, {name = "z", start = 0.5}]
parameter = [{name = "al", value = 0.2}, {name = "mu", value = 0.8}, {name = "e", value = 0.3}]
lagrangian.kinetic = "(x'^2 + y'^2 + s'^2 + z'^2)/2"
lagrangian.potential = "y + z*(1 + s/4) - al*(x + s)"
constraint = [
  {name = "incline", gap = "y", slip = "x'", friction = 0.9, restitution = 0},
  {name = "seat", gap = "z - y", slip = "s' - x'", friction = "mu", restitution = "e"}]
)-",
     3.0},
};
class FrictionDerivativesBeside : public testing::TestWithParam<Beside> {};

TEST_P(FrictionDerivativesBeside, AreThoseOfDifferences) {
    const auto model = typed(GetParam().text);
    const achilles::Run start = start_of(*model, GetParam().end, 1e-11);
    const Eigen::MatrixXd found = derivatives_of(run_of(model, start));
    const Eigen::Index first = 2 * start.q.size();
    ASSERT_EQ(found.cols(), first + 3);
    for (Eigen::Index k = first; k < found.cols(); ++k) {
        const auto at = [&](double change) {
            achilles::Run other = start;
            other.parameters[static_cast<std::size_t>(k - first)] += change;
            return results_of(run_of(model, other));
        };
        const double step = 2e-4;
        const Eigen::VectorXd near = at(step) - at(-step), far = at(2.0 * step) - at(-2.0 * step);
        const Eigen::VectorXd differences = (8.0 * near - far) / (12.0 * step);
        EXPECT_LT((found.col(k) - differences).norm(), 1e-7 * (1.0 + differences.norm()))
            << k << "\nfound " << found.col(k).transpose() << "\ndifferences " << differences.transpose();
    }
}
INSTANTIATE_TEST_SUITE_P(Systems, FrictionDerivativesBeside, testing::ValuesIn(beside_held),
                         [](const auto& beside) { return std::string(beside.param.name); });

class FrictionTailDerivatives : public testing::TestWithParam<Tail> {};

TEST_P(FrictionTailDerivatives, AreThoseOfDifferences) {
    const Tail& tail = GetParam();
    const auto model = typed(tail.text);
    const achilles::Run start = start_of(*model, tail.end, 1e-12);
    const Trajectory run = run_of(model, start);
    EXPECT_EQ(run.events[zeno_of(run)].certificate->tail, tail.kind);
    const Eigen::MatrixXd found = derivatives_of(run);
    const Eigen::Index n = run.end.q.size();
    for (Eigen::Index k = 0; k < found.cols(); ++k) {
        const auto at = [&](double change) {
            achilles::Run other = start;
            (k < n       ? other.q[k]
             : k < 2 * n ? other.v[k - n]
                         : other.parameters[static_cast<std::size_t>(k - 2 * n)]) += change;
            return results_of(run_of(model, other));
        };
        const double step = 2e-4;
        const Eigen::VectorXd near = at(step) - at(-step), far = at(2.0 * step) - at(-2.0 * step);
        const Eigen::VectorXd differences = (8.0 * near - far) / (12.0 * step);
        EXPECT_LT((found.col(k) - differences).norm(), 1e-8 * (1.0 + differences.norm()))
            << k << "\nfound " << found.col(k).transpose() << "\ndifferences " << differences.transpose();
    }
}

// A sequence that slides forgets two dimensions, one that sticks three. If the contact slides afterwards, the Zeno time
// stays in the motion, and two are forgotten.
TEST_P(FrictionTailDerivatives, ForgetDimensions) {
    const Tail& tail = GetParam();
    const auto model = typed(tail.text);
    const Trajectory run = run_of(model, start_of(*model, tail.end, 1e-12));
    const Eigen::Index n = run.end.q.size();
    const Eigen::VectorXd sizes =
        Eigen::JacobiSVD<Eigen::MatrixXd>(derivatives_of(run).topLeftCorner(2 * n, 2 * n)).singularValues();
    EXPECT_GT(sizes[tail.rank - 1], 1e-3) << sizes.transpose();
    EXPECT_LT(sizes[tail.rank], 1e-10) << sizes.transpose();
}

// Also in direction e, where the factor ln w makes the slope a little smaller.
TEST_P(FrictionTailDerivatives, ErrOfThirdOrderInTheSpeedAtTheCut) {
    const Tail& tail = GetParam();
    const auto model = typed(tail.text);
    const Eigen::MatrixXd truth = derivatives_of(run_of(model, start_of(*model, tail.end, 1e-12)));
    std::vector<double> x, y;
    for (double eps = 1e-2; eps > 1e-7; eps *= 0.7) {
        const Trajectory run = run_of(model, start_of(*model, tail.end, eps));
        const double w = run.events[zeno_of(run)].truncation->impact_speed;
        if (!x.empty() && std::log(w) > x.back() - 0.01) continue;
        const double error = (derivatives_of(run) - truth).cwiseAbs().maxCoeff();
        if (error < 1e-10) break;
        x.push_back(std::log(w));
        y.push_back(std::log(error));
    }
    ASSERT_GE(x.size(), 3u);
    const double slope = (y.front() - y.back()) / (x.front() - x.back());
    EXPECT_GT(slope, 2.7) << "last error " << std::exp(y.back()) << " at w = " << std::exp(x.back());
}

// The estimate of the error of a cut at a large w is the true error, up to the next order.
TEST_P(FrictionTailDerivatives, HaveEstimatedErrors) {
    const Tail& tail = GetParam();
    const auto model = typed(tail.text);
    const Trajectory truth = run_of(model, start_of(*model, tail.end, 1e-12));
    const Trajectory run = run_of(model, start_of(*model, tail.end, tail.eps));
    const ErrorEstimate estimate = estimate_error(run);
    ASSERT_TRUE(estimate.end) << estimate.no_estimate_reason;
    const Eigen::VectorXd q = truth.end.q - run.end.q, v = truth.end.v - run.end.v;
    const double error = std::hypot(q.norm(), v.norm());
    EXPECT_GT(error, 1e-11);
    EXPECT_LT(std::hypot((estimate.end->q - q).norm(), (estimate.end->v - v).norm()), tail.rest * error + 1e-12)
        << estimate.end->q.transpose() << " " << estimate.end->v.transpose() << "\n"
        << q.transpose() << " " << v.transpose();
    const double late = std::abs(truth.events[zeno_of(truth)].t - run.events[zeno_of(run)].t);
    EXPECT_NEAR(estimate.events[zeno_of(run)], late, tail.rest * late + 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Tails, FrictionTailDerivatives, testing::ValuesIn(tails()),
                         [](const auto& each) { return std::string(each.param.name); });

// A point falls on a slope from y = h and sticks at all impacts: with w^2 = v^2 + 2 h and t_1 = v + w,
//     tau_inf = t_1 + 2 e w/(1 - e),   x = x_0 + u t_1 + alpha (t_1^2/2 + 2 e^2 w^2/(1 - e^2))
TEST(FrictionZenoDerivatives, OfAPointOnASlopeAreExact) {
    const auto model = typed(R"-(parameter = [{name = "e", value = 0.5}, {name = "alpha", value = 0.3}]
coordinate = [{name = "x"}, {name = "y", start = 0.5}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y - alpha*x"
constraint = [{gap = "y", restitution = "e", slip = "x'", friction = 0.5}]
)-");
    const Eigen::MatrixXd found = derivatives_of(run_of(model, start_of(*model, 4.0, 1e-9)));
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(5, 6);  // x, y, x', y', tau by x, y, x', y', e, alpha
    expected.row(0) << 1.0, 0.7, 1.0, 0.3, 0.15 * 4.0 / 0.5625, 0.5 + 2.0 / 3.0;
    expected.row(4) << 0.0, 3.0, 0.0, 1.0, 8.0, 0.0;
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-11) << found << "\n" << expected;
}

}  // namespace
}  // namespace achilles::test
