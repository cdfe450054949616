// The strip of results, the event list, the accuracy section, and the configuration plane.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/hands.hpp"
#include "core/systems.hpp"
#include "figure/axes.hpp"
#include "number/angle.hpp"
#include "panels/widgets.hpp"
#include "session/results_text.hpp"

namespace achilles {
namespace {

using test::Hands;

// Every Zeno point and release can be clicked, and its text states the certified accuracy.
TEST(Results, TellEveryTimeAndHowWellItIsKnown) {
    Hands hands("ball_on_sine");
    const auto& events = hands.session.trajectory().events;
    for (std::size_t i = 0; i < events.size(); ++i)
        EXPECT_EQ(hands.state.places.contains("result " + std::to_string(i + 1)), events[i].kind != Event::Kind::impact)
            << i;
    for (const char* system : {"ball_on_sine", "double_pendulum", "cart_pendulum", "ball_on_floor"}) {
        const Session session = test::session(system);
        const auto& all = session.trajectory().events;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Event& event = all[i];
            if (event.kind != Event::Kind::zeno) continue;
            const EventTime time = event_time(session.trajectory(), i);
            const std::string text = time.text();
            ASSERT_FALSE(time.bound.empty()) << text;
            const double value = std::strtod(time.digits.c_str(), nullptr),
                         off = std::strtod(time.bound.c_str(), nullptr);
            EXPECT_LE(value - off, event.certificate->zeno_low) << text;
            EXPECT_GE(value + off, event.certificate->zeno_high) << text;
            const double integration = integration_error_of_time(session.trajectory(), i);
            EXPECT_LT(off,
                      2.0 * (event.certificate->zeno_high - event.certificate->zeno_low) + 2.0 * integration + 1e-12)
                << text;
            EXPECT_GE(off, integration) << text;
        }
    }
}

// At a loose tolerance the integration error far exceeds the width of the interval: further digits are not shown.
TEST(Results, ShowNoDigitsThatTheIntegrationMayChange) {
    Session session = test::session("ball_on_sine");
    session.apply(parse_command("tolerance 1e-4"));
    const auto& events = session.trajectory().events;
    for (std::size_t i = 0; i < events.size(); ++i) {
        if (events[i].kind != Event::Kind::zeno) continue;
        const EventTime time = event_time(session.trajectory(), i);
        EXPECT_LT(time.digits.size(), 10U) << time.text();
        EXPECT_GT(std::strtod(time.bound.c_str(), nullptr), 1e-5) << time.text();
    }
}

// Every system of the gallery: the digits have a bound that contains the certified interval, and no digit is finer than
// it.
TEST(Results, DigitsOfEveryZenoTimeLieInTheirBound) {
    int found = 0;
    for (const std::string& name : test::all_systems()) {
        const Session session = test::session(name);
        const Trajectory& run = session.trajectory();
        for (std::size_t i = 0; i < run.events.size(); ++i) {
            const Event& event = run.events[i];
            if (!is_zeno_point(event) || !event.certificate || !event.certificate->certified) continue;
            const EventTime time = event_time(session, i);
            if (session.precision().is_beyond(event.t) && time.digits == "?") continue;
            if (time.bound.empty()) continue;  // an interval of one number
            ++found;
            const double value = std::strtod(time.digits.c_str(), nullptr),
                         bound = std::strtod(time.bound.c_str(), nullptr);
            EXPECT_LE(value - bound, event.certificate->zeno_low) << name << " " << time.text();
            EXPECT_GE(value + bound, event.certificate->zeno_high) << name << " " << time.text();
            const std::size_t point = time.digits.find('.');
            const auto decimals = point == std::string::npos ? 0 : static_cast<int>(time.digits.size() - point) - 1;
            EXPECT_LE(std::abs(value - event.t), std::max(bound, 0.5 * std::pow(10.0, -decimals))) << time.text();
            EXPECT_GE(std::pow(10.0, 1 - decimals), 0.5 * bound) << name << " too few digits: " << time.text();
            EXPECT_LE(std::pow(10.0, -decimals), 2.0 * bound) << name << " too many digits: " << time.text();
        }
    }
    EXPECT_GT(found, 60);
}

// List, strip, card, tooltip and lens show one time with one bound; after a proof the proved ones.
TEST(Results, HaveOneTimeEverywhere) {
    Hands hands("ball_on_sine", test::surface(1600, 1000));
    constexpr std::size_t zeno = 9;
    ASSERT_TRUE(is_zeno_point(hands.session.trajectory().events[zeno]));
    const auto check = [&](const std::string& where, bool is_in_strip_alone = false) {
        std::string time = event_time(hands.session, zeno).text();
        std::erase(time, ' ');
        const EventTime shown = event_time(hands.session, zeno);
        const std::string digits = shown.digits, letters = hands.letters();
        if (is_in_strip_alone && shown.is_proved) time = shown.short_text;
        EXPECT_NE(letters.find(time), std::string::npos) << where << ": " << letters;
        for (std::size_t at = letters.find("2.72514"); at != std::string::npos; at = letters.find("2.72514", at + 1)) {
            EXPECT_EQ(letters.substr(at, digits.size()), digits) << where;
            EXPECT_FALSE(std::isdigit(static_cast<unsigned char>(letters[at + digits.size()]))) << where;
        }
        EXPECT_EQ(letters.find("[2.72"), std::string::npos) << where;
        EXPECT_EQ(letters.find("certifiedto7"), std::string::npos) << where;
    };
    for (const bool is_proved : {false, true}) {
        if (is_proved) hands.session.apply(parse_command("prove"));
        hands.session.settle();
        hands.rest(2);
        const std::string when = is_proved ? "proved, " : "";
        check(when + "list", true);
        hands.point("result 10");
        check(when + "tooltip");
        hands.session.apply(command::Select{static_cast<int>(zeno) + 1});
        hands.rest(2);
        check(when + "card");
        EXPECT_EQ(hands.says("PROVED"), is_proved);
        hands.session.apply(command::Show{"lens", true});
        hands.rest(2);
        check(when + "lens");
        hands.session.apply(command::Show{"lens", false});
        hands.session.apply(command::Select{0});
    }
    const EnclosedEvent* const enclosed = hands.session.enclosed(zeno);
    ASSERT_NE(enclosed, nullptr);
    const EventTime time = event_time(hands.session, zeno);
    const double value = std::strtod(time.digits.c_str(), nullptr), bound = std::strtod(time.bound.c_str(), nullptr);
    EXPECT_LE(value - bound, enclosed->t.lo());
    EXPECT_GE(value + bound, enclosed->t.hi());
    EXPECT_LT(bound, 1e-8);
}

TEST(Results, SelectAndShowTheProof) {
    Hands hands("ball_on_sine");
    const auto& events = hands.session.trajectory().events;
    std::size_t zeno = events.size();
    while (events[--zeno].kind != Event::Kind::zeno) {
    }
    const std::string place = "result " + std::to_string(zeno + 1);
    hands.point(place);
    EXPECT_GT(hands.tooltip().height, 30.0F) << "the proof, in several lines";
    EXPECT_TRUE(hands.all.empty());
    hands.click(place);
    EXPECT_EQ(hands.all, std::vector<Command>{command::Select{static_cast<int>(zeno) + 1}});
    EXPECT_EQ(hands.session.time(), events[zeno].t);
    hands.click(place);
    EXPECT_EQ(hands.session.selected(), 0);
}

// With restitution 0 the impact is plastic: no certificate, and no impact sequence to show.
TEST(Results, PlasticImpactsHaveTheirNameAndNoLens) {
    for (const bool is_plastic : {false, true}) {
        Hands hands("ball_on_floor");
        if (is_plastic) hands.session.apply(command::Set{"e", {0.0, {}}});
        hands.rest(3);
        const auto& events = hands.session.trajectory().events;
        std::size_t rest = 0;
        while (events[rest].kind != Event::Kind::zeno) ++rest;
        ASSERT_EQ(is_plastic_landing(events[rest]), is_plastic);
        hands.click("result " + std::to_string(rest + 1));
        hands.rest(2);
        EXPECT_EQ(hands.state.places.contains("open lens"), !is_plastic);
        const std::string first = certificate_lines(events[rest]).front();
        EXPECT_EQ(first == "stays in contact without a bounce", is_plastic) << first;
    }
}

// A run that ends early without a Zeno point states the reason.
TEST(Results, TellHowARunWithoutAnyEnded) {
    Hands hands("ball_on_floor");
    EXPECT_FALSE(hands.says("left the domain at"));
    std::string text = hands.session.document().text;
    const std::string gap = "\"y - r\"";
    ASSERT_NE(text.find(gap), std::string::npos);
    text.replace(text.find(gap), gap.size(), "\"(y - r)^3\"");
    hands.session.apply(command::SetText{text});
    ASSERT_TRUE(hands.session.document().problems.empty());
    hands.rest(3);
    EXPECT_TRUE(hands.says("left the domain at"));
    EXPECT_FALSE(hands.says("no Zeno point until"));
}

// The list, the status line and the tooltip use the sentence of core.
TEST(EventList, SaysASentenceAnEvent) {
    Hands hands("ball_on_sine", test::surface(1600, 1000));
    const auto& events = hands.session.trajectory().events;
    std::size_t zeno = 0;
    while (events[zeno].kind != Event::Kind::zeno) ++zeno;
    hands.session.apply(command::Seek{events[zeno].t});
    hands.rest(2);
    const std::string text = typeset_sentence(hands.session.sentences().of(zeno));
    EXPECT_TRUE(hands.says(text));
    EXPECT_TRUE(hands.state.places.contains("event start"));
    hands.session.apply(command::Select{static_cast<int>(zeno) + 1});
    hands.rest(2);
    EXPECT_TRUE(hands.says("event " + std::to_string(zeno + 1) + ": " + text)) << "in the status line";
    hands.session.apply(command::Select{0});
    hands.session.apply(command::Seek{20.0});
    hands.rest(2);
    hands.click("event start");
    EXPECT_EQ(hands.session.time(), 0.0);
}

TEST(EventList, FoldsImpactsUntilAClickOpensThem) {
    Hands hands("ball_on_sine");
    EXPECT_FALSE(hands.state.places.contains("event 1"));
    ASSERT_TRUE(hands.state.places.contains("impacts 1"));
    EXPECT_TRUE(hands.state.places.contains("event 10"));
    hands.click("impacts 1");
    EXPECT_TRUE(hands.state.places.contains("event 1"));
    EXPECT_TRUE(hands.all.empty()) << "that is no matter of the session";
    hands.click("impacts 1");
    hands.state.places.erase("event 1");
    hands.rest(2);
    EXPECT_FALSE(hands.state.places.contains("event 1"));
    // An impact selected elsewhere is scrolled into view.
    hands.session.apply(command::Select{3});
    hands.rest(3);
    EXPECT_TRUE(hands.state.places.contains("event 3"));
    hands.session.apply(command::Select{0});
    hands.click("impacts", 0.1);
    hands.rest(2);
    EXPECT_TRUE(hands.state.places.contains("event 1"));
}

// A right click on a title hides columns and shows them again.
TEST(EventList, HidesAColumn) {
    Hands hands("ball_on_sine", test::surface(1600, 1000));
    hands.session.apply(command::Seek{20.0});
    hands.rest(2);
    ASSERT_TRUE(hands.says("energy lost"));
    const Rectangle first = hands.state.places.at("event start");
    const auto use_menu = [&] {
        hands.hand.mouse_x = first.x + 0.98 * first.width, hands.hand.mouse_y = first.y - 0.5 * first.height;
        hands.rest(2);
        hands.hand.right = true;
        hands.rest(2);
        hands.hand.right = false;
        hands.rest(2);
        hands.click("column energy lost");
    };
    use_menu();
    EXPECT_FALSE(hands.says("energy lost"));
    EXPECT_EQ(hands.session.time(), 20.0) << "no row was clicked";
    hands.session.apply(command::Select{10});
    hands.session.apply(command::Select{0});
    hands.rest(2);
    EXPECT_FALSE(hands.says("energy lost"));
    use_menu();
    EXPECT_TRUE(hands.says("energy lost"));
}

// The energies of a walker without masses have a long unit.
TEST(EventList, HasUnitsAsTheyAreWritten) {
    Hands hands("simplest_walker");
    EXPECT_TRUE(hands.says("rad2/s2 lost")) << "exponents are raised digits";
    EXPECT_TRUE(hands.says("lost (rad")) << "the whole title of the column";
    EXPECT_FALSE(hands.says("^2"));
}

TEST(EventList, ShowsEveryImpactWhereThereIsNothingElse) {
    Hands hands("ball_on_floor");
    EXPECT_FALSE(hands.state.places.contains("event 1"));
    hands.session.apply(command::Set{"e", 0.999});
    hands.rest(3);
    EXPECT_TRUE(hands.state.places.contains("event 1"));
}

TEST(EventList, IsCopiedAsATable) {
    Hands hands("double_pendulum");
    hands.click("copy events");
    std::string text;
    hands.surface.step([&] {
        text = ImGui::GetClipboardText();
        explorer(hands.session, hands.state);
    });
    const auto& events = hands.session.trajectory().events;
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
        lines.push_back(text.substr(at, text.find('\n', at) - at));
    ASSERT_EQ(lines.size(), events.size() + 1);
    const auto tabs = [](const std::string& line) { return std::count(line.begin(), line.end(), '\t'); };
    EXPECT_EQ(lines[0], "#\tevent\tt\timpact speed\ttheta1\ttheta2\ttheta1'\ttheta2'\tenergy lost\tsentence");
    for (std::size_t i = 0; i < events.size(); ++i) {
        EXPECT_EQ(tabs(lines[i + 1]), tabs(lines[0]));
        EXPECT_NE(lines[i + 1].find("\t" + fmt::format("{}", events[i].t) + "\t"), std::string::npos) << "every digit";
    }
}

constexpr const char* gaps = "../../tests/reference/gaps/";

// Every event of every contact: in the list; in the strip if it changes the held contacts; with its card.
TEST(SeveralContacts, AreNamedWhereverEventsAre) {
    for (const char* system : {"driven_damped_pendulum", "travelling_wave", "vibrating_table", "bowl_and_post",
                               "pendulum_two_stops", "ball_in_box"}) {
        SCOPED_TRACE(system);
        Hands hands(std::string(gaps) + system);
        const auto& events = hands.session.trajectory().events;
        for (std::size_t i = 0; i < events.size(); ++i) {
            const std::string number = std::to_string(i + 1);
            hands.session.apply(command::Select{static_cast<int>(i) + 1});
            hands.rest(1);
            EXPECT_TRUE(hands.state.places.contains("event " + number)) << i;
            EXPECT_TRUE(hands.state.places.contains("close card")) << i;
            EXPECT_EQ(hands.state.places.contains("result " + number),
                      events[i].kind != Event::Kind::impact || !events[i].opened.empty())
                << i;
        }
    }
}

// A ball hits the first of two touching balls without forces: the message must not say that a surface falls away.
TEST(SeveralContacts, ThatTakePartInAnImpactAreSaidTo) {
    Hands hands("newtons_cradle", test::surface(1600, 1600));
    hands.session.apply(command::SetText{
        "title = \"balls\"\n[[coordinate]]\nname = \"a\"\nstart = -1\nrate = 1\nunit = \"m\"\n[[coordinate]]\nname = "
        "\"b\"\n"
        "unit = \"m\"\n[[coordinate]]\nname = \"c\"\nunit = \"m\"\n[lagrangian]\nkinetic = \"(a'^2 + b'^2 + c'^2)/2\"\n"
        "potential = \"0\"\n[[constraint]]\nname = \"ab\"\ngap = \"b - a\"\nrestitution = 0.5\n"
        "[[constraint]]\nname = \"bc\"\ngap = \"c - b\"\nrestitution = 0.5\n[run]\nend_time = 1.5\n"});
    ASSERT_TRUE(hands.session.document().problems.empty());
    hands.session.apply(command::Select{1});
    hands.rest(3);
    EXPECT_FALSE(hands.says("falls away here"));
    EXPECT_TRUE(hands.says("take part in this impact"));
    EXPECT_TRUE(hands.says("m/s")) << "the gap speed has a unit";
}

TEST(SeveralContacts, AreCopiedWithTheList) {
    Hands hands(std::string(gaps) + "pendulum_two_stops");
    hands.click("copy events");
    std::string text;
    hands.surface.step([&] {
        text = ImGui::GetClipboardText();
        explorer(hands.session, hands.state);
    });
    EXPECT_EQ(text.substr(0, text.find('\n')),
              "#\tevent\tcontacts\topened\theld\tt\timpact speed\tth1\tth2\tth1'\tth2'\tenergy lost\tsentence");
    EXPECT_NE(text.find("\timpact\twall\tknee\t\t6.6486360"), std::string::npos) << text;
    EXPECT_NE(text.find("\tZeno point\tknee\t\tknee\t10.47660"), std::string::npos) << text;
}

// A character missing in the font appears as a question mark.
TEST(Panels, WriteNoSignThatTheFontLacks) {
    Hands hands("ball_on_floor");
    int signs = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ACHILLES_SOURCE_DIR "/app/panels")) {
        std::ifstream file(entry.path());
        const std::string text(std::istreambuf_iterator<char>(file), {});
        for (std::size_t at = 0; (at = text.find("\\u", at)) != std::string::npos; at += 2) {
            const auto code = static_cast<ImWchar>(std::stoul(text.substr(at + 2, 4), nullptr, 16));
            hands.surface.step([&] {
                EXPECT_NE(ImGui::GetFont()->FindGlyphNoFallback(code), nullptr)
                    << entry.path().filename() << " " << text.substr(at, 6);
                explorer(hands.session, hands.state);
            });
            ++signs;
        }
    }
    EXPECT_GT(signs, 20);
}

