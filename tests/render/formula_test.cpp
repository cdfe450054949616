// Formulas as boxes, numerically, with a font whose letters are all 0.6 of their size wide.
#include "figure/formula.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "figure/label.hpp"

namespace achilles {
namespace {

FormulaFont font() {
    FormulaFont result;
    result.width = [](const std::string& label, float size) {
        float width = 0.0F;
        for (const Letter& letter : letters(label)) width += 0.6F * size * (letter.script == 0 ? 1.0F : script_size);
        return width;
    };
    return result;
}

const std::vector<FormulaName> names{{"m_{1}", "m\u2081"},
                                     {"L", "L"},
                                     {"g", "g"},
                                     {"\\dot{\\theta}_{2}", "\u03b8\u0307\u2082"},
                                     {"\\mathit{mass}", "mass"}};
Formula read(const std::string& latex) { return read_formula(latex, names); }
FormulaBox box(const std::string& latex, float size = 20.0F) { return set(read(latex), size, font()); }

const FormulaBox::Letters& letter(const FormulaBox& box, const std::string& label) {
    for (const FormulaBox::Letters& one : box.letters)
        if (one.label == label) return one;
    throw std::runtime_error("there is no " + label);
}

// Area that the ink of a text may cover.
struct Ink {
    float left, right, top, bottom;
};
Ink ink(const FormulaBox::Letters& one) {
    const FormulaFont f = font();
    return {one.x, one.x + one.width, one.y - f.ascent * one.size, one.y + f.descent * one.size};
}

// Texts do not overlap each other or a line, and stay inside the box. Only a power may be above the subscript of its
// base.
void expect_apart(const FormulaBox& box, const std::string& what) {
    for (std::size_t i = 0; i < box.letters.size(); ++i) {
        const Ink a = ink(box.letters[i]);
        EXPECT_GE(a.left, -0.01F) << what;
        EXPECT_LE(a.right, box.width + 0.01F) << what;
        EXPECT_GE(a.top, -box.ascent - 0.01F) << what;
        EXPECT_LE(a.bottom, box.descent + 0.01F) << what;
        for (std::size_t j = 0; j < i; ++j) {
            const Ink b = ink(box.letters[j]);
            const float across = std::min(a.right, b.right) - std::max(a.left, b.left);
            const float down = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
            const bool is_power = box.letters[i].size < box.letters[j].size && box.letters[i].y < box.letters[j].y;
            EXPECT_TRUE(across <= 0.01F || down <= 0.01F || is_power)
                << what << ": " << box.letters[i].label << " on " << box.letters[j].label;
        }
        for (const FormulaBox::FormulaRule& rule : box.rules)
            EXPECT_TRUE(a.right <= rule.x + 0.01F || a.left >= rule.x + rule.width - 0.01F ||
                        a.bottom <= rule.y + 0.01F || a.top >= rule.y + rule.height - 0.01F)
                << what << ": a rule through " << box.letters[i].label;
    }
}

TEST(Formula, ReadsWhatIsWritten) {
    EXPECT_EQ(to_text(read("\\frac{3 g \\sin \\theta}{L (4 m_{1} + 3)} < 0")),
              "(3 g sin \u03b8)/(L (4 m\u2081 + 3)) < 0");
    EXPECT_EQ(to_text(read("-\\tfrac{1}{2} m_{1} L^{2} \\dot{\\theta}_{2}^{2} \\cos^{2} \\theta")),
              "\u22121/2 m\u2081 L^2 \u03b8\u0307\u2082^2 cos^2 \u03b8");
    EXPECT_EQ(to_text(read("\\sqrt{1 + g^{2}} \\left(\\mathit{mass} - 1\\right)^{3}")),
              "\u221a(1 + g^2) (mass \u2212 1)^3");
    EXPECT_EQ(to_text(read("2 \\cdot 3.5")), "2 \u00b7 3.5");
    EXPECT_EQ(read("m_{1} L").pieces[0].name, 0);
    EXPECT_EQ(read("m_{1} L").pieces[1].name, 1);
    EXPECT_EQ(read("\\log Lx").pieces[1].name, -1) << "a letter of a longer word is no name";
    EXPECT_EQ(to_text(read_sentence("by the ranges of $m_{1}$, $L$: a\\_b", names)),
              "by the ranges of m\u2081, L: a_b");
}

TEST(Formula, ReadsAnyText) {
    for (const char* text : {"", "{", "}", "^", "_", "\\frac", "\\frac{1}", "\\sqrt", "((", "))", "\\", "a^", "\\left",
                             "$", "\\text{", "x_{", "\xff\xfe"})
        EXPECT_GE(box(text).width, 0.0F) << text;
    std::string deep;
    for (int i = 0; i < 20000; ++i) deep += "\\sqrt{";
    EXPECT_LT(box(deep).width, 1e4F);
}

TEST(Formula, ABarIsAsWideAsItsWiderPart) {
    for (const char* text : {"\\frac{g}{m_{1} + L}", "\\frac{m_{1} + L}{g}", "\\frac{g^{2}}{\\sqrt{L}}"}) {
        const FormulaBox whole = box(text);
        const Formula formula = read(text);
        const float inner = whole.letters.front().size;
        const float top = set(formula.pieces[0].parts[0], inner, font()).width;
        const float bottom = set(formula.pieces[0].parts[1], inner, font()).width;
        const auto bar = std::max_element(whole.rules.begin(), whole.rules.end(),
                                          [](const auto& a, const auto& b) { return a.width < b.width; });
        EXPECT_GE(bar->width, std::max(top, bottom)) << text;
        EXPECT_LE(bar->width, std::max(top, bottom) + 0.2F * 20.0F) << text;
        EXPECT_FLOAT_EQ(bar->width, whole.width) << text;
        expect_apart(whole, text);
    }
    const FormulaBox one = box("\\frac{g}{m_{1} + L}");
    EXPECT_NEAR(letter(one, "g").x + 0.5F * letter(one, "g").width, 0.5F * one.width, 1.0F) << "its middle";
}

TEST(Formula, BaseLinesAlign) {
    const FormulaBox row = box("g + \\frac{L}{g} + \\sqrt{L} (m_{1} + 1)");
    EXPECT_EQ(letter(row, "m\u2081").y, 0.0F);
    EXPECT_EQ(row.letters.front().y, 0.0F);
    EXPECT_EQ(letter(row, "1").y, 0.0F);
    EXPECT_LT(letter(box("g^{2}"), "2").y, 0.0F);
    EXPECT_LT(letter(box("g^{2}"), "2").size, 20.0F);
    // The power is above the subscript, not after it.
    const FormulaBox power = box("m_{1}^{2}");
    EXPECT_FLOAT_EQ(letter(power, "2").x, 0.6F * 20.0F);
    // The bar of a fraction is level with a minus sign: above the baseline, below the top of a letter.
    EXPECT_LT(row.rules.front().y, 0.0F);
    EXPECT_GT(row.rules.front().y, -font().ascent * 20.0F);
}

TEST(Formula, NothingOverlapsHoweverDeep) {
    std::string text = "g";
    for (int i = 0; i < 6; ++i) {
        text = "\\frac{" + text + " + L}{\\sqrt{" + text + "} m_{1}^{2}} \\left(\\tfrac{1}{2} " + "L - g^{2}\\right)";
        expect_apart(box(text), text);
        if (text.size() > 2000) break;
    }
    expect_apart(box("L^{2^{g}} \\dot{\\theta}_{2}^{2} \\sin^{2}(g - \\frac{1}{L})"), "powers");
    expect_apart(
        set_matrix({{read("\\tfrac{1}{3} m_{1}"), read("0")}, {read("\\frac{g + L}{\\frac{1}{g}}"), read("L^{2}")}},
                   20.0F, font()),
        "a matrix");
}

TEST(Formula, BracketsAreAsHighAsWhatTheyEnclose) {
    const FormulaBox low = box("(g + L)"), high = box("(\\frac{g}{L} + \\frac{L}{g})");
    EXPECT_TRUE(low.strokes.empty());
    ASSERT_EQ(high.strokes.size(), 2U);
    for (const FormulaBox::FormulaStroke& bow : high.strokes) {
        EXPECT_LE(bow.points.front().y, -box("\\frac{g}{L}").ascent);
        EXPECT_GE(bow.points.back().y, box("\\frac{g}{L}").descent);
    }
    // The radical sign extends from below its content to its bar.
    const FormulaBox root = box("\\sqrt{\\frac{g}{L}}");
    EXPECT_NEAR(root.strokes.front().points.back().y, root.rules.back().y, 2.0);
}

TEST(Formula, LongSumsAreBrokenAtTheirSigns) {
    std::string text = "m_{1} L";
    for (int i = 0; i < 30; ++i) text += i % 2 == 0 ? " + g (L - 1)" : " - \\frac{g}{L}";
    for (const float width : {150.0F, 300.0F, 700.0F}) {
        const std::vector<FormulaBox> lines = set_in_lines(read(text), 20.0F, font(), width, 30.0F);
        EXPECT_GT(lines.size(), 2U);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            EXPECT_LE(lines[i].width, width - (i == 0 ? 0.0F : 30.0F)) << i;
            expect_apart(lines[i], "line " + std::to_string(i));
            const std::string first = lines[i].letters.front().label;
            EXPECT_TRUE(i == 0 || first == "+" || first == "\u2212") << first;
        }
    }
    // A formula that fits is one line. Breaks are inside brackets only if there is no other place, and in a product
    // last.
    EXPECT_EQ(set_in_lines(read("g + L"), 20.0F, font(), 400.0F, 0.0F).size(), 1U);
    EXPECT_EQ(set_in_lines(read("g (m_{1} + L + g + L + g + L)"), 20.0F, font(), 120.0F, 0.0F).front().letters[2].label,
              "m\u2081");
    EXPECT_GT(set_in_lines(read("g L g L g L g L"), 20.0F, font(), 40.0F, 0.0F).size(), 2U);
    // A piece that cannot be broken may be wider than the line, and is alone in it.
    EXPECT_EQ(set_in_lines(read("\\mathit{mass} + g"), 20.0F, font(), 20.0F, 0.0F).size(), 2U);
}

}  // namespace
}  // namespace achilles
