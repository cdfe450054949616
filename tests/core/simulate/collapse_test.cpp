// Runs in which the impacts of two contacts collapse without force (theory-collapse.md 4 and 5), against reference
// results in quadruple precision (tests/reference/collapse.json).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "contacts/collapse.hpp"
#include "core/simulate/collapses.hpp"

namespace achilles {
namespace {

using test::collapses_of;

std::shared_ptr<const Model> load_collapse(const std::string& name) {
    return std::make_shared<const Model>(read_system(test::source_file("tests/reference/collapse/" + name + ".toml")));
}

nlohmann::json reference() {
    std::ifstream file(test::source_file("tests/reference/collapse.json"));
    return nlohmann::json::parse(file);
}

Trajectory run_with(const std::shared_ptr<const Model>& model, double eps, Method method, double e = -1.0) {
    auto run = model->default_run();
    run.options.method = method;
    run.options.tolerance = 1e-13;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = eps;
    if (e >= 0.0) run.parameters.back() = e;
    return simulate(model, run);
}

// A pair of planes at an angle: gaps x and -gamma x + sqrt(1 - gamma^2) y, so W12 = -gamma.
std::shared_ptr<const Model> planes(const std::string& gamma, const std::string& e, const std::string& start,
                                    const std::string& force, const std::string& unit = "1") {
    return test::typed("title = \"planes\"\n[[coordinate]]\nname = \"x\"\n" + start +
                       "[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"" + force +
                       "\"\n[[constraint]]\nname = \"p\"\ngap = \"x\"\nrestitution = " + e +
                       "\n[[constraint]]\nname = \"r\"\ngap = \"" + unit + "*(sqrt(1 - " + gamma + "^2)*y - " + gamma +
                       "*x)\"\nrestitution = " + e + "\n[run]\nend_time = 0.25\n");
}
const std::string fast_start =
    "start = 0.01\nrate = -1\n[[coordinate]]\nname = \"y\"\nstart = 0.055059776128934826\nrate = "
    "-3.2118202741878648\n";

// The four files: who stays, when, and the state 0.23 s later.
TEST(Collapse, FourPairsOfPlanesHaveTheReferenceResults) {
    const nlohmann::json pairs = reference()["linear_pairs"];
    ASSERT_EQ(pairs.size(), 4u);
    for (const nlohmann::json& pair : pairs) {
        const std::string name = pair["name"];
        const auto model = load_collapse("collapse_" + name);
        for (const Method method : test::both_methods) {
            const Trajectory run = run_with(model, 1e-12, method);
            ASSERT_EQ(run.outcome.kind, Outcome::Kind::end_time) << name << ": " << run.outcome.message;
            const auto collapses = collapses_of(run);
            ASSERT_EQ(collapses.size(), 1u) << name;
            const Event& event = collapses[0];
            const double t = pair["zeno"];
            EXPECT_NEAR(event.t, t, 1e-11) << name;
            EXPECT_LE(event.certificate->zeno_low, t + 1e-14) << name;
            EXPECT_GE(event.certificate->zeno_high, t - 1e-14) << name;
            EXPECT_EQ(event.contacts.count(), 2u);
            const bool p_stays = pair["gap_p"] == 0.0, r_stays = pair["gap_r"] == 0.0;
            EXPECT_EQ(event.mode.is_held(0), p_stays) << name;
            EXPECT_EQ(event.mode.is_held(1), r_stays) << name;
            EXPECT_EQ(event.opened.contains(0), !p_stays) << name;
            EXPECT_EQ(event.opened.contains(1), !r_stays) << name;
            EXPECT_NEAR(run.end.q[0], pair["x"].get<double>(), 1e-10) << name;
            EXPECT_NEAR(run.end.q[1], pair["y"].get<double>(), 1e-10) << name;
            EXPECT_NEAR(run.end.v[0], pair["vx"].get<double>(), 1e-10) << name;
            EXPECT_NEAR(run.end.v[1], pair["vy"].get<double>(), 1e-10) << name;
        }
    }
}

// Two curved gaps, forces of position and velocity, and a third coordinate along them: random numbers, but W12 < 0.
std::shared_ptr<const Model> random_pair(std::mt19937& random) {
    const auto draw = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double gamma = draw(0.90, 0.97), root = std::sqrt(1.0 - gamma * gamma), speed = draw(0.9, 1.1);
    const double y = (0.0108 * draw(0.9, 1.1) + gamma * 0.01) / root, fall = -(gamma + draw(0.4, 0.6)) / root;
    return test::typed(fmt::format(
        R"toml(coordinate = [{{name = "x", start = 0.01, rate = {}, force = "{}*z' + {}*x'"}}, {{name = "y", start = {}, rate = {}}},
    {{name = "z", rate = {}, force = "{}*x'*y'"}}]
lagrangian = {{kinetic = "(x'^2 + y'^2 + z'^2)/2 + {}*z*x'*z'", potential = "{}*x + {}*y + {}*z^2"}}
constraint = [{{name = "p", gap = "x + {}*z^2 + {}*x*z", restitution = {}}},
    {{name = "r", gap = "{}*y - {}*x + {}*z^2 + {}*y*z", restitution = {}}}]
)toml",
        -speed, draw(-2, 2), draw(-2, 2), y, fall, draw(-1, 1), draw(-1, 1), draw(-0.3, 0.3), draw(-3, 3), draw(-3, 3),
        draw(-1, 1), draw(-0.5, 0.5), draw(-0.3, 0.3), draw(0.03, 0.2), root, gamma, draw(-0.5, 0.5), draw(-0.3, 0.3),
        draw(0.03, 0.2)));
}