TEST(Accuracy, IsOneLineUntilItIsOpened) {
    Hands hands("ball_on_sine");
    for (const char* place : {"eps", "tolerance", "conditions paper"}) EXPECT_FALSE(hands.state.places.contains(place));
    EXPECT_TRUE(hands.state.places.contains("end"));
    hands.click("accuracy");
    for (const char* place : {"eps", "tolerance", "conditions paper"}) EXPECT_TRUE(hands.state.places.contains(place));
    EXPECT_EQ(hands.all, std::vector<Command>{(command::Show{"accuracy", true})});
}

// In a small window the verdict and the bounds of the certificate are inside the card, which scrolls up and down alone.
TEST(Card, ShowsTheBoundsInASmallWindow) {
    for (const char* system : {"ball_on_sine", "double_pendulum"}) {
        Hands hands(system, test::surface(1024, 700));
        const auto& events = hands.session.trajectory().events;
        std::size_t zeno = 0;
        while (events[zeno].kind != Event::Kind::zeno) ++zeno;
        hands.session.apply(command::Select{static_cast<int>(zeno) + 1});
        hands.rest(3);
        EXPECT_TRUE(hands.says("CERTIFIED") && hands.says("allowed")) << system;
        float beside = -1.0F;
        hands.surface.step([&] {
            explorer(hands.session, hands.state);
            for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
                if (std::string(window->Name).find("/card_") != std::string::npos) beside = window->ScrollMax.x;
        });
        EXPECT_EQ(beside, 0.0F) << system;
    }
}

