// Tours: journals of the assets, which end in the same state and the same pixels at any pace.

#include <gtest/gtest.h>

#include <filesystem>

#include "app/hands.hpp"
#include "app/program.hpp"
#include "journal/journal.hpp"

namespace achilles {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names() {
    std::vector<std::string> result;
    for (const auto& entry : fs::directory_iterator(ACHILLES_SOURCE_DIR "/assets/journals"))
        result.push_back(entry.path().stem().string());
    return result;
}

std::vector<Command> journal(const std::string& name) {
    return read_journal(ACHILLES_SOURCE_DIR "/assets/journals/" + name + ".journal");
}

class Tours : public testing::TestWithParam<std::string> {};

// Their final states are golden files: tests/golden.
TEST_P(Tours, DoNothingThatIsRefused) {
    Session session = test::session("ball_on_floor");
    for (const Command& command : journal(GetParam())) {
        session.apply(command);
        EXPECT_EQ(session.error(), "") << to_text(command);
    }
}

// A tour works from any session state.
TEST_P(Tours, BeginWhereverASessionStands) {
    Session fresh = test::session("ball_on_floor"), used = test::session("ball_on_sine");
    for (const char* line :
         {"pin", "show lens", "speed 7", "loop on", "select 3", "grid 1 1", "set e 0.2", "show editor"})
        used.apply(parse_command(line));
    for (Session* session : {&fresh, &used})
        for (const Command& command : journal(GetParam())) session->apply(command);
    EXPECT_EQ(to_text(used), to_text(fresh));
}

TEST_P(Tours, EndTheSameAtAnyPace) {
    Session at_once = test::session("ball_on_floor"), slowly = test::session("ball_on_floor");
    for (const Command& command : journal(GetParam())) at_once.apply(command);
    Tour tour(journal(GetParam()));
    int frames = 0;
    for (; tour.runs() && frames < 100000; ++frames)
        for (const Command& command : tour.advance(0.07)) slowly.apply(command);
    EXPECT_GT(frames, 300);  // at least 20 seconds, to be readable
    EXPECT_EQ(to_text(slowly), to_text(at_once));
}

TEST_P(Tours, DrawTheSamePixelsTwice) {
    const SurfaceOptions options = test::surface(900, 640);
    test::Hands a("ball_on_floor", options), b("ball_on_floor", options);
    for (test::Hands* hands : {&a, &b})
        for (const Command& command : journal(GetParam())) hands->session.apply(command);
    EXPECT_EQ(a.picture(), b.picture());
}

// The mechanism does not move between captions.
TEST_P(Tours, SayWhatFits) {
    test::Hands hands("ball_on_floor");
    hands.state.on_tour = true;
    float top = 0.0F;
    int sentences = 0;
    for (const Command& command : journal(GetParam())) {
        hands.session.apply(command);
        if (!std::holds_alternative<command::Say>(command)) continue;
        hands.rest(1);
        const float y = hands.state.places.at("mechanism").y;
        if (sentences++ == 0) top = y;
        EXPECT_EQ(y, top) << to_text(command);
    }
    EXPECT_GE(sentences, 5);
}

INSTANTIATE_TEST_SUITE_P(Journals, Tours, testing::ValuesIn(names()));

TEST(Tour, ThereAreFour) { EXPECT_GE(names().size(), 4U); }

TEST(Tour, WaitsAddUp) {
    Tour tour({command::Play{}, command::Wait{1.0}, command::Pause{}, command::Wait{0.25}, command::Seek{1.0}});
    EXPECT_EQ(tour.advance(0.0), (std::vector<Command>{command::Play{}}));
    EXPECT_EQ(tour.advance(0.75), (std::vector<Command>{command::Wait{0.75}}));
    // The rest of a frame's time counts for the next wait.
    EXPECT_EQ(tour.advance(0.375), (std::vector<Command>{command::Wait{0.25}, command::Pause{}, command::Wait{0.125}}));
    EXPECT_EQ(tour.next(), (std::vector<Command>{command::Wait{0.125}}));
    EXPECT_EQ(tour.advance(0.0), (std::vector<Command>{command::Seek{1.0}}));
    EXPECT_FALSE(tour.runs());
    EXPECT_TRUE(tour.next().empty());
}

std::vector<Command> lines(std::initializer_list<const char*> texts) {
    std::vector<Command> commands;
    for (const char* text : texts) commands.push_back(parse_command(text));
    return commands;
}

TEST(Tour, GoesBackASentence) {
    const auto all = lines({"unpin", "open ball_on_sine", "say \"1\"", "wait 1", "set e 0.4", "say \"2\"", "wait 2",
                            "seek 1", "say \"3\"", "wait 3", "say \"\""});
    Tour tour(all);
    tour.advance(0.5);
    EXPECT_EQ(tour.captions_shown(), 1U);
    EXPECT_EQ(tour.sentences(), 3U);
    EXPECT_TRUE(tour.back().empty()) << "no caption comes before the first";
    tour.advance(3.0);  // half a second into the third
    EXPECT_EQ(tour.captions_shown(), 3U);
    EXPECT_EQ(tour.back(), lines({"unpin", "open ball_on_sine", "say \"1\"", "wait 1", "set e 0.4"}));
    EXPECT_EQ(tour.advance(0.0), lines({"say \"2\""}));
    EXPECT_EQ(tour.captions_shown(), 2U);
    EXPECT_EQ(tour.advance(1.5), lines({"wait 1.5"}));
    EXPECT_EQ(tour.advance(0.5), lines({"wait 0.5", "seek 1", "say \"3\""}));
    EXPECT_EQ(tour.advance(3.5), lines({"wait 3", "say \"\""})) << "the wait is whole again";
    EXPECT_FALSE(tour.runs());
    tour.begin(all);
    EXPECT_EQ(tour.sentences(), 3U) << "what has ended is forgotten";
}

// File output is not repeated, and the commands of a replayed journal appear once.
TEST(Tour, GoesBackWithoutWritingAgain) {
    Tour tour(lines({"say \"1\"", "replay inner", "say \"2\"", "wait 1", "say \"3\"", "wait 1"}));
    tour.advance(0.0);
    tour.begin(lines({"export a.svg", "set e 0.3"}));
    tour.advance(1.5);
    EXPECT_EQ(tour.captions_shown(), 3U);
    EXPECT_EQ(tour.back(), lines({"say \"1\"", "set e 0.3"}));
}

// Going back from any caption restores the session at the previous one.
TEST_P(Tours, LeadBackToWhatWas) {
    Session forward = test::session("ball_on_floor");
    Tour tour(journal(GetParam()));
    std::vector<std::string> states;
    const auto until_the_next = [&] {
        const std::size_t captions_shown = tour.captions_shown();
        while (tour.runs() && tour.captions_shown() == captions_shown) {
            for (const Command& command : tour.next()) forward.apply(command);
            for (const Command& command : tour.advance(0.0)) forward.apply(command);
        }
    };
    while (tour.runs() && tour.captions_shown() < tour.sentences()) {
        until_the_next();
        states.push_back(to_text(forward));
    }
    ASSERT_GE(states.size(), 5U);
    for (std::size_t i = states.size() - 1; i-- > states.size() - 4;) {
        for (const Command& command : tour.back()) forward.apply(command);
        for (const Command& command : tour.advance(0.0)) forward.apply(command);
        EXPECT_EQ(to_text(forward), states[i]) << i;
    }
}

TEST(Tour, HasButtonsAndSaysHowFarItIs) {
    test::Hands hands("ball_on_sine");
    hands.session.apply(command::Say{"A sentence."});
    hands.state.on_tour = true;
    hands.state.tour_captions_shown = 4, hands.state.tour_captions = 12;
    hands.rest(2);
    EXPECT_TRUE(hands.says("4/12"));
    hands.click("tour back");
    EXPECT_EQ(hands.state.tour_action, PanelState::TourAction::back);
    hands.state.tour_action = PanelState::TourAction::none;
    hands.press(key::backspace);
    EXPECT_EQ(hands.state.tour_action, PanelState::TourAction::back);
    hands.state.tour_action = PanelState::TourAction::none;
    hands.state.tour_captions_shown = 1;
    hands.click("tour back");
    EXPECT_EQ(hands.state.tour_action, PanelState::TourAction::none) << "no caption comes before the first";
}

// A panel is framed until the next caption.
TEST(Tour, FramesWhatItIsAbout) {
    test::Hands hands("ball_on_sine");
    const Image before = hands.picture();
    for (const std::string& panel : command::highlighted_panels) {
        hands.session.apply(command::Highlight{panel});
        EXPECT_EQ(hands.session.error(), "");
        const bool is_hidden = panel == "none" || panel == "energy" || panel == "sweep";
        EXPECT_EQ(hands.picture() == before, is_hidden) << panel << ", which is not shown";
    }
    hands.session.apply(parse_command("highlight plots"));
    EXPECT_EQ(hands.session.scene().highlight(), "plots");
    hands.session.apply(command::Say{""});
    EXPECT_EQ(hands.session.scene().highlight(), "");
    hands.session.apply(parse_command("highlight none"));
    EXPECT_THROW(parse_command("highlight plot"), InputError);
}

TEST(Tour, AJournalInAJournalComesFirst) {
    Tour tour({command::Replay{"a"}, command::Seek{1.0}});
    EXPECT_EQ(tour.advance(1.0), (std::vector<Command>{command::Replay{"a"}}));
    tour.begin({command::Play{}});
    EXPECT_EQ(tour.advance(1.0), (std::vector<Command>{command::Play{}, command::Seek{1.0}}));
}

// An off-screen session replays nested journals, and a journal that replays itself ends.
TEST(Tour, SessionsReplayJournals) {
    SystemSource library = test::library();
    library.journal = [](const std::string& name) {
        return parse_journal(name == "inner"        ? "set e 0.25\n"
                             : name == "outer"      ? "replay inner\nseek 2\n"
                             : name == "wrong"      ? "set nothing 1\nseek 3\n"
                             : name == "unreadable" ? "sett e 1\n"
                                                    : "replay endless\n");
    };
    Session session("ball_on_sine", test::system("ball_on_sine"), library);
    session.apply(command::Replay{"outer"});
    EXPECT_EQ(session.error(), "");
    EXPECT_EQ(session.value("e"), 0.25);
    EXPECT_EQ(session.time(), 2.0);
    session.apply(command::Replay{"wrong"});
    EXPECT_NE(session.error().find("nothing"), std::string::npos);
    EXPECT_EQ(session.time(), 3.0);
    session.apply(command::Replay{"unreadable"});
    EXPECT_NE(session.error().find("sett"), std::string::npos);
    session.apply(command::Replay{"endless"});
    EXPECT_NE(session.error().find("too many journals"), std::string::npos);
}

TEST(HelpMenu, ShowsAPageAboveEverythingUntilEscape) {
    test::Hands hands("ball_on_sine");
    hands.state.manual = {{"data", "The data"}, {"system", "The system file"}};
    hands.state.manual_page = [](const std::string& topic) { return "# A page about " + topic; };
    hands.rest(2);
    hands.click("bar Help");
    hands.click("menu system");
    EXPECT_EQ(hands.state.manual_text, "# A page about system");
    ASSERT_TRUE(hands.state.places.count("Close the manual"));
    const double before = hands.session.run().parameters[0];
    hands.click("set m", 0.9);  // outside the card
    EXPECT_EQ(hands.session.run().parameters[0], before);
    hands.click("Close the manual");
    hands.state.places.clear();
    hands.rest(2);
    EXPECT_FALSE(hands.state.places.count("Close the manual"));
}

TEST(Tour, IsChosenFromTheMenu) {
    test::Hands hands("ball_on_sine");
    hands.state.tours = {{"the_ball", "The paper's ball"}};
    hands.click("bar Tours");
    hands.all.clear();
    hands.click("tour the_ball");
    ASSERT_EQ(hands.all.size(), 1U);
    EXPECT_EQ(hands.all[0], Command(command::Replay{"the_ball"}));
}

}  // namespace
}  // namespace achilles
