// Formulas as boxes: read from the LaTeX that the library itself writes (expression/notation.hpp), measured and set
// with fractions, roots, powers and indices, in lines that fit a width. Numbers only: paint/paint.hpp draws them.
//
// Letters are labels (label.hpp), so a name looks the same here as at an axis.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "figure/figure.hpp"

namespace achilles {

struct FormulaPiece;

// What stands in a row, from left to right.
struct Formula {
    std::vector<FormulaPiece> pieces;
    bool is_empty() const { return pieces.empty(); }
};

struct FormulaPiece {
    enum class Kind {
        letters,   // a name, a number, a word
        function,  // sin: its argument follows
        sign,      // + and -, between two terms or in front of one; a product's dot
        relation,  // = and <
        comma,
        open,  // brackets: they stand in the row that they enclose, so that it can be broken
        close,
        fraction,  // parts: top, bottom
        root,      // parts: what it is taken of
        space
    } kind = Kind::letters;
    std::string label;      // of what is letters
    int name = -1;          // which of the names; -1: none
    bool is_small = false;  // a number in front of a product: set small
    std::vector<Formula> parts;
    Formula power;
};

// A name as formulas write it, and as it is shown.
struct FormulaName {
    std::string latex, label;
};

// Any text is read: what is not known stands there as it is.
Formula read_formula(std::string_view latex, const std::vector<FormulaName>& names);
// A sentence with formulas between dollar signs, word by word.
Formula read_sentence(std::string_view text, const std::vector<FormulaName>& names);
// A row of formulas, one after the other.
Formula joined(std::vector<Formula> parts);
// The formula in one line of plain text, for tests and for the clipboard: (a + b)/(2 c), x_1^2, sqrt(x).
std::string to_text(const Formula& formula);

// What setting needs to know of a font. Lengths are shares of the letters' size, but for width's.
struct FormulaFont {
    std::function<float(const std::string& label, float size)> width;
    float ascent = 0.66F, descent = 0.18F;  // of letters, from their base line
};

// A formula in its place: x to the right of its left end, y downwards from its base line.
struct FormulaBox {
    struct Letters {
        float x = 0.0F, y = 0.0F, width = 0.0F, size = 0.0F;  // of the base line's left end
        std::string label;
        int name = -1;
    };
    struct Rule {
        float x = 0.0F, y = 0.0F, width = 0.0F, height = 0.0F;
    };
    struct Stroke {
        std::vector<Point> points;
        float width = 1.0F;
    };
    float width = 0.0F, ascent = 0.0F, descent = 0.0F;
    std::vector<Letters> letters;
    std::vector<Rule> rules;
    std::vector<Stroke> strokes;

    float height() const { return ascent + descent; }
    // Puts another box there; this one grows.
    void put(const FormulaBox& other, float x, float y);
};

FormulaBox set(const Formula& formula, float size, const FormulaFont& font);
// In lines no wider than `width` wherever they can be broken: at + and - outside of brackets, then inside, at last
// between factors. Those after the first are to stand `indent` further right, and have so much less room.
std::vector<FormulaBox> set_in_lines(const Formula& formula, float size, const FormulaFont& font, float width,
                                     float indent);
// Rows and columns in brackets.
FormulaBox set_matrix(const std::vector<std::vector<Formula>>& rows, float size, const FormulaFont& font);

}  // namespace achilles
