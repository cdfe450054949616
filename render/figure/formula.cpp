// Typesetting of formulas: pieces into boxes, boxes into rows, rows into lines.
#include "figure/formula.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "figure/label.hpp"

namespace achilles {

namespace {

using Kind = FormulaPiece::Kind;

// Fractions of the letter size.
constexpr float axis_height = 0.25F;      // above the baseline: height of fraction bars and minus signs
constexpr float rule_thickness = 0.065F;  // of lines
constexpr float bar_gap = 0.13F;          // between a fraction bar and numerator or denominator
constexpr float bar_overhang = 0.06F;
constexpr float small_size = 0.74F;  // of powers, and of fractions inside fractions
constexpr float thin_space = 0.13F, wide_space = 0.24F;

float rule_width(float size) { return std::max(1.0F, std::round(rule_thickness * size)); }

// Position at which the subscript of a name begins; a power is placed above it.
std::size_t index_at(const std::string& label) {
    for (std::size_t i = 0; i + 1 < label.size(); ++i) {
        if (label[i] == '_' && label[i + 1] == '{') return i;
        if (label.compare(i, 2, "\u2080", 2) == 0 && i + 2 < label.size() &&
            static_cast<unsigned char>(label[i + 2]) <= 0x89)
            return i;
    }
    return label.size();
}

FormulaBox letters_of(const std::string& label, int name, float size, const FormulaFont& font) {
    FormulaBox box;
    box.width = std::ceil(font.width(label, size));  // letters stand on whole pixels
    const bool has_dots = label.find("\u0307") != std::string::npos || label.find("\u0308") != std::string::npos;
    box.ascent = size * (font.ascent + (has_dots ? 0.14F : 0.0F));
    box.descent = size * font.descent;
    box.letters.push_back({0.0F, 0.0F, box.width, size, label, name});
    return box;
}

FormulaBox fraction(const FormulaPiece& piece, float size, const FormulaFont& font, bool is_inside) {
    const float inner = piece.is_small || is_inside ? size * small_size : size;
    const FormulaBox top = set(piece.parts[0], inner, font), bottom = set(piece.parts[1], inner, font);
    const float rule = rule_width(inner), gap = bar_gap * inner, over = bar_overhang * size;
    FormulaBox box;
    const float wider = std::max(top.width, bottom.width), bar = std::round(-axis_height * size) - 0.5F * rule;
    box.put(top, over + 0.5F * (wider - top.width), bar - gap - top.descent);
    box.put(bottom, over + 0.5F * (wider - bottom.width), bar + rule + gap + bottom.ascent);
    box.width = wider + 2.0F * over;
    box.rules.push_back({0.0F, bar, box.width, rule});
    return box;
}

FormulaBox root(const FormulaPiece& piece, float size, const FormulaFont& font) {
    const FormulaBox inside = set(piece.parts[0], size, font);
    const float rule = rule_width(size), gap = 0.12F * size, sign = 0.55F * size;
    const float top = -inside.ascent - gap - rule, low = inside.descent, middle = low - 0.5F * (low - top);
    FormulaBox box;
    box.put(inside, sign + 0.04F * size, 0.0F);
    box.ascent = std::max(box.ascent, -top);
    box.width += 0.06F * size;
    box.rules.push_back({sign, top, box.width - sign, rule});
    box.strokes.push_back({{{0.02F * size, middle + 0.06F * size},
                            {0.16F * size, middle - 0.02F * size},
                            {0.34F * size, low},
                            {sign, top + 0.5F * rule}},
                           rule});
    return box;
}

// A bracket as high as its content: a letter, or a drawn arc.
FormulaBox bracket(const FormulaPiece& piece, const FormulaBox& inside, float size, const FormulaFont& font) {
    const float high = std::max(inside.ascent, 0.0F), low = std::max(inside.descent, 0.0F);
    FormulaBox letter = letters_of(piece.label, -1, size, font);
    constexpr float highest = 0.98F, lowest = 0.36F;  // of the content of a letter-sized bracket: a power fits, a
                                                      // fraction does not
    if (high <= highest * size && low <= lowest * size) return letter;
    FormulaBox box;
    box.width = 0.36F * size;
    box.ascent = high + 0.04F * size;
    box.descent = low + 0.04F * size;
    FormulaBox::FormulaStroke bow{{}, std::max(1.0F, rule_thickness * 1.2F * size)};
    constexpr int steps = 12;
    const float near = 0.30F * size, far = 0.09F * size;
    for (int i = 0; i <= steps; ++i) {
        const float u = 2.0F * static_cast<float>(i) / steps - 1.0F;
        const float x = far + (near - far) * u * u * u * u * 0.6F + (near - far) * u * u * 0.4F;
        const float y = -box.ascent + 0.5F * (u + 1.0F) * (box.ascent + box.descent);
        bow.points.push_back({piece.kind == Kind::open ? x : box.width - x, y});
    }
    box.strokes.push_back(std::move(bow));
    return box;
}

void raise(FormulaBox& box, const FormulaPiece& piece, float size, const FormulaFont& font) {
    if (piece.power.is_empty()) return;
    const FormulaBox power = set(piece.power, size * small_size, font);
    // Above a subscript, to the right of everything else, at a height that depends on the base.
    const bool is_name = piece.kind == Kind::letters || piece.kind == Kind::function;
    const float x = is_name ? font.width(piece.label.substr(0, index_at(piece.label)), size) : box.width;
    const float up = std::max(box.ascent - 0.45F * power.ascent, power.descent + 0.30F * size);
    box.put(power, x, -up);
}

// An element of a row: a box and the space before it.
struct RowElement {
    FormulaBox box;
    float space = 0.0F;  // before it, unless it starts a line
    Kind kind = Kind::letters;
    bool is_prefix = false;  // a sign that belongs to the following element
    bool is_brick = false;   // the argument of a function, which stays beside its name
    int depth = 0;           // number of brackets around it
};

bool is_prefix(const std::vector<FormulaPiece>& row, std::size_t i) {
    if (row[i].kind != Kind::sign) return false;
    if (i == 0) return true;
    const Kind before = row[i - 1].kind;
    return before == Kind::open || before == Kind::relation || before == Kind::sign || before == Kind::comma;
}

float space_between(const FormulaPiece& a, bool a_is_prefix, const FormulaPiece& b, bool b_is_prefix) {
    if (a.kind == Kind::space) return 0.0F;
    if (b.kind == Kind::space) return 0.28F;
    if (a.kind == Kind::open || b.kind == Kind::close || b.kind == Kind::comma) return 0.02F;
    if (a.kind == Kind::comma) return wide_space;
    if (a.kind == Kind::relation || b.kind == Kind::relation) return 0.30F;
    if (b.kind == Kind::sign) return b_is_prefix ? 0.0F : b.label == "\u00b7" ? thin_space : wide_space;
    if (a.kind == Kind::sign) return a_is_prefix ? 0.04F : a.label == "\u00b7" ? thin_space : wide_space;
    if (a.kind == Kind::function) return b.kind == Kind::open ? 0.03F : thin_space;
    if (b.kind == Kind::function) return 0.2F;
    return thin_space;
}

// Index of each bracket's partner; its own index without a partner.
std::vector<std::size_t> partners(const std::vector<FormulaPiece>& row) {
    std::vector<std::size_t> result(row.size()), open;
    for (std::size_t i = 0; i < row.size(); ++i) {
        result[i] = i;
        if (row[i].kind == Kind::open) open.push_back(i);
        if (row[i].kind != Kind::close || open.empty()) continue;
        result[i] = open.back();
        result[open.back()] = i;
        open.pop_back();
    }
    return result;
}

std::vector<RowElement> set_pieces(const Formula& formula, float size, const FormulaFont& font, bool is_inside) {
    const std::vector<FormulaPiece>& row = formula.pieces;
    std::vector<RowElement> result(row.size());
    int depth = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        RowElement& one = result[i];
        one.kind = row[i].kind;
        one.is_prefix = is_prefix(row, i);
        if (i > 0)
            one.space = std::round(size * space_between(row[i - 1], result[i - 1].is_prefix, row[i], one.is_prefix));
        one.is_brick = i > 0 && row[i - 1].kind == Kind::function;
        depth -= row[i].kind == Kind::close ? 1 : 0;
        one.depth = depth;
        depth += row[i].kind == Kind::open ? 1 : 0;
        if (row[i].kind == Kind::fraction)
            one.box = fraction(row[i], size, font, is_inside);
        else if (row[i].kind == Kind::root)
            one.box = root(row[i], size, font);
        else if (row[i].kind != Kind::space && row[i].kind != Kind::open && row[i].kind != Kind::close)
            one.box = letters_of(row[i].label, row[i].name, size, font);
        if (row[i].kind != Kind::open && row[i].kind != Kind::close) raise(one.box, row[i], size, font);
    }
    // Inner brackets first: a closing bracket comes after everything that it encloses.
    const std::vector<std::size_t> partner = partners(row);
    for (std::size_t i = 0; i < row.size(); ++i) {
        const bool is_alone = partner[i] == i;
        if (row[i].kind != Kind::close && !(row[i].kind == Kind::open && is_alone)) continue;
        FormulaBox inside;
        for (std::size_t k = partner[i] + 1; k < i; ++k) {
            inside.ascent = std::max(inside.ascent, result[k].box.ascent);
            inside.descent = std::max(inside.descent, result[k].box.descent);
        }
        if (!is_alone) result[partner[i]].box = bracket(row[partner[i]], inside, size, font);
        result[i].box = bracket(row[i], inside, size, font);
        raise(result[i].box, row[i], size, font);
    }
    return result;
}

FormulaBox row_of(const std::vector<RowElement>& all, std::size_t begin, std::size_t end) {
    FormulaBox line;
    for (std::size_t i = begin; i < end; ++i) {
        const float x = line.width + (i == begin ? 0.0F : all[i].space);
        line.put(all[i].box, x, 0.0F);
        line.width = std::max(line.width, x);  // a space has no width of its own
    }
    return line;
}

float width_of(const std::vector<RowElement>& all, std::size_t begin, std::size_t end) {
    float width = 0.0F;
    for (std::size_t i = begin; i < end; ++i) width += all[i].box.width + (i == begin ? 0.0F : all[i].space);
    return width;
}

// Cost of a line break before element i: the depth of brackets, plus a penalty for breaking a product; `never` if no
// break is allowed.
constexpr int never = 1000, of_product = 100;
int cost_of_break(const std::vector<RowElement>& all, std::size_t i) {
    const RowElement& here = all[i];
    if (i == 0 || here.is_brick || here.kind == Kind::close || here.kind == Kind::comma || all[i - 1].is_prefix)
        return never;
    if (all[i - 1].kind == Kind::space) return 0;  // between words
    if (here.kind == Kind::space || all[i - 1].kind == Kind::open) return never;
    if (here.kind == Kind::sign && !here.is_prefix && here.box.letters.front().label != "\u00b7") return here.depth;
    for (const Kind kind : {here.kind, all[i - 1].kind})
        if (kind == Kind::relation || kind == Kind::sign) return never;
    return of_product + here.depth;
}

}  // namespace

