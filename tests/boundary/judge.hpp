// The boundary between two courses of events: what a run decided, what is true, and whether the run could know.
#pragma once

#include <memory>
#include <string>

#include "boundary/course.hpp"
#include "model/model.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

// How runs are simulated. Of runs eight at a time the ends are known.
enum class Way { taylor, dopri5, eight };
constexpr Way ways[] = {Way::taylor, Way::dopri5, Way::eight};
std::string to_text(Way way);
constexpr std::size_t most_true_events = 500;  // a longer truth is not waited for
constexpr double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-13};

// A start, and what happens from it in 34 digits.
struct Question {
    std::shared_ptr<const Model> model;
    Run run;  // its tolerance and method are chosen when it is asked
    bool in_contact = false;
    double longest_true_step = 1e300;  // s, so that the truth sees what is thin
};

// The system, the start in digits that give the same bits back, and the options.
std::string repeat(const Question& question, Way way, double tolerance);

enum class Verdict {
    right,
    undecided,   // which is allowed, and is not a wrong answer in disguise
    wrong,       // but the run's state was as far from the truth as the truth was from the other decision
    blatant,     // wrong, though the distance to the decision was more than ten times the error
    unmeasured,  // wrong, and how far it was could not be told
    failed,      // another outcome than the end time
    refused      // no start
};
std::string to_text(Verdict verdict);

struct Judgement {
    Verdict verdict = Verdict::right;
    // How far the least gap or force of the truth is from zero where it decides, and by how much the same is wrong if
    // the truth goes on from the run's own state shortly before: the run's global error, in the same unit.
    double distance = 0.0, error = 0.0;
    std::string told;  // what is wrong, for a person; empty if nothing is
    double end = 0.0;  // how far the run came
};

class Judge34 {
 public:
    // Throws std::runtime_error where the truth is not known.
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

// What is wrong with a trajectory whatever is true: an impact stored below the floor, time that runs back. Empty if
// nothing is.
std::string impossible(const Trajectory& trajectory);

}  // namespace achilles::test