TEST(Plane, StandsInPlaceOfADrawingAndOfAnyMechanism) {
    for (const char* system : {"double_pendulum", "ball_on_floor", "falling_rod", "ball_on_sine"}) {
        Hands hands(system);
        EXPECT_FALSE(hands.state.places.contains("plane"));
        hands.click("show plane");
        hands.rest(2);
        EXPECT_TRUE(hands.state.places.contains("plane")) << system;
        EXPECT_TRUE(hands.session.scene().shows("plane"));
    }
    // A text without a drawing shows the plane from the start.
    Hands hands("double_pendulum");
    std::string text = hands.session.document().text;
    text.erase(text.find("drawing = ["), text.find("view = [") - text.find("drawing = ["));
    hands.session.apply(command::SetText{text});
    ASSERT_TRUE(hands.session.document().problems.empty());
    hands.rest(2);
    EXPECT_TRUE(hands.state.places.contains("plane"));
}

TEST(Plane, HasTheStartUnderTheHandAtEveryStep) {
    for (const char* system : {"double_pendulum", "ball_on_sine", "ball_on_floor"}) {
        Hands hands(system);
        hands.session.apply(command::Show{"plane", true});
        hands.rest(3);
        hands.point("start");
        hands.hand.left = true;
        hands.rest(1);
        for (int i = 0; i < 8; ++i) {
            hands.hand.mouse_x -= 5.0;
            hands.hand.mouse_y += 2.0;
            hands.rest(2);
            ASSERT_EQ(hands.session.error(), "") << system;
            const Point start = hands.middle("start");
            EXPECT_LT(std::hypot(start.x - hands.hand.mouse_x, start.y - hands.hand.mouse_y), 1.0) << system;
        }
        hands.hand.left = false;
        hands.rest(2);
        EXPECT_TRUE(hands.session.can_undo());
        hands.hand.mouse_y = -1e6;
        hands.rest(1);
        hands.press_with_control('Z');
        EXPECT_FALSE(hands.session.can_undo()) << "one change";
    }
}

