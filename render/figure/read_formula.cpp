// Parses the LaTeX that the library writes into rows of pieces.
#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "expression/name_suggestions.hpp"
#include "figure/formula.hpp"
#include "figure/label.hpp"

namespace achilles {

namespace {

using Kind = FormulaPiece::Kind;

bool is_formula_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

constexpr std::array<std::string_view, 14> function_words{"sin",  "cos",  "tan", "arcsin", "arccos", "arctan", "sinh",
                                                          "cosh", "tanh", "exp", "log",    "mathrm", "min",    "max"};

class FormulaReader {
 public:
    FormulaReader(std::string_view text, const std::vector<FormulaName>& names) : text_(text), names_(names) {}

    Formula row(char end = '\0') {
        Formula result;
        while (at_ < text_.size() && text_[at_] != end) next(result);
        return result;
    }

 private:
    bool follows(std::string_view word) const { return text_.substr(at_, word.size()) == word; }
    bool take(std::string_view word) {
        if (!follows(word)) return false;
        at_ += word.size();
        return true;
    }
    // The content of braces, or the single item that follows.
    Formula argument() {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
        Formula result;
        if (depth_ > deepest) {
            skip();
            result.pieces.push_back(plain(Kind::letters, "\u2026"));
            return result;
        }
        ++depth_;
        if (take("{")) {
            result = row('}');
            take("}");
        } else if (at_ < text_.size()) {
            next(result);
        }
        --depth_;
        return result;
    }

    // Skips an argument nested too deeply to be readable.
    void skip() {
        int open = 0;
        do {
            if (at_ < text_.size() && text_[at_] == '{') ++open;
            if (at_ < text_.size() && text_[at_] == '}') --open;
            ++at_;
        } while (open > 0 && at_ < text_.size());
        at_ = std::min(at_, text_.size());
    }

    // Reads the longest name at this position. A name must not end inside a longer word.
    bool name(Formula& row) {
        std::size_t best = names_.size(), length = 0;
        for (std::size_t i = 0; i < names_.size(); ++i) {
            const std::string& latex = names_[i].latex;
            if (latex.size() <= length || !follows(latex)) continue;
            const std::size_t end = at_ + latex.size();
            if (is_letter(latex.back()) && end < text_.size() && is_letter(text_[end])) continue;
            best = i;
            length = latex.size();
        }
        if (best == names_.size()) return false;
        at_ += length;
        FormulaPiece piece;
        piece.label = names_[best].label;
        piece.name = static_cast<int>(best);
        row.pieces.push_back(std::move(piece));
        return true;
    }

    static FormulaPiece plain(Kind kind, std::string label) {
        FormulaPiece piece;
        piece.kind = kind;
        piece.label = std::move(label);
        return piece;
    }

    std::string word() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && is_letter(text_[at_])) ++at_;
        return std::string(text_.substr(begin, at_ - begin));
    }

    // Reads a command after its backslash.
    void command(Formula& row) {
        if (at_ < text_.size() && !is_letter(text_[at_])) {
            const char c = text_[at_++];
            row.pieces.push_back(c == ',' ? plain(Kind::space, "") : plain(Kind::letters, std::string(1, c)));
            return;
        }
        const std::string what = word();
        if (what == "frac" || what == "tfrac") {
            FormulaPiece piece = plain(Kind::fraction, "");
            piece.is_small = what == "tfrac";
            piece.parts.push_back(argument());
            piece.parts.push_back(argument());
            row.pieces.push_back(std::move(piece));
        } else if (what == "sqrt") {
            FormulaPiece piece = plain(Kind::root, "");
            piece.parts.push_back(argument());
            row.pieces.push_back(std::move(piece));
        } else if (what == "dot" || what == "ddot") {
            Formula inner = argument();
            if (!inner.is_empty()) inner.pieces.back().label += what == "dot" ? "\u0307" : "\u0308";
            append(row, std::move(inner));
        } else if (what == "left" || what == "right") {
            // The bracket itself follows. Its height is adjusted to its content anyway.
        } else if (what == "text" || what == "mathrm" || what == "mathit") {
            take("{");
            const std::size_t end = std::min(text_.find('}', at_), text_.size());
            std::string label(text_.substr(at_, end - at_));
            at_ = std::min(end + 1, text_.size());
            // A differential forms one word with its variable.
            if (label == "d" && at_ < text_.size() && is_letter(text_[at_])) label += typeset(text_.substr(at_++, 1));
            row.pieces.push_back(plain(Kind::letters, label));
        } else if (what == "cdot") {
            row.pieces.push_back(plain(Kind::sign, "\u00b7"));
        } else if (what == "quad") {
            row.pieces.push_back(plain(Kind::space, ""));
        } else if (what == "top") {
            row.pieces.push_back(plain(Kind::letters, "T"));
        } else if (std::find(function_words.begin(), function_words.end(), what) != function_words.end()) {
            row.pieces.push_back(plain(Kind::function, what));
        } else {
            row.pieces.push_back(plain(Kind::letters, typeset(what)));
        }
    }

    static void append(Formula& row, Formula other) {
        for (FormulaPiece& piece : other.pieces) row.pieces.push_back(std::move(piece));
    }

    // Attaches a subscript or superscript to the preceding piece.
    void script(Formula& row, bool is_power) {
        Formula inside = argument();
        if (row.is_empty()) row.pieces.emplace_back();
        FormulaPiece& base = row.pieces.back();
        if (is_power)
            base.power = std::move(inside);
        else
            base.label += "_{" + to_text(inside) + "}";
    }

