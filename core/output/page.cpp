#include "output/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace achilles {

namespace {

// Number of characters in a UTF-8 text.
std::size_t shown(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::vector<std::size_t> column_widths(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], shown(row[i]));
    }
    return widths;
}

std::string padded(const std::string& text, std::size_t width) { return text + std::string(width - shown(text), ' '); }

// Writes a page as text, block by block.
class PageWriter {
 public:
    explicit PageWriter(const Page& page) : notation_(page.notation()), width_(page.width()) {}

    void write(const Block& block) {
        switch (block.kind) {
            case Block::Kind::title:
                return title(block.words.text, block.words.latex);
            case Block::Kind::heading:
                return heading(block.words.text);
            case Block::Kind::caption:
            case Block::Kind::sentence:
                return sentence(block.words);
            case Block::Kind::lines:
                return lines(block.rows);
            case Block::Kind::formula:
                return formula(block.words, block.right, block.indent);
            case Block::Kind::matrix:
                return matrix(block.words, block.rows);
        }
    }
    std::string finish() {
        if (notation_ == Notation::latex) content_ += "\n\\end{document}\n";
        return content_;
    }

 private:
    void title(const std::string& title, const std::string& source) {
        if (notation_ == Notation::text) {
            content_ += title + "\n";
            if (!source.empty()) content_ += "  " + source + "\n";
            return;
        }
        content_ +=
            "\\documentclass{article}\n\\usepackage[a4paper,margin=2cm]{geometry}\n\\usepackage{amsmath}\n"
            "\\setlength{\\parindent}{0pt}\n\\begin{document}\n\n";
        content_ += fmt::format("\\section*{{{}}}\n{}\n", Page::escaped(title), Page::escaped(source));
    }

    void heading(const std::string& words) {
        content_ += notation_ == Notation::text ? fmt::format("\n{}\n", words)
                                                : fmt::format("\n\\subsection*{{{}}}\n", Page::escaped(words));
    }

    void sentence(const TextAndLatex& words) {
        content_ += notation_ == Notation::text ? fmt::format("  {}\n", words.text) : words.latex + "\n";
    }

    void lines(const std::vector<std::vector<std::string>>& rows) {
        const std::vector<std::size_t> widths = column_widths(rows);
        if (notation_ == Notation::latex && !rows.empty())
            content_ += fmt::format("\\begin{{tabular}}{{{}}}\n", std::string(widths.size(), 'l'));
        for (const auto& row : rows) {
            std::string line;
            for (std::size_t i = 0; i < row.size(); ++i)
                line += notation_ == Notation::text ? fmt::format("  {}", padded(row[i], widths[i]))
                                                    : fmt::format("{}{}", i == 0 ? "  " : " & ", row[i]);
            line.erase(line.find_last_not_of(' ') + 1);
            content_ += line + (notation_ == Notation::text ? "\n" : " \\\\\n");
        }
        if (notation_ == Notation::latex && !rows.empty()) content_ += "\\end{tabular}\n";
    }

    void formula(const TextAndLatex& left, const std::string& right, int indent) {
        if (notation_ == Notation::text) {
            const std::string margin(static_cast<std::size_t>(2 + indent), ' ');
            const std::string start = margin + left.text + (left.text.empty() ? "" : " = ");
            const std::vector<std::string> lines = wrap(right, width_ - std::min(width_ / 2, start.size()), notation_);
            for (std::size_t i = 0; i < lines.size(); ++i)
                content_ +=
                    (i == 0 ? start : std::string(start.size() + (left.text.empty() ? 2 : 0), ' ')) + lines[i] + "\n";
            return;
        }
        const std::vector<std::string> lines =
            wrap(right, width_ - std::min(width_ / 2, visible_length(left.latex, notation_) + 2), notation_);
        content_ += "\\begin{align*}\n";
        for (std::size_t i = 0; i < lines.size(); ++i)
            content_ += fmt::format("  {}{}{}\n",
                                    i > 0                ? "&\\quad "
                                    : left.latex.empty() ? "& "
                                                         : left.latex + " &= ",
                                    lines[i], i + 1 < lines.size() ? " \\\\" : "");
        content_ += "\\end{align*}\n";
    }