void FormulaBox::put(const FormulaBox& other, float x, float y) {
    for (Letters one : other.letters) {
        one.x += x;
        one.y += y;
        letters.push_back(std::move(one));
    }
    for (FormulaRule one : other.rules) rules.push_back({one.x + x, one.y + y, one.width, one.height});
    for (FormulaStroke one : other.strokes) {
        for (Point& point : one.points) point = {point.x + double{x}, point.y + double{y}};
        strokes.push_back(std::move(one));
    }
    width = std::max(width, x + other.width);
    ascent = std::max(ascent, other.ascent - y);
    descent = std::max(descent, other.descent + y);
}

FormulaBox set(const Formula& formula, float size, const FormulaFont& font) {
    const std::vector<RowElement> all = set_pieces(formula, size, font, true);
    return row_of(all, 0, all.size());
}

std::vector<FormulaBox> set_in_lines(const Formula& formula, float size, const FormulaFont& font, float width,
                                     float indent) {
    const std::vector<RowElement> all = set_pieces(formula, size, font, false);
    std::vector<FormulaBox> lines;
    for (std::size_t begin = 0; begin < all.size();) {
        const float room = width - (lines.empty() ? 0.0F : indent);
        std::size_t end = all.size();
        if (width_of(all, begin, end) > room) {
            // Of the breaks that fit, take the one with the lowest cost and the fullest line; if none fits, take the
            // first.
            float least = never;
            for (std::size_t i = begin + 1; i < all.size(); ++i) {
                const int cost = cost_of_break(all, i);
                const float taken = width_of(all, begin, i);
                if (taken > room && least < never) break;
                const float penalty = static_cast<float>(cost) + 3.0F * (1.0F - taken / std::max(room, 1.0F));
                if (cost >= never || penalty >= least) continue;
                least = penalty;
                end = i;
                if (taken > room) break;
            }
        }
        while (begin < end && all[begin].kind == Kind::space && !lines.empty()) ++begin;
        lines.push_back(row_of(all, begin, end));
        begin = end;
    }
    return lines;
}

