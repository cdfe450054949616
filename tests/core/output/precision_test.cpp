// Printed digits: none that error or rounding may change.
#include "output/precision.hpp"

#include <gtest/gtest.h>

#include "core/sensitivity/estimates.hpp"
#include "output/event_descriptions.hpp"
#include "output/output.hpp"

namespace achilles::test {
namespace {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Trajectory shaken(double end = 10.0) {
    const auto model = std::make_shared<const Model>(read_system(source_file("tests/reference/horizon/shaker.toml")));
    Run run = model->default_run();
    run.options.end_time = end;
    return simulate(model, run);
}

TEST(KnownDigits, EndWhereTheErrorBegins) {
    EXPECT_EQ(known_digits(0.191615571, 0.0, 9), "0.191615571");
    EXPECT_EQ(known_digits(0.191615571, 2e-9, 9), "0.191615571");
    EXPECT_EQ(known_digits(0.191615571, 2e-5, 9), "0.19162");
    EXPECT_EQ(known_digits(-0.191615571, 0.04, 9), "-0.19");
    EXPECT_EQ(known_digits(1234.5, 20.0, 9), "1.23e+03");
    EXPECT_EQ(known_digits(0.0, 1e-3, 9), "0");
    EXPECT_EQ(known_digits(2.77556e-16, 1e-14, 6), "0") << "zero to its error";
    EXPECT_EQ(known_digits(6e-4, 1e-3, 9), "0.0006") << "nearer to 0.001 than to 0";
    EXPECT_EQ(known_digits(0.191615571, std::numeric_limits<double>::infinity(), 9), unknown_number);
    EXPECT_EQ(known_decimals(2e-5, 9), 5);
    EXPECT_EQ(known_decimals(20.0, 9), 0);
    EXPECT_EQ(known_decimals(0.0, 9), 9);
}

TEST(MeaninglessEnd, IsSaidFirstInSummaryAndJson) {
    const Trajectory trajectory = shaken();
    const ErrorEstimate estimate = estimate_error(trajectory);
    const std::string text = summary(trajectory);
    const std::string first = text.substr(text.find('\n') + 1);
    EXPECT_EQ(first.find(fmt::format("  trusted until t = {:.6g} s, not to the end: ", *estimate.trusted_until)), 0U)
        << text;
    EXPECT_TRUE(holds(text, ": y = ? m; y' = ? m/s\nthe error at the end is not known: the run is trusted until t = "))
        << text;
    EXPECT_FALSE(holds(text, fmt::format("{:.3g}", trajectory.end.q[0]))) << text;
    EXPECT_TRUE(holds(text, "impact    t = ?                gap speed ? of floor\n")) << text;
    const auto json = nlohmann::json::parse(to_json(trajectory));
    EXPECT_EQ(json["trusted_until"], *estimate.trusted_until);
    EXPECT_EQ(json["warnings"][0].get<std::string>().find("trusted until t = "), 0U);
    EXPECT_EQ(json["end"]["q"][0], trajectory.end.q[0]) << "data hold every digit";
    EXPECT_EQ(json["outcome"]["kind"], "end time");
}

TEST(MeaninglessEnd, IsNotWhereTheRunEndsBefore) {
    const Trajectory trajectory = shaken(4.0);
    const auto json = nlohmann::json::parse(to_json(trajectory));
    EXPECT_EQ(json["trusted_until"], 4.0);
    EXPECT_TRUE(json["warnings"].empty());
    EXPECT_FALSE(holds(summary(trajectory), "?")) << summary(trajectory);
}

// At the end of the gallery's most and least accurate run.
TEST(Summary, PrintsNoDigitBeyondTheEstimate) {
    for (const char* name : {"ball_on_sine", "ball_in_gusts", "double_pendulum"}) {
        const auto model = load(name);
        const Trajectory trajectory = simulate(model, with(model->default_run(), 1e-6, 1e-6));
        const ErrorEstimate estimate = estimate_error(trajectory);
        const std::string text = summary(trajectory);
        const auto& coordinates = model->description().coordinates;
        for (std::size_t i = 0; i < coordinates.size(); ++i) {
            const double size = estimate.course.at(trajectory.end_time)->q[static_cast<Eigen::Index>(i)];
            const std::string end = text.substr(text.find("\nend at t = "));
            const std::size_t at = end.find(coordinates[i].name + " = ");
            ASSERT_NE(at, std::string::npos) << end;
            const std::string number = end.substr(at + coordinates[i].name.size() + 3, 20);
            const std::string digits = number.substr(0, number.find_first_of(" ,;"));
            const std::size_t point = digits.find('.');
            const auto decimals = point == std::string::npos ? 0 : static_cast<int>(digits.size() - point) - 1;
            if (digits.find('e') != std::string::npos) continue;
            EXPECT_GT(std::pow(10.0, -decimals), 0.1 * size) << name << ": " << digits << " of " << size;
        }
    }
}

// Zero within rounding: a held gap, an angle of 0, a coordinate that is small relative to others of its unit.
TEST(Precision, KnowsWhatIsZeroToRounding) {
    const auto model = typed(
        "title = \"noise\"\n[[coordinate]]\nname = \"x\"\nstart = 2\nunit = \"m\"\n[[coordinate]]\nname = \"z\"\n"
        "start = 1.183e-30\nunit = \"m\"\n[[coordinate]]\nname = \"phi\"\nstart = -7.07495065e-17\nunit = \"rad\"\n"
        "[lagrangian]\nkinetic = \"(x'^2 + z'^2 + phi'^2)/2\"\npotential = \"0\"\n"
        "[[constraint]]\ngap = \"x\"\nrestitution = 0.5\n[run]\nend_time = 1\n");
    const Trajectory trajectory = simulate(model, model->default_run());
    ASSERT_NE(trajectory.end.q[1], 0.0);
    ASSERT_NE(trajectory.end.q[2], 0.0);
    const std::string text = summary(trajectory);
    EXPECT_TRUE(holds(text, ": x = 2 m, z = 0 m, phi = 0 rad; ")) << text;
    EXPECT_TRUE(holds(to_json(trajectory), "1.183e-30"));
    const Precision precision(trajectory);
    const State errors = precision.of_state(0.5);
    EXPECT_EQ(known_digits(1e-7, errors.q[1], 6), "1e-07") << "what is small is no noise";
    EXPECT_EQ(known_digits(3e-15, errors.q[2], 6), "0");
}

// A nonlinear expression of an unknown coordinate is unknown; an expression of known ones is known.
TEST(Precision, OfAnExpressionIsThatOfItsCoordinates) {
    const Trajectory trajectory = shaken();
    const ErrorEstimate estimate = estimate_error(trajectory);
    const Precision precision(trajectory, &estimate);
    const Sample end = trajectory(9.0);
    EXPECT_TRUE(std::isinf(precision.of([](const Sample& s) { return std::sin(s.state.q[0]); }, end)));
    EXPECT_EQ(precision.of([](const Sample& s) { return std::sin(s.t); }, end), 0.0);
    EXPECT_TRUE(std::isinf(precision.of_energy(end)));
    const Sample early = trajectory(1.0);
    const double error = precision.of([](const Sample& s) { return 2.0 * s.state.q[0]; }, early);
    EXPECT_GT(error, 0.0);
    EXPECT_LT(error, 1e-8);
}

// With angles in degrees, gap speeds are in degrees, too.
TEST(Sentences, TellGapSpeedsInTheUnitOfTheAngles) {
    const auto model = load("double_pendulum");
    const Trajectory trajectory = simulate(model, model->default_run());
    ASSERT_EQ(trajectory.events[0].kind, Event::Kind::impact);
    const double speed = trajectory.events[0].impact_speed;
    EXPECT_TRUE(holds(EventDescriptions(trajectory).of(0), fmt::format("gap speed {:.4g} rad/s", speed)));
    EXPECT_TRUE(holds(EventDescriptions(trajectory, nullptr, EventDescriptions::Angles::degrees).of(0),
                      fmt::format("gap speed {:.4g} deg/s", speed * 57.29577951308232)));
}

}  // namespace
}  // namespace achilles::test
