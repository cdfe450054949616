// Test cases of the boundary attack: families of systems with starts near a boundary, where the course of events
// changes.
#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "boundary/judge.hpp"

namespace achilles::test {

// Reproducible random numbers. Own formulas, since the distributions of the standard library differ between
// implementations.
class Dice {
 public:
    explicit Dice(unsigned seed) : random_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }
    double log_uniform(double low, double high);
    // A multiple of 2^-12, which is exact in any binary precision.
    double dyadic(double low, double high);
    template <class T, std::size_t n>
    T one_of(const T (&list)[n]) {
        return list[random_() % n];
    }

 private:
    std::mt19937_64 random_;
};

// A system of two coordinates from these texts.
std::shared_ptr<const Model> written(const std::string& coordinates, const std::string& kinetic,
                                     const std::string& potential, const std::string& gap, double e);

// ---- a contact force with a minimum just below zero, at the crest of a hill ----

// Starts in contact at a0 < 0. The speed is such that the minimum of the contact force, at the crest a = 0, is
// -hddot = `least`. The gap is b - 0.25 cos(a), T = (a'^2 + b'^2)/2, V = b, e = 0.5.
class Crest {
 public:
    Crest();
    Question start(double a0, double least) const;
    // The same, with a step that ends `into` half-widths of the minimum past the crest, to within one half-width.
    // nullopt if no such start is found.
    std::optional<Question> start_with_a_step_into(double a0, double least, double into, Way way,
                                                   double tolerance) const;
    // Start number i of the attack: the minimum of the force is -0.3 of the tolerance. For every other start a step of
    // simulate() ends near the minimum, where the force is below the error of the integration.
    Question attack(Dice& dice, long i, double tolerance) const;

 private:
    std::vector<double> steps(const Question& question, Way way, double tolerance) const;
    std::shared_ptr<const Model> model_;
};

// Whether a run from contact releases. Its force falls below zero, so `held` is wrong.
enum class Hold { released, undecided, held };
Hold hold(const Question& question, Way way, double tolerance);

// ---- starts found by bisection ----

enum class Family { waves, fine_waves, post, bumps };
constexpr Family families[] = {Family::waves, Family::fine_waves, Family::post, Family::bumps};
std::string to_text(Family family);

class Boundaries {
 public:
    Boundaries(Family family, bool in_contact, unsigned seed);
    // Starts on both sides of a boundary between two reference courses of a random system, at distances of 1e-2 to
    // 1e-13 from it.
    std::vector<Question> next();

 private:
    // In all systems the gap is the second coordinate minus a function. A start is (q1, height, v1, v2); in contact it
    // is (q1, 0, v1, 0), and the second rate keeps contact.
    using Chart = std::array<double, 4>;
    void draw_system();
    Chart draw_start();
    Question question(const Chart& chart) const;
    // Empty if the start is unsuitable.
    std::string true_course(const Chart& chart, double end_time) const;
    std::optional<std::array<Chart, 2>> bisect(Chart low, Chart high) const;

    Family family_;
    bool in_contact_;
    Dice dice_;
    std::shared_ptr<const Model> model_;
    double end_time_ = 0.0;
};

// ---- cases that were decided wrongly in the past ----

struct KnownCase {
    std::string name;
    Question question;
    Way way;
    double tolerance;
    double min_end = 0.0;  // a run must not be undecided before this time, s
};
std::vector<KnownCase> known_cases();

}  // namespace achilles::test