// The certificates of early cuts, against runs that are cut at the resolution of double precision: the time of the
// collapse is in its interval, and the states just after both collapses differ by no more than the shadowing bounds.
TEST(Collapse, CertificatesOfEarlyCutsContainTheTrueMotion) {
    std::mt19937 random(43);
    test::EarlyCuts cuts;
    for (int i = 0; i < 100; ++i) {
        SCOPED_TRACE(i);
        cuts.compare(random_pair(random));
    }
    EXPECT_GE(cuts.compared, 40);
    EXPECT_GE(cuts.resolved, 20);   // else the cuts were not early
    EXPECT_GT(cuts.closest, 1e-4);  // else the bounds would say nothing
}

// A third coordinate along both planes: z'' = x' + y', so that z' - x - y never changes, whatever impacts and however
// early the cut.
TEST(Collapse, CutsKeepWhatNoImpactChanges) {
    auto system = planes("0.9", "0.1", fast_start, "x + y")->description();
    CoordinateDescription& z = system.coordinates.emplace_back();
    z.name = "z";
    z.force.text = "x' + y'";
    system.kinetic.text += " + z'^2/2";
    const auto model = std::make_shared<const Model>(std::move(system));
    for (const double eps : {1e-2, 1e-3, 1e-6}) {
        const Trajectory run = run_with(model, eps, Method::taylor);
        ASSERT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        EXPECT_EQ(collapses_of(run).size(), 1u);
        EXPECT_NEAR(run.end.v[2] - run.end.q[0] - run.end.q[1], -run.run.q[0] - run.run.q[1], 1e-12) << eps;
    }
}