TEST(Plane, SelectsTheEventThatIsClicked) {
    Hands hands("double_pendulum");
    hands.session.apply(command::Show{"plane", true});
    hands.rest(3);
    const auto& events = hands.session.trajectory().events;
    for (std::size_t wanted = 0; wanted < events.size(); ++wanted) {
        if (events[wanted].kind != Event::Kind::release) continue;
        const PanelMap map(*hands.state.plane.panel, hands.state.places.at("plane"));
        hands.hand.mouse_x = map.x(degrees(events[wanted].q[0])) + 3.0;
        hands.hand.mouse_y = map.y(degrees(events[wanted].q[1])) - 3.0;
        hands.hand.left = true;
        hands.rest(2);
        hands.hand.left = false;
        hands.rest(2);
        ASSERT_GT(hands.session.selected(), 0);
        const auto found = static_cast<std::size_t>(hands.session.selected() - 1);
        EXPECT_EQ(events[found].kind, Event::Kind::release);
        EXPECT_EQ(hands.session.time(), events[found].t);
        EXPECT_EQ(*hands.session.value("theta1"), hands.session.file_run().q[0]) << "the start stays";
    }
}

TEST(Plane, ShadesWhereTheGapIsOpen) {
    const ScalarField field({{}, -2.0, 2.0, -1.0, 3.0}, [](const Point& p) { return p.y - p.x * p.x; });
    double area = 0.0;
    for (const std::vector<Point>& part : field.not_negative())
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Point &a = part[i], &b = part[(i + 1) % part.size()];
            area += 0.5 * (a.x * b.y - b.x * a.y);
            EXPECT_GE(a.y - a.x * a.x, -1e-3);
        }
    // Area between the parabola and y = 3: 4 sqrt(3).
    EXPECT_NEAR(area, 4.0 * std::sqrt(3.0), 5e-3);
    for (const Point& p : field.zero_line()) {
        if (!std::isfinite(p.x)) continue;
        EXPECT_NEAR(p.y, p.x * p.x, 1e-3);
    }
}

}  // namespace
}  // namespace achilles