    void matrix(const TextAndLatex& left, const std::vector<std::vector<std::string>>& rows) {
        if (notation_ == Notation::latex) {
            content_ += fmt::format("\\[\n  {} = \\begin{{pmatrix}}\n", left.latex);
            for (std::size_t i = 0; i < rows.size(); ++i) {
                std::string line;
                for (const std::string& entry : rows[i]) line += (line.empty() ? "" : " & ") + entry;
                content_ += fmt::format("    {}{}\n", line, i + 1 < rows.size() ? " \\\\" : "");
            }
            content_ += "  \\end{pmatrix}\n\\]\n";
            return;
        }
        const std::vector<std::size_t> widths = column_widths(rows);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            std::string line =
                i == 0 ? fmt::format("  {} = [", left.text) : std::string(left.text.size() + 5, ' ') + "[";
            for (std::size_t j = 0; j < rows[i].size(); ++j)
                line += fmt::format("{}{}", j == 0 ? " " : "   ", padded(rows[i][j], widths[j]));
            content_ += line + " ]\n";
        }
    }

    Notation notation_;
    std::size_t width_;
    std::string content_;
};

}  // namespace

std::string Page::escaped(std::string_view words) {
    std::string result;
    for (const char c : words) {
        if (c == '\\')
            result += "\\textbackslash{}";
        else if (c == '~' || c == '^')
            result += fmt::format("\\{}{{}}", c);
        else if (c == '<' || c == '>' || c == '|')
            result += fmt::format("${}$", c);
        else if (std::string_view("&%$#_{}").find(c) != std::string_view::npos)
            result += fmt::format("\\{}", c);
        else
            result += c;
    }
    return result;
}

void Page::title(const std::string& title, const std::string& source) {
    blocks_.push_back({Block::Kind::title, {title, source}, {}});
}

void Page::heading(const TextAndLatex& words) { blocks_.push_back({Block::Kind::heading, words, {}}); }

void Page::caption(const std::string& words) { blocks_.push_back({Block::Kind::caption, {words, escaped(words)}, {}}); }

void Page::sentence(const TextAndLatex& words) { blocks_.push_back({Block::Kind::sentence, words, {}}); }

void Page::lines(const std::vector<std::vector<std::string>>& rows) {
    blocks_.push_back({Block::Kind::lines, {}, {}, rows});
}

void Page::formula(const TextAndLatex& left, const std::string& right, int indent) {
    blocks_.push_back({Block::Kind::formula, left, right, {}, indent});
}

void Page::matrix(const TextAndLatex& left, const std::vector<std::vector<std::string>>& rows) {
    blocks_.push_back({Block::Kind::matrix, left, {}, rows});
}

std::string Page::finish() const {
    PageWriter writing(*this);
    for (const Block& block : blocks_) writing.write(block);
    return writing.finish();
}

namespace {

// The positions of " + " and " - ", with the depth of brackets around each.
struct Place {
    std::size_t offset;
    int depth;
};

std::vector<Place> places(std::string_view formula) {
    constexpr int never = 1000;  // inside a LaTeX argument, or between \left and \right
    std::vector<Place> result;
    int depth = 0;
    std::vector<int> brackets;
    for (std::size_t i = 0; i < formula.size(); ++i) {
        const char c = formula[i];
        const auto follows = [&](std::string_view word) {
            return i >= word.size() && formula.substr(i - word.size(), word.size()) == word;
        };
        if (c == '(' || c == '{') {
            // A function's argument is not split either.
            const bool function = i > 0 && std::isalnum(static_cast<unsigned char>(formula[i - 1])) != 0;
            brackets.push_back(c == '{' || follows("\\left") || function ? never : 1);
            depth += brackets.back();
        }
        if ((c == ')' || c == '}') && !brackets.empty()) {
            depth -= brackets.back();
            brackets.pop_back();
        }
        const std::string_view sign = formula.substr(i, 3);
        if ((sign == " + " || sign == " - ") && depth < never) result.push_back({i, depth});
    }
    return result;
}

}  // namespace