    void next(Formula& row) {
        if (name(row)) return;
        const char c = text_[at_];
        if (is_formula_digit(c) || c == '.') {
            std::size_t end = at_;
            while (end < text_.size() && (is_formula_digit(text_[end]) || text_[end] == '.')) ++end;
            row.pieces.push_back(plain(Kind::letters, std::string(text_.substr(at_, end - at_))));
            at_ = end;
            return;
        }
        const std::size_t begin = at_;
        const char32_t code = next_code_point(text_, at_);
        switch (c) {
            case ' ':
                return;
            case '\\':
                return command(row);
            case '_':
            case '^':
                return script(row, c == '^');
            case '{':
                --at_;
                return append(row, argument());
            case '}':
                return;
            case '(':
            case ')':
                return row.pieces.push_back(plain(c == '(' ? Kind::open : Kind::close, std::string(1, c)));
            case '+':
                return row.pieces.push_back(plain(Kind::sign, "+"));
            case '-':
                return row.pieces.push_back(plain(Kind::sign, "\u2212"));
            case '=':
            case '<':
            case '>':
                return row.pieces.push_back(plain(Kind::relation, std::string(1, c)));
            case ',':
                return row.pieces.push_back(plain(Kind::comma, ","));
            default:
                break;
        }
        const std::string letter(text_.substr(begin, at_ - begin));
        row.pieces.push_back(plain(Kind::letters, is_letter(c) ? typeset(letter) : utf8(code)));
    }

    std::string_view text_;
    const std::vector<FormulaName>& names_;
    std::size_t at_ = 0;
    int depth_ = 0;
    static constexpr int deepest = 30;
};

// Unescapes LaTeX text: \_ is _, \textbackslash{} is a backslash.
std::string unescaped(std::string_view words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        constexpr std::string_view backslash = "\\textbackslash{}";
        if (words.substr(i, backslash.size()) == backslash) {
            text += '\\';
            i += backslash.size() - 1;
        } else if (words[i] == '\\' && i + 1 < words.size()) {
            text += words[++i];
            if (words.substr(i + 1, 2) == "{}") i += 2;
        } else {
            text += words[i];
        }
    }
    return text;
}

}  // namespace

Formula read_formula(std::string_view latex, const std::vector<FormulaName>& names) {
    return FormulaReader(latex, names).row();
}

Formula joined(std::vector<Formula> parts) {
    Formula result;
    for (Formula& part : parts)
        for (FormulaPiece& piece : part.pieces) result.pieces.push_back(std::move(piece));
    return result;
}

Formula read_sentence(std::string_view text, const std::vector<FormulaName>& names) {
    std::vector<Formula> parts;
    const auto words = [&](const std::string& all) {
        Formula row;
        for (std::size_t at = 0; at < all.size();) {
            const std::size_t end = std::min(all.find(' ', at), all.size());
            FormulaPiece piece;
            piece.label = all.substr(at, end - at);
            const bool is_mark = end > at && std::string_view(",.:;)").find(all[at]) != std::string_view::npos;
            piece.kind = end == at ? Kind::space : is_mark ? Kind::comma : Kind::letters;
            row.pieces.push_back(std::move(piece));
            if (end > at && end < all.size()) row.pieces.emplace_back().kind = Kind::space;
            at = end + 1;
        }
        parts.push_back(std::move(row));
    };
    for (std::size_t at = 0; at < text.size();) {
        const bool is_formula = text[at] == '$';
        const std::size_t begin = at + (is_formula ? 1 : 0), end = std::min(text.find('$', begin), text.size());
        const std::string_view part = text.substr(begin, end - begin);
        if (is_formula)
            parts.push_back(read_formula(part, names));
        else
            words(unescaped(part));
        at = is_formula ? std::min(end + 1, text.size()) : end;
    }
    return joined(std::move(parts));
}

namespace {

// The label with upright letters.
std::string upright(const std::string& label) {
    std::string text;
    for (std::size_t at = 0; at < label.size();) {
        const std::string letter = utf8(next_code_point(label, at));
        const std::vector<Letter> one = letters(letter);
        text += !one.empty() && one.front().italic ? utf8(one.front().code) : letter;
    }
    return text;
}

}  // namespace

std::string to_text(const Formula& formula) {
    std::string text;
    const auto in_brackets = [](const Formula& part) {
        const std::string inside = to_text(part);
        return part.pieces.size() > 1 ? "(" + inside + ")" : inside;
    };
    for (std::size_t i = 0; i < formula.pieces.size(); ++i) {
        const FormulaPiece& piece = formula.pieces[i];
        const Kind before = i == 0 ? Kind::open : formula.pieces[i - 1].kind;
        const bool is_apart = before != Kind::open && before != Kind::space && piece.kind != Kind::close &&
                              piece.kind != Kind::comma && piece.kind != Kind::space &&
                              !(piece.kind == Kind::open && before == Kind::function) &&
                              !(i == 1 && before == Kind::sign);
        if (is_apart) text += ' ';
        if (piece.kind == Kind::fraction)
            text += in_brackets(piece.parts[0]) + "/" + in_brackets(piece.parts[1]);
        else if (piece.kind == Kind::root)
            text += "\u221a(" + to_text(piece.parts[0]) + ")";
        else
            text += piece.kind == Kind::space ? " " : upright(piece.label);
        if (!piece.power.is_empty()) text += "^" + in_brackets(piece.power);
    }
    return text;
}

}  // namespace achilles