FormulaBox set_matrix(const std::vector<std::vector<Formula>>& rows, float size, const FormulaFont& font) {
    std::vector<std::vector<FormulaBox>> boxes;
    std::vector<float> widths;
    for (const std::vector<Formula>& row : rows) {
        boxes.emplace_back();
        for (const Formula& entry : row) boxes.back().push_back(set(entry, size, font));
        widths.resize(std::max(widths.size(), row.size()), 0.0F);
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], boxes.back()[i].width);
    }
    const float between = 0.35F * size, apart = 1.1F * size, margin = 0.34F * size, rule = rule_width(size);
    std::vector<float> base;
    float height = 0.0F;
    for (const std::vector<FormulaBox>& row : boxes) {
        float ascent = font.ascent * size, descent = font.descent * size;
        for (const FormulaBox& entry : row) {
            ascent = std::max(ascent, entry.ascent);
            descent = std::max(descent, entry.descent);
        }
        base.push_back(height + (base.empty() ? 0.0F : between) + ascent);
        height = base.back() + descent;
    }
    // The center of the matrix is on the axis.
    const float top = std::round(-0.5F * height - axis_height * size);
    FormulaBox box;
    for (std::size_t r = 0; r < boxes.size(); ++r) {
        float x = margin;
        for (std::size_t i = 0; i < boxes[r].size(); ++i) {
            box.put(boxes[r][i], x + 0.5F * (widths[i] - boxes[r][i].width), top + base[r]);
            x += widths[i] + apart;
        }
    }
    float inner = -apart;
    for (const float width : widths) inner += width + apart;
    const float low = top - 0.12F * size, high = height + 0.24F * size, foot = 0.22F * size;
    box.width = std::max(0.0F, inner) + 2.0F * margin;
    box.ascent = std::max(box.ascent, -low);
    box.descent = std::max(box.descent, low + high);
    for (const bool is_left : {true, false}) {
        const float edge = is_left ? 0.06F * size : box.width - 0.06F * size - rule;
        const float serif = is_left ? edge : edge + rule - foot;
        box.rules.push_back({edge, low, rule, high});
        box.rules.push_back({serif, low, foot, rule});
        box.rules.push_back({serif, low + high - rule, foot, rule});
    }
    return box;
}

}  // namespace achilles