// The impulses are those of the plastic impact on both, and the energy balance closes.
TEST(Collapse, ReportsThePlasticImpact) {
    const auto model = load_collapse("collapse_both_open");
    const Trajectory run = run_with(model, 1e-8, Method::taylor);
    const Event event = collapses_of(run).at(0);
    ASSERT_NE(event.collapse_info, nullptr);
    const Vector v = event.truncation->v_before;
    const double gamma = 0.9, sigma_p = v[0], sigma_r = -gamma * v[0] + std::sqrt(1.0 - gamma * gamma) * v[1];
    const double det = 1.0 - gamma * gamma, p0 = -(sigma_p + gamma * sigma_r) / det,
                 p1 = -(gamma * sigma_p + sigma_r) / det;
    EXPECT_NEAR(event.collapse_info->impulses.at(0).second, p0, 1e-12);
    EXPECT_NEAR(event.collapse_info->impulses.at(1).second, p1, 1e-12);
    EXPECT_GT(p0, 0.0);
    EXPECT_GT(p1, 0.0);
    EXPECT_NEAR(event.collapse_info->loss, 0.5 * v.squaredNorm(), 1e-12);  // the planes meet in a point
    EXPECT_NEAR(event.collapse_info->speed_ratio, 0.7671, 1e-4);
    EXPECT_NEAR(event.collapse_info->gap_ratio, 0.01304, 1e-5);
    const auto energy = [](const Vector& q, const Vector& rate) {
        return 0.5 * rate.squaredNorm() - q[0] - 4.358898943540674 * q[1];
    };
    EXPECT_NEAR(energy(run.end.q, run.end.v) - energy(run.run.q, run.run.v), run.work - run.loss, 1e-9);
}

// Tilted by 1e-6, the crank's slider comes to lie flat on one guide five times: once after impacts in turn, then in
// ties. e = 0.4 and 0.1.
TEST(Collapse, TheSliderCrankRunsToItsEnd) {
    const auto model = load_collapse("slider_crank_tilted");
    for (const char* e : {"0.4", "0.1"}) {
        const nlohmann::json truth = reference()["slider_crank"][e];
        for (const Method method : test::both_methods) {
            const Trajectory run = run_with(model, 1e-11, method, std::stod(e));
            ASSERT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
            const auto collapses = collapses_of(run);
            ASSERT_EQ(collapses.size(), truth["collapse"].size());
            for (std::size_t i = 0; i < collapses.size(); ++i) {
                EXPECT_NEAR(collapses[i].t, truth["collapse"][i].get<double>(), 1e-11) << i;
                EXPECT_EQ(collapses[i].mode.held(), collapses[i].contacts);
                EXPECT_TRUE(collapses[i].opened.empty());
            }
            for (int k = 0; k < 3; ++k) {
                EXPECT_NEAR(run.end.q[k], truth["end"]["theta"][static_cast<std::size_t>(k)].get<double>(), 1e-9);
                EXPECT_NEAR(run.end.v[k], truth["end"]["rates"][static_cast<std::size_t>(k)].get<double>(), 1e-6);
            }
            EXPECT_EQ(run.ambiguous_impacts, 0);
        }
    }
}

// The error of a completed collapse is of first order in u H: at a later time, for cuts over three decades.
TEST(Collapse, HasAnErrorOfFirstOrderInSpeedTimesGap) {
    const auto model = load_collapse("slider_crank_tilted");
    const auto run_to = [&](double eps) {
        auto run = model->default_run();
        run.options.tolerance = 1e-15;
        run.options.end_time = 0.005;
        run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = eps;
        run.parameters.back() = 0.4;
        return simulate(model, run);
    };
    const Trajectory truth = run_to(1e-13);
    std::vector<std::pair<double, double>> points;
    for (double eps = 1e-6; eps > 5e-10; eps *= 0.1) {
        const Trajectory run = run_to(eps);
        const auto collapses = collapses_of(run);
        ASSERT_EQ(collapses.size(), 1u) << eps;
        const Event::TruncationRecord& cut = *collapses[0].truncation;
        double gap = 0.0;
        for (const std::size_t i : collapses[0].contacts) {
            auto terms = model->evaluator(model->programs_of(i).contact_terms, run.run.parameters);
            set_state(terms, State{cut.q, cut.v_before, cut.t});
            terms.run();
            gap = std::max(gap, terms.h());
        }
        const double error = (run.end.q - truth.end.q).norm() + (run.end.v - truth.end.v).norm();
        if (!points.empty() && points.back().first == std::log(cut.impact_speed * gap)) continue;  // the same cut
        points.emplace_back(std::log(cut.impact_speed * gap), std::log(error));
    }
    ASSERT_GE(points.size(), 3u);
    const auto [x0, y0] = points.front();
    const auto [x1, y1] = points.back();
    EXPECT_NEAR((y1 - y0) / (x1 - x0), 1.0, 0.1);
    // The certificate covers the error at the collapse, which grows little until the end here.
    const Trajectory coarse = run_to(1e-6);
    const Certificate certificate = *collapses_of(coarse)[0].certificate;
    EXPECT_LE((coarse.end.v - truth.end.v).norm(), *certificate.shadowing_velocity);
    EXPECT_LE((coarse.end.q - truth.end.q).norm(), 0.01 * *certificate.shadowing_velocity);
}