std::size_t visible_length(std::string_view formula, Notation notation) {
    if (notation == Notation::text) return formula.size();
    std::size_t length = 0;
    for (std::size_t i = 0; i < formula.size(); ++i) {
        const char c = formula[i];
        if (c == '\\') {
            while (i + 1 < formula.size() && std::isalpha(static_cast<unsigned char>(formula[i + 1])) != 0) ++i;
            ++length;
        } else if (c != '{' && c != '}' && c != '_' && c != '^' && c != ' ') {
            ++length;
        } else if (formula.substr(i, 3) == " + " || formula.substr(i, 3) == " - ") {
            length += 2;
        }
    }
    return length;
}

std::vector<std::string> wrap(const std::string& formula, std::size_t width, Notation notation) {
    if (visible_length(formula, notation) <= width) return {formula};
    const std::vector<Place> all = places(formula);
    // The smallest depth at which every part fits; otherwise the last part list.
    constexpr int deepest = 8;
    std::vector<std::string> parts;
    for (int depth = 0; depth <= deepest; ++depth) {
        parts.clear();
        std::size_t begin = 0;
        for (const Place& place : all) {
            if (place.depth > depth) continue;
            parts.push_back(formula.substr(begin, place.offset - begin));
            begin = place.offset + 1;
        }
        parts.push_back(formula.substr(begin));
        if (std::all_of(parts.begin(), parts.end(),
                        [&](const std::string& part) { return visible_length(part, notation) <= width; }))
            break;
    }
    std::vector<std::string> lines;
    for (const std::string& part : parts) {
        if (lines.empty() || visible_length(lines.back(), notation) + visible_length(part, notation) + 1 > width)
            lines.push_back(part);
        else
            lines.back() += " " + part;
    }
    return lines;
}

namespace {

// Number of characters shown by a terminal: bytes that start a UTF-8 character.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

// Number of characters before the decimal point, or in all of a text without one.
std::size_t whole_width(const std::string& text) { return width_of(text.substr(0, text.find('.'))); }

}  // namespace

void TextTable::add_column(std::string heading, Align align) { columns_.push_back({std::move(heading), align}); }

std::string TextTable::text() const {
    const auto is_line = [&](std::size_t row) { return std::find(lines_.begin(), lines_.end(), row) != lines_.end(); };
    std::vector<std::size_t> whole(columns_.size(), 0), width(columns_.size(), 0);
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        const auto each_cell = [&](const auto& visit) {
            for (std::size_t r = 0; r < rows_.size(); ++r)
                if (!is_line(r) && c < rows_[r].size()) visit(rows_[r][c]);
        };
        if (columns_[c].align == Align::decimal_point)
            each_cell([&](const std::string& cell) { whole[c] = std::max(whole[c], whole_width(cell)); });
        width[c] = width_of(columns_[c].heading);
        each_cell([&](const std::string& cell) {
            const std::size_t shift = columns_[c].align == Align::left ? 0 : whole[c] - whole_width(cell);
            width[c] = std::max(width[c], shift + width_of(cell));
        });
    }
    std::string text;
    const auto end_line = [&] {
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    };
    const auto add_cell = [&](std::size_t c, const std::string& cell, std::size_t shift) {
        text += std::string(shift, ' ') + cell;
        const std::size_t used = shift + width_of(cell);
        text += std::string(width[c] - std::min(width[c], used) + 3, ' ');
    };
    text += "  ";
    for (std::size_t c = 0; c < columns_.size(); ++c) add_cell(c, columns_[c].heading, 0);
    end_line();
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        text += "  ";
        if (is_line(r)) text += rows_[r].front();
        for (std::size_t c = 0; !is_line(r) && c < rows_[r].size(); ++c) {
            const std::string& cell = rows_[r][c];
            add_cell(c, cell, columns_[c].align == Align::left ? 0 : whole[c] - whole_width(cell));
        }
        end_line();
    }
    return text;
}

}  // namespace achilles
