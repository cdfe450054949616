// Judges a run near a boundary between two courses of events. Compares it with the reference, and where they differ,
// the run's error with the distance from the boundary.
#pragma once

#include <memory>
#include <string>

#include "boundary/course.hpp"
#include "model/model.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

// How runs are simulated. `eight` simulates in batches and records final states only.
enum class Way { taylor, dopri5, eight };
constexpr Way ways[] = {Way::taylor, Way::dopri5, Way::eight};
std::string to_text(Way way);
constexpr std::size_t max_true_events = 500;  // a reference with more events is given up
constexpr double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-13};

// A test case: system, run and start.
struct Question {
    std::shared_ptr<const Model> model;
    Run run;  // judge() sets its tolerance and method
    bool in_contact = false;
    double longest_true_step = 1e300;  // s, limits the reference's steps so that it resolves thin obstacles
};

// A reproduction: the system, the start with enough digits to restore all bits, and the options.
std::string repeat(const Question& question, Way way, double tolerance);

enum class Verdict {
    right,
    undecided,   // allowed, if the course is right up to there
    wrong,       // with an error of the run's state as large as the distance from the boundary
    blatant,     // wrong, though the distance to the decision was more than ten times the error
    unmeasured,  // wrong, and the distance could not be determined
    failed,      // another outcome than the end time
    refused      // invalid start
};
std::string to_text(Verdict verdict);

struct Judgement {
    Verdict verdict = Verdict::right;
    // `distance`: the decisive minimum of the reference's gap or force, as a distance from zero. `error`: its change if
    // the reference continues from the run's own state shortly before, which is the run's global error in the same
    // unit.
    double distance = 0.0, error = 0.0;
    std::string told;  // description of the error; empty if there is none
    double end = 0.0;  // s, where the run ended
};

class Judge34 {
 public:
    // Throws std::runtime_error if the reference cannot be computed.
    explicit Judge34(const Question& question);
    Judgement judge(Way way, double tolerance);
    const TrueExecution& truth() const { return truth_; }

 private:
    struct Decisive;
    TrueExecution true_run(double end_time);
    Trajectory own_run(Way way, double tolerance, double end_time) const;
    void compare(const Course& own, const Course& truth, Way way, double tolerance, Judgement& result);
    std::optional<Difference> located(Difference difference, Way way, double tolerance) const;
    void measure(const Difference& difference, const Course& own, Way way, double tolerance, Judgement& judgement);
    bool measure_at(double before, const Difference& difference, Way way, double tolerance, Judgement& judgement);
    bool is_its_own(const Difference& difference, Way way, double tolerance);
    bool measure_zeno(const Difference& difference, const Course& own, Way way, double tolerance, Judgement& judgement);
    bool measure_settling(const Difference& difference, Way way, double tolerance, Judgement& judgement);
    std::vector<Decisive> dips(const Point& from, double time, bool contact, double enough);
    Decisive at(const Point& from, double time, bool contact, double when);
    Real quantity(const Point& point, bool contact);

    Question question_;
    TrueMotion motion_;
    TrueRuns runs_;
    Point start_;
    TrueExecution truth_;
    Course course_;
};

// Describes an error that needs no reference: an impact stored below the floor, or time that runs backwards. Empty if
// there is none.
std::string impossible(const Trajectory& trajectory);

}  // namespace achilles::test