// Two contacts that close at once: the plastic impact, whatever the restitutions, unflagged, and also where the user
// asks to stop at order-dependent impacts. Where the first condition fails, Moreau's law stays and is flagged.
TEST(Collapse, ATieIsThePlasticImpact) {
    const std::string start_closed =
        "start = 0\nrate = -1\n[[coordinate]]\nname = \"y\"\nstart = 0\nrate = -4.358898943540674\n";
    for (const Simultaneous simultaneous : {Simultaneous::moreau, Simultaneous::stop}) {
        const auto model = planes("0.9", "0.1", start_closed, "x + y");
        auto run = model->default_run();
        run.options.simultaneous = simultaneous;
        const Trajectory tie = simulate(model, run);
        ASSERT_EQ(tie.outcome.kind, Outcome::Kind::end_time) << tie.outcome.message;
        ASSERT_EQ(tie.events.size(), 2u);
        EXPECT_TRUE(tie.events[0].is_impact());
        EXPECT_FALSE(tie.events[0].joint->order_matters);
        EXPECT_EQ(tie.events[0].v_after, Vector::Zero(2));
        EXPECT_TRUE(tie.events[1].is_collapse());
        EXPECT_EQ(tie.events[1].certificate->zeno_low, tie.events[1].certificate->zeno_high);
        EXPECT_EQ(tie.end_mode.held().count(), 2u);
        EXPECT_NEAR(tie.loss, 10.0, 1e-12);
        EXPECT_EQ(tie.ambiguous_impacts, 0);
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_NEAR(tie.events[1].collapse_info->impulses[i].second, tie.events[0].joint->impulses[i].second,
                        1e-12);
    }
    const auto slow = planes("0.5", "0.5", start_closed, "x + y");
    const Trajectory flagged = simulate(slow, slow->default_run());
    EXPECT_TRUE(flagged.events.at(0).joint->order_matters);
    EXPECT_TRUE(collapses_of(flagged).empty());
}

// A start a little before or after the tie leads to the same motion: the law is continuous.
TEST(Collapse, IsContinuousAtATie) {
    const auto end_of = [](double shift) {
        const std::string start = "start = 0.01\nrate = -1\n[[coordinate]]\nname = \"y\"\nstart = " +
                                  fmt::format("{:.17g}", 0.01 * 1.9 / std::sqrt(0.19) + shift) +
                                  "\nrate = -4.358898943540674\n";
        const auto model = planes("0.9", "0.1", start, "-x - 4.358898943540674*y");
        const Trajectory run = simulate(model, model->default_run());
        EXPECT_EQ(run.outcome.kind, Outcome::Kind::end_time) << run.outcome.message;
        return run.end;
    };
    const State tie = end_of(0.0);
    for (const double shift : {1e-9, -1e-9, 1e-12, -1e-12, 1e-15, -1e-15}) {
        const State near = end_of(shift);
        EXPECT_LE((near.q - tie.q).norm(), 1e-9 + 10.0 * std::abs(shift)) << shift;
        EXPECT_LE((near.v - tie.v).norm(), 1e-8 + 100.0 * std::abs(shift)) << shift;
    }
}

