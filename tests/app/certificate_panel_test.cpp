// The certificate card of a Zeno point in the explorer.
#include <gtest/gtest.h>

#include "app/open.hpp"
#include "panels/panels.hpp"
#include "session/results_text.hpp"

namespace achilles {
namespace {

Event first_zeno(const Trajectory& trajectory) {
    for (const Event& event : trajectory.events)
        if (event.kind == Event::Kind::zeno) return event;
    throw std::runtime_error("no Zeno point");
}

TEST(CertificatePanel, TellsTheIntervalTheBoundsAndWhatDecided) {
    Session session = test::session("ball_on_sine");
    session.apply(command::SetConditions{Conditions::sharp});
    const Event sharp = first_zeno(session.trajectory());
    const std::vector<std::string> lines = certificate_lines(sharp);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0].rfind("cut to τ∞: q moves < ", 0), 0u) << lines[0];
    EXPECT_EQ(lines[1].rfind("error until τ∞: q ≤ ", 0), 0u) << lines[1];
    EXPECT_EQ(lines[2].rfind("error at τ∞: q ≤ ", 0), 0u) << lines[2];
    EXPECT_EQ(lines[3].rfind("gap'' from −8.5", 0), 0u) << lines[3];
    session.apply(command::SetConditions{Conditions::paper});
    EXPECT_EQ(certificate_lines(first_zeno(session.trajectory())).size(),
              2u);  // no bound on the reinitialization
    int decisive = 0;
    for (const Inequality& inequality : sharp.certificate->inequalities()) {
        EXPECT_LT(inequality.left, inequality.right);
        decisive += inequality.name == sharp.certificate->tightest_bound ? 1 : 0;
    }
    EXPECT_EQ(decisive, 1);
}

// The card answers first: the point, its time, whether it is certified, and where the bounces end.
TEST(CertificateText, SaysWhatHappenedAndHowNearEachLimitIs) {
    Session session = test::session("ball_on_sine");
    session.settle();
    const CertificateText text = certificate_text(session, 9);
    EXPECT_EQ(text.title, "Zeno 1");
    EXPECT_EQ(text.verdict, "CERTIFIED");
    EXPECT_EQ(text.sentence,
              "It would bounce infinitely often; we stopped computing bounces after the 9th, 1.6 ms before.");
    ASSERT_EQ(text.rows.size(), 3U);
    const Certificate::Decision& decision = *session.trajectory().events[9].certificate->decision;
    int nearest = 0;
    for (const auto& [row, inequality] : {std::pair{&text.rows[0], &decision.time},
                                          {&text.rows[1], &decision.position},
                                          {&text.rows[2], &decision.velocity}}) {
        EXPECT_DOUBLE_EQ(row->share, inequality->ratio());
        EXPECT_EQ(row->is_nearest, inequality->name == decision.closest().name);
        nearest += row->is_nearest ? 1 : 0;
    }
    EXPECT_EQ(nearest, 1);
    EXPECT_EQ(text.rows[0].error, "time from the cut on");
    EXPECT_EQ(text.rows[0].allowed, "1e\u22126 s");
    EXPECT_EQ(text.rows[2].allowed, "1e\u22126 m/s");
    EXPECT_EQ(text.not_covered.rfind("Not covered: integration error before the cut, about ", 0), 0U)
        << text.not_covered;
    session.apply(command::SetConditions{Conditions::paper});
    const auto& events = session.trajectory().events;
    const auto zeno =
        std::find_if(events.begin(), events.end(), [](const Event& event) { return is_zeno_point(event); });
    ASSERT_NE(zeno, events.end());
    const CertificateText paper = certificate_text(session, static_cast<std::size_t>(zeno - events.begin()));
    ASSERT_EQ(paper.rows.size(), 3U);
    EXPECT_EQ(paper.rows[0].error, "gap speed, for the time from the cut on");
    session.apply(command::SetConditions{Conditions::sharp});
    session.apply(parse_command("prove"));
    session.settle();
    EXPECT_EQ(certificate_text(session, 9).verdict, "PROVED");
    EXPECT_EQ(certificate_text(session, 9).not_covered.rfind("Covered by the proof", 0), 0U);
}

TEST(CertificateText, CountsAndMeasuresInWords) {
    EXPECT_EQ(ordinal(1) + ordinal(2) + ordinal(3) + ordinal(4), "1st2nd3rd4th");
    EXPECT_EQ(ordinal(11) + ordinal(12) + ordinal(21) + ordinal(112), "11th12th21st112th");
    EXPECT_EQ(duration_text(0.00162), "1.6 ms");
    EXPECT_EQ(duration_text(3.0e-7), "300 ns");
    EXPECT_EQ(duration_text(2.0), "2 s");
}

// A click on the Zeno row opens the card, a click on its cross closes it.
TEST(CertificatePanel, OpensWithAClickAndCloses) {
    Session session = test::session("ball_on_sine");
    PanelState state = test::panels();
    Offscreen surface(test::surface());
    const auto frame = [&](const Input& input = {}) {
        surface.step(
            [&] {
                for (const Command& command : explorer(session, state)) session.apply(command);
            },
            input);
    };
    const auto click = [&](const std::string& place) {
        ASSERT_TRUE(state.places.contains(place)) << place;
        const Rectangle& at = state.places[place];
        Input input;
        input.mouse_x = at.x + 0.5F * at.width;
        input.mouse_y = at.y + 0.5F * at.height;
        frame(input);
        input.left = true;
        frame(input);
        input.left = false;
        frame(input);
    };
    session.apply(command::Seek{2.7252});  // the list follows the current time
    for (int i = 0; i < 3; ++i) frame();
    int zeno = 0;
    const auto& events = session.trajectory().events;
    while (events[static_cast<std::size_t>(zeno)].kind != Event::Kind::zeno) ++zeno;
    click("event " + std::to_string(zeno + 1));
    EXPECT_EQ(session.selected(), zeno + 1);
    for (int i = 0; i < 2; ++i) frame();
    click("close card");
    EXPECT_EQ(session.selected(), 0);
}

}  // namespace
}  // namespace achilles
