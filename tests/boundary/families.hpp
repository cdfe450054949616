// Families of systems and starts near where the course of events changes: what the boundary attack asks.
#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "boundary/judge.hpp"

namespace achilles::test {

// Reproducible numbers. Written out, since the standard's distributions differ between libraries.
class Dice {
 public:
    explicit Dice(unsigned seed) : random_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }
    double log_uniform(double low, double high);
    // A multiple of 2^-12, so that a system is the same in any number of digits.
    double dyadic(double low, double high);
    template <class T, std::size_t n>
    T one_of(const T (&list)[n]) {
        return list[random_() % n];
    }

 private:
    std::mt19937_64 random_;
};

// A system of two coordinates, as a file in memory.
std::shared_ptr<const Model> written(const std::string& coordinates, const std::string& kinetic,
                                     const std::string& potential, const std::string& gap, double e);

// ---- a force that dips just below zero at the crest of a hill ----

// From contact at a0 < 0, so fast that the least force of the contact motion, which it has at the crest a = 0, is
// -hddot = `least`. The gap is b - 0.25 cos(a), T = (a'^2 + b'^2)/2, V = b, e = 0.5.
class Crest {
 public:
    Crest();
    Question start(double a0, double least) const;
    // The same, but so that a step of the way ends `into` half widths of the dip past the crest, to within one. Nothing
    // where no such start is found.
    std::optional<Question> start_with_a_step_into(double a0, double least, double into, Way way,
                                                   double tolerance) const;
    // Start number i of the attack: the least force is -0.3 of the tolerance, and every other start is such that a step
    // of a way simulate() takes ends near the dip, where the force is within what the integration knows of it.
    Question attack(Dice& dice, long i, double tolerance) const;

 private:
    std::vector<double> steps(const Question& question, Way way, double tolerance) const;
    std::shared_ptr<const Model> model_;
};

// Whether a run from contact lets go. Its force dips below zero, so it must not be held.
enum class Hold { released, undecided, held };
Hold hold(const Question& question, Way way, double tolerance);

// ---- bisected starts ----

enum class Family { waves, fine_waves, post, bumps };
constexpr Family families[] = {Family::waves, Family::fine_waves, Family::post, Family::bumps};
std::string to_text(Family family);

class Boundaries {
 public:
    Boundaries(Family family, bool in_contact, unsigned seed);
    // Starts on either side of one boundary between two true courses of events of a random system, at the distances
    // 1e-2 to 1e-13 from it.
    std::vector<Question> next();

 private:
    // All systems are a floor below their second coordinate: a start is (q1, height, v1, v2), in contact (q1, 0, v1, 0)
    // with the rate that keeps contact.
    using Chart = std::array<double, 4>;
    void draw_system();
    Chart draw_start();
    Question question(const Chart& chart) const;
    // Empty where the start does not serve.
    std::string true_course(const Chart& chart, double end_time) const;
    std::optional<std::array<Chart, 2>> bisect(Chart low, Chart high) const;

    Family family_;
    bool in_contact_;
    Dice dice_;
    std::shared_ptr<const Model> model_;
    double end_time_ = 0.0;
};

// ---- cases that were once decided wrongly ----

struct KnownCase {
    std::string name;
    Question question;
    Way way;
    double tolerance;
    double least_end = 0.0;  // a run that is undecided before this was wrong to give up
};
std::vector<KnownCase> known_cases();

}  // namespace achilles::test
