#include "boundary/families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "floor/floor.hpp"
#include "model/read_system.hpp"
#include "simulate/impact.hpp"

namespace achilles::test {

double Dice::log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

double Dice::dyadic(double low, double high) { return std::round(uniform(low, high) * 4096.0) / 4096.0; }

std::shared_ptr<const Model> written(const std::string& coordinates, const std::string& kinetic,
                                     const std::string& potential, const std::string& gap, double e) {
    std::string text = "title = \"boundary\"\n";
    for (const char name : coordinates) text += fmt::format("[[coordinate]]\nname = \"{}\"\nstart = 0\n", name);
    text += fmt::format("[lagrangian]\nkinetic = \"{}\"\npotential = \"{}\"\n", kinetic, potential);
    text += fmt::format("[[constraint]]\ngap = \"{}\"\nrestitution = {:.17g}\n", gap, e);
    return std::make_shared<const Model>(parse_system(text, "boundary.toml"));
}

// ---- crest ----

Crest::Crest() : model_(written("ab", "(a'^2 + b'^2)/2", "b", "b - 0.25*cos(a)", 0.5)) {}

// The contact motion conserves a'^2 (1 + (0.25 sin a)^2)/2 + 0.25 cos a. At the crest -hddot = 1 - 0.25 a'^2.
Question Crest::start(double a0, double least) const {
    Question result{model_, model_->default_run(), true};
    const double at_crest = 4.0 * (1.0 - least), slope = -0.25 * std::sin(a0);
    const double speed = std::sqrt((at_crest + 0.5 * (1.0 - std::cos(a0))) / (1.0 + slope * slope));
    result.run.q << a0, 0.25 * std::cos(a0);
    result.run.v << speed, slope * speed;
    result.run.options.end_time = -a0 / 1.9 + 0.2;  // well past the crest, since a' >= 1.95
    return result;
}

// The values of a at the ends of the steps of the contact motion.
std::vector<double> Crest::steps(const Question& question, Way way, double tolerance) const {
    Run run = question.run;
    run.options.method = way == Way::dopri5 ? Method::dopri5 : Method::taylor;
    run.options.tolerance = tolerance;
    const Trajectory trajectory = simulate(model_, run);
    std::vector<double> result;
    for (const DenseSegment& piece : trajectory.pieces) {
        double a = 0.0;
        for (std::size_t k = piece.degree + 1; k-- > 0;) a += trajectory.coefficients[piece.first + 4 * k];
        if (!piece.mode.held().empty()) result.push_back(a);
    }
    return result;
}

// An undecided run ends before the minimum of the force. So its steps are extrapolated from two runs whose force is too
// large for doubt.
std::optional<Question> Crest::start_with_a_step_into(double a0, double least, double into, Way way,
                                                      double tolerance) const {
    const double width = std::sqrt(std::abs(least) / 2.0);  // -hddot increases as (1/2) a'^2 a^2, with a' = 2
    const double aim = into * width, more = std::min(1000.0 * tolerance, 0.03);
    double moved = 0.0, before = 0.0;
    std::size_t step = 0;
    for (int round = 0; round < 20; ++round) {
        if (!(a0 < -0.05 && a0 > -2.5)) return std::nullopt;
        const auto once = steps(start(a0, least + more), way, tolerance);
        const auto twice = steps(start(a0, least + 2.0 * more), way, tolerance);
        const std::size_t count = std::min(once.size(), twice.size());
        const auto off_by = [&](std::size_t i) { return 2.0 * once[i] - twice[i] - aim; };
        if (round == 0)  // choose the end nearest to the aim
            for (std::size_t i = 1; i < count; ++i) step = std::abs(off_by(i)) < std::abs(off_by(step)) ? i : step;
        if (step >= count) return std::nullopt;
        const double off = off_by(step);
        if (std::abs(off) < width) return start(a0, least);
        // The secant method, if the slope is not too small.
        const double slope = moved != 0.0 ? (off - before) / moved : 1.0;
        moved = -off / (std::abs(slope) > 0.1 ? slope : 1.0);
        before = off;
        a0 += moved;
    }
    return std::nullopt;
}

Question Crest::attack(Dice& dice, long i, double tolerance) const {
    const double a0 = dice.uniform(-2.0, -0.3), into = dice.uniform(-20.0, 20.0), least = -0.3 * tolerance;
    std::optional<Question> steered;
    if (i % 2 == 0)
        steered = start_with_a_step_into(a0, least, into, i % 4 == 0 ? Way::taylor : Way::dopri5, tolerance);
    return steered ? *steered : start(a0, least);
}

Hold hold(const Question& question, Way way, double tolerance) {
    Run run = question.run;
    run.options.method = way == Way::dopri5 ? Method::dopri5 : Method::taylor;
    run.options.tolerance = tolerance;
    const Trajectory trajectory = way == Way::eight ? by_eight(question.model, run) : simulate(question.model, run);
    if (trajectory.outcome.kind == Outcome::Kind::undecided) return Hold::undecided;
    // Rounding may turn the start into a flight of zero height.
    const bool flew = std::any_of(trajectory.phases.begin() + 1, trajectory.phases.end(),
                                  [](const Phase& phase) { return phase.kind == Phase::Kind::hybrid; });
    return flew ? Hold::released : Hold::held;
}

// ---- starts found by bisection ----

std::string to_text(Family family) {
    constexpr const char* names[] = {"waves", "fine waves", "post", "bumps"};
    return names[static_cast<std::size_t>(family)];
}

Boundaries::Boundaries(Family family, bool in_contact, unsigned seed)
    : family_(family), in_contact_(in_contact), dice_(seed) {}

void Boundaries::draw_system() {
    const double e = dice_.one_of({0.0625, 0.0625, 0.3, 0.5, 0.8, 0.0});
    const double c1 = dice_.dyadic(0.25, 1.0);
    const double c2 = dice_.uniform(0.0, 1.0) < 0.5 ? c1 : dice_.dyadic(0.25, 1.0);
    end_time_ = dice_.uniform(0.5, 2.5);
    if (family_ == Family::waves || family_ == Family::fine_waves) {
        const double c3 = dice_.dyadic(0.5, 2.0), c4 = dice_.dyadic(-0.5, 0.5);
        const bool fine = family_ == Family::fine_waves;
        const double k = fine ? dice_.dyadic(15.0, 50.0) : dice_.dyadic(1.0, 8.0);
        const double a = fine ? dice_.dyadic(0.02, 0.5) / 64.0 : dice_.dyadic(0.02, 0.2);
        const double b = dice_.dyadic(-0.25, 0.25), l = dice_.dyadic(0.5, 2.0);
        model_ = written("ab", fmt::format("{}*a'^2 + {}*b'^2", c1, c2), fmt::format("{}*b - ({})*a", c3, c4),
                         fmt::format("b - {}*sin({}*a) - ({})*cos({}*a)", a, k, b, l), e);
        return;
    }
    const bool post = family_ == Family::post;
    const double height = post ? dice_.dyadic(0.01, 0.5) : dice_.dyadic(0.1, 10.0) / 1024.0;
    const double width = post ? 400.0 : std::round(dice_.uniform(400.0, 2000.0));
    model_ = written("xy", fmt::format("{}*(x'^2 + y'^2)", c1), fmt::format("{}*y", dice_.dyadic(0.5, 2.0)),
                     fmt::format("y - {}*exp(-{}*(x - 1)^2)", height, width), e);
}

Boundaries::Chart Boundaries::draw_start() {
    const bool waves = family_ == Family::waves || family_ == Family::fine_waves;
    const double q1 = waves ? dice_.uniform(-2.0, 2.0) : dice_.uniform(-0.5, 0.9);
    const double v1 = waves ? dice_.uniform(-2.0, 2.0) : dice_.uniform(0.2, 2.5);
    if (in_contact_) return {q1, 0.0, v1, 0.0};
    return {q1, dice_.log_uniform(0.01, 1.0), v1, dice_.uniform(-1.5, 0.5)};
}

Question Boundaries::question(const Chart& chart) const {
    Question result{model_, model_->default_run(), in_contact_};
    // A post is 0.02 to 0.05 wide, and the speed below 3.
    if (family_ == Family::post || family_ == Family::bumps) result.longest_true_step = 0.01;
    result.run.options.end_time = end_time_;
    State state{result.run.q, result.run.v};
    state.q << chart[0], 0.0;
    state.v << chart[2], 0.0;
    const Contact contact = ContactKinematics(*model_, result.run).at(state);
    result.run.q << chart[0], chart[1] - contact.h;
    result.run.v << chart[2], in_contact_ ? -contact.hdot : chart[3];
    return result;
}

// A converging sequence has infinitely many impacts, so the number that the reference followed does not count.
std::string Boundaries::true_course(const Chart& chart, double end_time) const {
    const Question asked = question(chart);
    if (!in_contact_ && !(chart[1] > 1e-3)) return {};
    TrueRuns runs(*model_, asked.run, max_true_events, asked.longest_true_step);
    const Point start = point_of({asked.run.q, asked.run.v});
    try {
        Course course =
            course_of(in_contact_ ? runs.run_from_contact(start, end_time) : runs.run(start, end_time), end_time);
        for (Stretch& stretch : course.stretches)
            if (stretch.cut) stretch.count = 0;
        return to_text(course);
    } catch (const std::runtime_error&) {
        return {};
    }
}

std::optional<std::array<Boundaries::Chart, 2>> Boundaries::bisect(Chart low, Chart high) const {
    const std::string left = true_course(low, end_time_);
    std::string right = true_course(high, end_time_);
    if (left.empty() || right.empty() || left == right) return std::nullopt;
    const auto differ = [&](double end_time) {
        const std::string a = true_course(low, end_time), b = true_course(high, end_time);
        return !a.empty() && !b.empty() && a != b;
    };
    for (int round = 0; round < 60; ++round) {
        Chart middle;
        for (std::size_t i = 0; i < 4; ++i) middle[i] = 0.5 * (low[i] + high[i]);
        if (middle == low || middle == high) break;
        const std::string course = true_course(middle, end_time_);
        if (course.empty()) return std::nullopt;
        (course == left ? low : high) = middle;
        // Both courses must also differ for a changed end time. Otherwise the boundary is an event at the end of the
        // run.
        if (round == 20 && !(differ(0.98 * end_time_) && differ(1.02 * end_time_))) return std::nullopt;
    }
    return std::array<Chart, 2>{low, high};
}

std::vector<Question> Boundaries::next() {
    for (;;) {
        draw_system();
        for (int tries = 0; tries < 10; ++tries) {
            const Chart from = draw_start();
            Chart to = from;
            for (double& number : to)
                if (number != 0.0) number += dice_.uniform(-0.3, 0.3);
            if (!in_contact_ && !(to[1] > 0.01)) continue;
            const auto boundary = bisect(from, to);
            if (!boundary) continue;
            double norm = 0.0;
            for (std::size_t i = 0; i < 4; ++i) norm += (to[i] - from[i]) * (to[i] - from[i]);
            norm = std::sqrt(norm);
            std::vector<Question> result;
            for (int digits = 2; digits <= 13; ++digits) {
                for (const double side : {-1.0, 1.0}) {
                    Chart chart = (*boundary)[side < 0.0 ? 0 : 1];
                    for (std::size_t i = 0; i < 4; ++i)
                        chart[i] += side * std::pow(10.0, -digits) * (to[i] - from[i]) / norm;
                    if (!in_contact_ && !(chart[1] > 1e-3)) continue;
                    result.push_back(question(chart));
                }
            }
            return result;
        }
    }
}

}  // namespace achilles::test
