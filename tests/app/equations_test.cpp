// The equations panel: content, mouse, and caching of the layout.
#include "session/equations_view.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "app/hands.hpp"
#include "figure/label.hpp"

namespace achilles {
namespace {

using test::Hands;

FormulaFont font() {
    FormulaFont result;
    result.width = [](const std::string& label, float size) {
        return 0.6F * size * static_cast<float>(letters(label).size());
    };
    return result;
}

EquationSheet sheet_of(const std::string& system) {
    const Model model(test::system(system));
    return equation_sheet(model, model.default_run());
}

std::string name_of(const EquationSheet& sheet, const std::string& latex) {
    std::vector<FormulaName> names;
    for (const auto& symbol : sheet.symbols) names.push_back({symbol.latex, typeset_name(symbol.name)});
    return to_text(read_sentence(latex, names));
}

// Every block as a line of text.
std::string text_of(const EquationSheet& sheet) {
    std::string text;
    for (const Block& block : sheet.blocks) {
        text += name_of(sheet, block.kind == Block::Kind::formula || block.kind == Block::Kind::matrix
                                   ? "$" + block.words.latex + "$"
                                   : block.words.latex);
        if (!block.right.empty()) text += " = " + name_of(sheet, "$" + block.right + "$");
        for (const auto& row : block.rows) {
            text += " [";
            for (const std::string& entry : row) text += " " + name_of(sheet, "$" + entry + "$") + " ";
            text += "]";
        }
        text += "\n";
    }
    return text;
}

void expect_lines(const std::string& text, const std::vector<std::string>& lines) {
    std::size_t at = 0;
    for (const std::string& line : lines) {
        const std::size_t found = text.find(line + "\n", at);
        ASSERT_NE(found, std::string::npos) << line << "\nis not in its place in\n" << text;
        at = found;
    }
}

TEST(Equations, OfTheBall) {
    expect_lines(text_of(sheet_of("ball_on_sine")),
                 {"Zeno condition: h\u0308 < 0 where h = h\u0307 = 0", " = x\u0307^2 sin x \u2212 g < 0",
                  "Motion: M q\u0308 + b = 0", "mass matrix", "M [ m  0 ] [ 0  m ]", "b [ 0 ] [ m g ]", "gap",
                  "h = y \u2212 sin x", "rate of the gap", "contact force while held"});
}

TEST(Equations, OfThePendulum) {
    const EquationSheet sheet = sheet_of("double_pendulum");
    expect_lines(text_of(sheet), {"there \u03b8\u2082 = 0, \u03b8\u0307\u2082 = 0",
                                  "h\u0308 = (3 g sin \u03b8\u2081 (m\u2081 (L\u2081 + 2 L\u2082) + m\u2082 L\u2082))/"
                                  "(L\u2081 L\u2082 (4 m\u2081 + 3 m\u2082))",
                                  " = g sin \u03b8\u2081 < 0"});
    ASSERT_EQ(sheet.conditions.size(), 1U);
    EXPECT_TRUE(sheet.conditions[0].depends);
    EXPECT_EQ(sheet.blocks[sheet.conditions[0].last].kind, Block::Kind::heading);
}

TEST(Equations, OfForcesAndTime) {
    const std::string text = text_of(sheet_of("driven_double_pendulum"));
    EXPECT_NE(text.find("Motion: M q\u0308 + b = Q\n"), std::string::npos) << text;
    EXPECT_NE(text.find("forces\nQ ["), std::string::npos) << text;
    EXPECT_NE(text.find(" t"), std::string::npos);
}

TEST(Equations, OfSeveralContacts) {
    const EquationSheet sheet = sheet_of("ball_in_sloped_box");
    const std::string text = text_of(sheet);
    EXPECT_NE(text.find("Zeno condition of "), std::string::npos) << text;
    EXPECT_NE(text.find(" is held: h\u0308 < 0 where h = h\u0307 = 0 for both"), std::string::npos) << text;
    EXPECT_GE(sheet.conditions.size(), 4U);
    for (const SheetCondition& condition : sheet.conditions) EXPECT_FALSE(condition.mode.is_held(condition.contact));
}

// The mechanism as `achilles check` prints it, row by row.
std::string rows_of(const EquationSheet& sheet) {
    std::string text;
    for (const Block& block : sheet.blocks) {
        if (block.kind == Block::Kind::heading) text += block.words.text + "\n";
        for (const auto& row : block.rows)
            text += name_of(sheet, row.front()) + " | " + name_of(sheet, row.back()) + "\n";
    }
    return text;
}

TEST(Equations, BeginWithTheBodies) {
    const Model model(test::system(test::mechanism("kneed_leg")));
    achilles::Run run = model.default_run();
    expect_lines(rows_of(mechanism_sheet(model, run)),
                 {"Bodies", "hip | 20 kg, a point; at [0, z]",
                  "thigh | 7 kg, 0.1029 kg m^2 about its center (uniform rod); at hip, rotated by \u03b8",
                  "shank | 4 kg, 0.06163 kg m^2 about its center (uniform rod); at thigh.end, rotated by "
                  "\u03b8 \u2212 \u03ba",
                  "Springs and dampers", "damper | angle \u03ba: d = 0.3 N m s", "Contacts"});
    run.parameters[1] = 14.0;
    EXPECT_NE(rows_of(mechanism_sheet(model, run)).find("thigh | 14 kg, 0.2058 kg m^2"), std::string::npos);
    // The sides of this box are plain numbers.
    const Model wheel(test::system("bouncing_wheel"));
    expect_lines(rows_of(mechanism_sheet(wheel, wheel.default_run())),
                 {"body | 2 kg, 0.024 kg m^2 about its center (uniform box); at [0, z]"});
    const Model typed(test::system("double_pendulum"));
    EXPECT_TRUE(mechanism_sheet(typed, typed.default_run()).blocks.empty());
}

// Lines do not overlap, stay on the page, and do not extend into the next column.
TEST(Equations, AreSetInColumnsThatFit) {
    for (const std::string system :
         {"ball_on_sine", "double_pendulum", "ball_in_sloped_box", "driven_double_pendulum", "the bodies of a leg"}) {
        const bool is_mechanism = system == "the bodies of a leg";
        const Model leg(test::system(is_mechanism ? test::mechanism("kneed_leg") : "ball_on_sine"));
        const EquationSheet sheet = is_mechanism ? mechanism_sheet(leg, leg.default_run()) : sheet_of(system);
        const bool has_forces = text_of(sheet).find("forces\n") != std::string::npos;
        for (const float width : {420.0F, 800.0F, 1600.0F}) {
            const TypesetSheet page = set_sheet(sheet, 15.0F, font(), width, 200.0F);
            EXPECT_EQ(page.now.size(), sheet.conditions.size());
            EXPECT_LE(page.width, width) << system;
            std::size_t columns = 0;
            for (std::size_t i = 0; i < page.lines.size(); ++i) {
                const TypesetSheet::SheetLine& a = page.lines[i];
                EXPECT_GE(a.y - a.box.ascent, -0.01F) << system;
                EXPECT_LE(a.y + a.box.descent, page.height) << system;
                columns += i == 0 || a.x > page.lines[i - 1].x + 200.0F ? 1 : 0;
                for (std::size_t j = 0; j < i; ++j) {
                    const TypesetSheet::SheetLine& b = page.lines[j];
                    const bool beside = a.x >= b.x + b.box.width || b.x >= a.x + a.box.width;
                    const bool below = a.y - a.box.ascent >= b.y + b.box.descent - 0.01F ||
                                       b.y - b.box.ascent >= a.y + a.box.descent - 0.01F;
                    EXPECT_TRUE(beside || below) << system << ", " << width << ": lines " << i << " and " << j;
                }
            }
            EXPECT_TRUE(width > 420.0F || columns == 1) << system;
            EXPECT_TRUE(width < 1600.0F || sheet.conditions.size() > 1 || has_forces || columns > 1) << system;
        }
    }
}

TEST(Equations, AreACommandAndATab) {
    Hands hands("double_pendulum", test::surface(1280, 1000));
    EXPECT_FALSE(hands.session.scene().shows("equations"));
    hands.click("tab equations");
    EXPECT_TRUE(hands.session.scene().shows("equations"));
    EXPECT_EQ(to_text(hands.all.back()), "show equations");
    EXPECT_TRUE(hands.says("mass matrix"));
    hands.click("tab events");
    EXPECT_FALSE(hands.session.scene().shows("equations"));
    EXPECT_FALSE(hands.says("mass matrix"));
    // If the events are hidden, their tab shows them again.
    hands.session.apply(parse_command("hide events"));
    hands.session.apply(parse_command("show equations"));
    hands.rest(2);
    EXPECT_TRUE(hands.says("mass matrix"));
    hands.click("tab events");
    EXPECT_TRUE(hands.session.scene().shows("events"));
}

TEST(Equations, TellWhatTheConditionIsNow) {
    Hands hands("double_pendulum", test::surface(1280, 1000));
    hands.session.apply(parse_command("show equations"));
    hands.session.apply(parse_command("seek 1"));
    hands.rest(2);
    const double value = std::sin(hands.session.now().state.q[0]);  // g = 1
    ASSERT_GT(value, 0.0);
    EXPECT_TRUE(hands.says("now " + fmt::format("{:.4g}", value) + " \u2265 0"));
    hands.session.apply(parse_command("seek 3"));
    hands.rest(2);
    ASSERT_LT(hands.session.now().state.q[0], 0.0);
    EXPECT_TRUE(hands.says("< 0: bouncing would end at a Zeno point"));
    hands.session.apply(parse_command("set g 2"));
    hands.session.apply(parse_command("seek 1"));
    hands.rest(2);
    EXPECT_TRUE(hands.says("now " + fmt::format("{:.4g}", 2.0 * std::sin(hands.session.now().state.q[0]))));
    hands.session.apply(parse_command("set g 1"));
    hands.session.apply(parse_command("seek 4.5"));
    hands.rest(2);
    EXPECT_TRUE(hands.says("now the contact is held"));
}

TEST(Equations, AndSlidersLightEachOther) {
    Hands hands("double_pendulum", test::surface(1280, 1000));
    hands.session.apply(parse_command("show equations"));
    hands.rest(3);
    hands.point("equation m1");
    hands.rest(1);
    EXPECT_EQ(hands.state.lit, "m1");
    EXPECT_GT(hands.tooltip().height, 0.0F);
    EXPECT_TRUE(hands.says("m1 = 1 kg") || hands.says("m1 = 1\u00a0kg"));
    hands.point("set L2");
    EXPECT_EQ(hands.state.lit, "");
    EXPECT_EQ(hands.state.pointed_slider, "L2");
}

TEST(Equations, AreSimplifiedAndSetOnce) {
    const auto model = std::make_shared<const Model>(test::system("double_pendulum"));
    achilles::Run run = model->default_run();
    EquationsView view;
    const EquationSheet* const sheet = view.sheet(model, run, {});
    ASSERT_NE(sheet, nullptr);
    const TypesetSheet::SheetLine* const line = view.typeset_sheet(15.0F, font(), 800.0F, 300.0F).lines.data();
    run.parameters[0] *= 1.1;
    EXPECT_EQ(view.sheet(model, run, {}), sheet) << "within its range a value changes no sign";
    EXPECT_EQ(view.typeset_sheet(15.0F, font(), 800.0F, 300.0F).lines.data(), line);
    EXPECT_NE(view.typeset_sheet(15.0F, font(), 500.0F, 300.0F).lines.data(), line);
    // For a value outside the range no sign may be assumed that does not hold.
    run.parameters[0] = -1.0;
    const EquationSheet* const other = view.sheet(model, run, {});
    ASSERT_NE(other, nullptr);
    EXPECT_EQ(text_of(*other).find("ranges of m\u2081"), std::string::npos) << text_of(*other);
}

// Work is abandoned if the system or the window changes, without waiting.
TEST(Equations, StopWhenTheyAreToldTo) {
    const Model model(test::system("kneed_leg"));  // seconds
    std::stop_source stop;
    stop.request_stop();
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(equation_sheet(model, model.default_run(), stop.get_token()).conditions.empty());
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

// The bodies are shown above the equations, also while those are being simplified, with the values of the sliders.
TEST(Equations, StandBelowTheBodies) {
    Hands hands(test::mechanism("kneed_leg"), test::surface(1600, 1200));
    hands.state.in_window = true;
    hands.session.apply(parse_command("show equations"));
    hands.rest(2);
    EXPECT_TRUE(derives_equations(hands.state));
    EXPECT_TRUE(hands.says("The equations are being simplified"));
    EXPECT_TRUE(hands.says("thigh7 kg, 0.1029 kg")) << hands.letters();
    EXPECT_TRUE(hands.says("shank.end on floor: "));
    hands.session.apply(parse_command("set mt 14"));
    hands.rest(2);
    EXPECT_TRUE(hands.says("thigh14 kg, 0.2058 kg")) << hands.letters();
    // The letters of the page tell their parameter, as those of the equations do.
    hands.point("equation Ls");
    hands.rest(1);
    EXPECT_EQ(hands.state.lit, "Ls");
}

// A window does not wait for the equations.
TEST(Equations, ComeWhenTheyAreReady) {
    Hands hands("double_pendulum", test::surface(1280, 1000));
    hands.state.in_window = true;
    hands.session.apply(parse_command("show equations"));
    hands.rest(1);
    const auto begin = std::chrono::steady_clock::now();
    while (derives_equations(hands.state) && std::chrono::steady_clock::now() - begin < std::chrono::seconds(20))
        hands.rest(1);
    EXPECT_TRUE(hands.says("mass matrix"));
}

}  // namespace
}  // namespace achilles