// The unit of a gap changes nothing.
TEST(Collapse, DoesNotDependOnTheUnitOfAGap) {
    const auto run = [](const std::string& unit) {
        const auto model = planes("0.9", "0.1", fast_start, "x + y", unit);
        return simulate(model, model->default_run());
    };
    const Trajectory one = run("1"), thousand = run("1000");
    ASSERT_EQ(collapses_of(one).size(), 1u);
    ASSERT_EQ(collapses_of(thousand).size(), 1u);
    EXPECT_NEAR(collapses_of(one)[0].t, collapses_of(thousand)[0].t, 1e-12);
    EXPECT_EQ(collapses_of(one)[0].truncation->t, collapses_of(thousand)[0].truncation->t);
}

// A third contact that stays open by 1e-9 must be proved open: the cut waits until the motion that is left is shorter.
TEST(Collapse, WaitsUntilAnotherContactIsProvedOpen) {
    const auto two = planes("0.9", "0.1", fast_start, "x + y");
    auto system = two->description();
    ConstraintDescription third = system.constraints.front();
    third.name = "third";
    third.gap.text = "x + 1e-9";
    system.constraints.push_back(third);
    const auto three = std::make_shared<const Model>(std::move(system));
    const Trajectory alone = simulate(two, two->default_run()), beside = simulate(three, three->default_run());
    ASSERT_EQ(collapses_of(alone).size(), 1u);
    ASSERT_EQ(collapses_of(beside).size(), 1u) << beside.outcome.message;
    const Event one = collapses_of(alone)[0], other = collapses_of(beside)[0];
    EXPECT_GT(other.truncation->t, one.truncation->t);
    ASSERT_TRUE(other.certificate->others);
    EXPECT_GT(other.certificate->others->least_gap.value(), 0.0);
    EXPECT_LE(other.certificate->others->least_gap.value(), 1e-9);
    EXPECT_NEAR(other.t, one.t, 1e-11);
}

// Four balls in a row: all three gaps lose their speeds, although no pair could. This is open: the run is undecided, and
// says which inequality failed.
TEST(Collapse, OfFourBallsIsUndecidedAndNamesTheInequality) {
    std::string text = "title = \"four balls\"\n", kinetic;
    for (const std::string i : {"1", "2", "3", "4"}) {
        text += "[[coordinate]]\nname = \"x" + i + "\"\nstart = " + i + "\n" + (i == "1" ? "rate = 1\n" : "");
        kinetic += (kinetic.empty() ? "x" : " + x") + i + "'^2/2";
    }
    text += "[lagrangian]\nkinetic = \"" + kinetic + "\"\npotential = \"0\"\n";
    for (const auto& [a, b] : {std::pair{"1", "2"}, {"2", "3"}, {"3", "4"}})
        text += std::string("[[constraint]]\nname = \"g") + a + "\"\ngap = \"x" + b + " - x" + a +
                " - 0.99\"\nrestitution = 0.1\n";
    const auto model = test::typed(text + "[run]\nend_time = 1\n");
    const Trajectory run = simulate(model, model->default_run());
    ASSERT_EQ(run.outcome.kind, Outcome::Kind::undecided) << run.outcome.message;
    EXPECT_NE(run.outcome.message.find("chatter together"), std::string::npos) << run.outcome.message;
    EXPECT_NE(run.outcome.message.find(std::string("is not: ") + std::string(collapse::real)), std::string::npos)
        << run.outcome.message;
}

// A step of this run leaves the floor that two corners are held on by more than the projection can mend. The run is then
// repeated at a smaller tolerance, and does not say that a gap has no normal.
TEST(Collapse, RepeatsARunThatLeavesItsSurfaces) {
    const auto model = test::load("slider_crank_clearance");
    achilles::Run run = model->default_run();
    run.options.tolerance = 1e-12;
    run.q << -0.001187884830389254, -0.0013860120405629213, 0.002222037497871605;
    run.v << 37.286202545065095, 1.349932202400936, 1.794010051864472;
    const Trajectory trajectory = simulate(model, run);
    EXPECT_EQ(trajectory.outcome.kind, Outcome::Kind::end_time) << trajectory.outcome.message;
    EXPECT_TRUE(trajectory.rerun_options);
}

}  // namespace
}  // namespace achilles
