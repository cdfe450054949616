// Runs close to a boundary where their sequence of events changes: a sample of what bench_boundary tests at length.
#include <gtest/gtest.h>

#include "boundary/families.hpp"
#include "core/systems.hpp"

namespace achilles::test {
namespace {

// A contact force that dips to -0.3 of the tolerance causes a release, or the run is undecided. The contact is not
// held.
TEST(Boundary, NoFalseContactOnACrest) {
    const Crest crest;
    for (const Way way : ways) {
        Dice dice(16);
        for (long i = 0; i < 300; ++i) {
            const double tolerance = tolerances[i % 5];
            const Question question = crest.attack(dice, i / 5, tolerance);
            EXPECT_NE(hold(question, way, tolerance), Hold::held) << repeat(question, way, tolerance);
        }
    }
}

TEST(Boundary, WhatWasDecidedWronglyOnce) {
    for (const KnownCase& known : known_cases()) {
        Judge34 judge(known.question);
        const Judgement judgement = judge.judge(known.way, known.tolerance);
        EXPECT_LE(judgement.verdict, Verdict::undecided) << known.name << ": " << judgement.told << "\n"
                                                         << repeat(known.question, known.way, known.tolerance);
        if (judgement.verdict != Verdict::undecided) continue;
        EXPECT_GE(judgement.end, known.min_end) << known.name << " by " << to_text(known.way);
    }
}

// Starts 1e-2 to 1e-13 from the boundary. A wrong answer is allowed only if the boundary is within ten times the run's
// error.
TEST(Boundary, NoWrongAnswerFartherThanTenErrors) {
    int asked = 0, right = 0;
    for (const Family family : families) {
        for (const bool in_contact : {false, true}) {
            Boundaries source(family, in_contact, 7 + static_cast<unsigned>(family));
            const std::vector<Question> questions = source.next();
            for (std::size_t i = 0; i < questions.size(); i += 31) {  // alternating sides
                const Question& question = questions[i];
                Judge34 judge(question);
                for (const Way way : ways) {
                    for (const double tolerance : tolerances) {
                        const Judgement judgement = judge.judge(way, tolerance);
                        EXPECT_LE(judgement.verdict, Verdict::wrong)
                            << to_text(judgement.verdict) << ": " << judgement.told << "\n"
                            << repeat(question, way, tolerance);
                        ++asked;
                        right += judgement.verdict == Verdict::right ? 1 : 0;
                    }
                }
            }
        }
    }
    EXPECT_GT(right, asked / 3);
}

// The comparison must reject a missing impact, an extra one, and a false release or Zeno point.
TEST(BoundaryJudge, RejectsWrongEvents) {
    const auto model = load("ball_on_sine");
    Question question{model, model->default_run(), false};
    question.run.options.end_time = 6.0;
    Judge34 judge(question);
    EXPECT_EQ(judge.judge(Way::taylor, 1e-10).verdict, Verdict::right);
    const Course truth = course_of(judge.truth(), 6.0);
    const Course own = course_of(simulate(model, question.run));
    EXPECT_FALSE(first_difference(own, truth, {}));

    using Kind = Difference::Kind;
    const auto found = [&](const Course& course) {
        const auto difference = first_difference(course, truth, {});
        return difference ? std::optional(difference->kind) : std::nullopt;
    };
    Course fewer = own;
    fewer.stretches[0].impacts.erase(fewer.stretches[0].impacts.begin() + 1);
    EXPECT_EQ(found(fewer), Kind::missed_impact);
    Course more = own;
    more.stretches[0].impacts.insert(more.stretches[0].impacts.begin() + 1, 2.0);
    EXPECT_EQ(found(more), Kind::extra_impact);
    Course held = own;
    held.stretches.resize(2);
    EXPECT_EQ(found(held), Kind::missed_release);
    Course late = own;
    late.stretches[0].zeno_low += 1e-3;
    late.stretches[0].zeno_high += 1e-3;
    EXPECT_EQ(found(late), Kind::zeno_time);
    Course restless = own;
    restless.stretches.resize(1);
    restless.stretches[0].cut = false;
    EXPECT_EQ(found(restless), Kind::missed_impact);
    const auto counts_alone = [](Course course) {
        course.timed = false;
        return course;
    };
    restless = counts_alone(restless);
    restless.stretches[0].count = 1;
    EXPECT_EQ(found(restless), Kind::missed_impact);
    EXPECT_FALSE(found(counts_alone(own)));
}

}  // namespace
}  // namespace achilles::test
