// Formulas as boxes. They are read from the LaTeX that the library writes (expression/notation.hpp), then measured and
// typeset with fractions, roots, powers and indices, in lines that fit a width. Only geometry is computed here;
// paint/paint.hpp draws it. That LaTeX is also what a user copies and what `check` prints: a second writer, of boxes,
// would repeat its rules for brackets, signs and the order of factors.
//
// Names are labels (label.hpp), so that they look the same here as on an axis.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "figure/figure.hpp"

namespace achilles {

struct FormulaPiece;

// A row of pieces, from left to right.
struct Formula {
    std::vector<FormulaPiece> pieces;
    bool is_empty() const { return pieces.empty(); }
};

struct FormulaPiece {
    enum class Kind {
        letters,   // a name, a number, a word
        function,  // function name, such as sin; its argument follows
        sign,      // + and -, binary or unary; the dot of a product
        relation,  // = and <
        comma,
        open,  // brackets: they stay in the row that they enclose, so that lines can break inside
        close,
        fraction,  // parts: numerator, denominator
        root,      // parts: the radicand
        space
    } kind = Kind::letters;
    std::string label;      // text, if the kind is `letters`
    int name = -1;          // index into the list of names; -1: not a name
    bool is_small = false;  // a numeric coefficient, typeset small
    std::vector<Formula> parts;
    Formula power;
};

// A name in LaTeX and as a label.
struct FormulaName {
    std::string latex, label;
};

// Reads a formula. Accepts any text: unknown commands are kept as they are.
Formula read_formula(std::string_view latex, const std::vector<FormulaName>& names);
// Reads a sentence with formulas between dollar signs, word by word.
Formula read_sentence(std::string_view text, const std::vector<FormulaName>& names);
// Concatenates formulas into one row.
Formula joined(std::vector<Formula> parts);
// The formula in one line of plain text, for tests and the clipboard: (a + b)/(2 c), x_1^2, sqrt(x).
std::string to_text(const Formula& formula);

// Font metrics for typesetting. ascent and descent are fractions of the letter size; width() is in units of `size`.
struct FormulaFont {
    std::function<float(const std::string& label, float size)> width;
    float ascent = 0.66F, descent = 0.18F;  // of letters, from the baseline
};

// A typeset formula. Coordinates: x to the right from its left end, y downward from its baseline.
struct FormulaBox {
    struct Letters {
        float x = 0.0F, y = 0.0F, width = 0.0F, size = 0.0F;  // x, y: left end of the baseline
        std::string label;
        int name = -1;
    };
    struct FormulaRule {
        float x = 0.0F, y = 0.0F, width = 0.0F, height = 0.0F;
    };
    struct FormulaStroke {
        std::vector<Point> points;
        float width = 1.0F;
    };
    float width = 0.0F, ascent = 0.0F, descent = 0.0F;
    std::vector<Letters> letters;
    std::vector<FormulaRule> rules;
    std::vector<FormulaStroke> strokes;

    float height() const { return ascent + descent; }
    // Adds another box at (x, y), and extends this one.
    void put(const FormulaBox& other, float x, float y);
};

FormulaBox set(const Formula& formula, float size, const FormulaFont& font);
// Typesets in lines no wider than `width`, as far as breaks exist. Breaks are at + and - outside brackets, then inside
// brackets, and last between factors. Lines after the first are `indent` narrower, because they are drawn that much
// further right.
std::vector<FormulaBox> set_in_lines(const Formula& formula, float size, const FormulaFont& font, float width,
                                     float indent);
// A matrix in brackets.
FormulaBox set_matrix(const std::vector<std::vector<Formula>>& rows, float size, const FormulaFont& font);

}  // namespace achilles
