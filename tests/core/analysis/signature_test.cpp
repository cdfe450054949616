// Which event sequences have the same signature, and which have not.
#include "analysis/measures.hpp"

#include <gtest/gtest.h>

#include <set>

#include "analysis/table.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

constexpr auto impact = Event::Kind::impact, zeno = Event::Kind::zeno, release = Event::Kind::release;
const ContactSet left = ContactSet::of(0), right = ContactSet::of(1);

std::uint64_t of(std::initializer_list<std::pair<Event::Kind, ContactSet>> events,
                 Outcome::Kind outcome = Outcome::Kind::end_time) {
    std::vector<EventRecord> sequence;
    for (const auto& [kind, contacts] : events) sequence.push_back({kind, contacts, 1.0, 1.0});
    return signature_of(sequence, RunEnd(outcome));
}

TEST(Signature, LeavesOutTheImpactsBeforeRest) {
    EXPECT_EQ(of({{impact, left}, {impact, left}, {zeno, left}}), of({{zeno, left}}));
    EXPECT_EQ(of({{zeno, left}, {release, left}, {impact, left}, {zeno, left}}),
              of({{zeno, left}, {release, left}, {zeno, left}}));
    EXPECT_NE(of({{impact, left}, {impact, left}}), of({{impact, left}})) << "nothing comes to rest";
    EXPECT_NE(of({{zeno, left}, {impact, left}}), of({{zeno, left}})) << "it is after it";
    EXPECT_EQ(of({{impact, left}, {impact, right}, {impact, left}, {zeno, left}, {impact, right}, {zeno, right}}),
              of({{zeno, left}, {zeno, right}}));
    EXPECT_EQ(of({{impact, left.with(right)}, {zeno, left.with(right)}}), of({{zeno, left.with(right)}}));
}

TEST(Signature, DiffersForDifferentEventSequences) {
    const std::set<std::uint64_t> all{
        of({}),
        of({}, Outcome::Kind::too_many_impacts),
        signature_of({}, RunEnd()),
        of({{impact, left}}),
        of({{impact, right}}),
        of({{impact, left}, {impact, right}}),
        of({{impact, right}, {impact, left}}),
        of({{impact, left.with(right)}}),
        of({{zeno, left}}),
        of({{release, left}}),
        of({{zeno, left}, {release, left}}),
        of({{release, left}, {zeno, left}}),
        of({{impact, right}, {zeno, left}}),                  // an impact of another contact
        of({{impact, left}, {impact, right}, {zeno, left}}),  // and an impact of the same one before
        of({{impact, left}, {zeno, left}, {release, left}}, Outcome::Kind::undecided),
    };
    EXPECT_EQ(all.size(), 15u);
}

// The signature is the same for runs in lanes and for single runs, whatever the cut.
TEST(Signature, DoesNotDependOnLanesOrTheCut) {
    const auto model = test::load("ball_on_sine");
    const std::string sweep = "--over e=0.1:0.8:40 --print x --end 6";
    const auto rows_of = [&](const std::string& text) {
        const SweepTable table(model, read_sweep(text, model->description()));
        return table.rows(0, 40);
    };
    const Rows ends = rows_of(sweep), whole = rows_of(sweep + " --print least_gap"),
               coarse = rows_of(sweep + " --eps-q 1e-3 --eps-v 1e-3 --eps-t 1e-3");
    EXPECT_EQ(ends.signatures, whole.signatures);
    EXPECT_EQ(ends.signatures, coarse.signatures);
    const std::set<std::uint64_t> different(ends.signatures.begin(), ends.signatures.end());
    EXPECT_GT(different.size(), 1u);
    EXPECT_LT(different.size(), 15u);
}

TEST(Signature, StandsInEveryRowOfARun) {
    const auto model = test::load("ball_on_sine");
    const SweepTable table(model, read_sweep("--over y=-3:3:3 --at impact --print x --end 3", model->description()));
    const Rows rows = table.rows(0, 3);
    ASSERT_EQ(rows.signatures.size(), rows.count());
    EXPECT_EQ(rows.signatures[0], signature_of({}, RunEnd())) << "it cannot start";
    const std::set<std::uint64_t> of_last(rows.signatures.begin() + 1, rows.signatures.end());
    EXPECT_LE(of_last.size(), 2u);
}

}  // namespace
}  // namespace achilles
