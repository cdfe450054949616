#include "output/page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/wrap.hpp"

namespace achilles {

namespace {

// How many characters a UTF-8 text shows.
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

// The text of a page, block by block.
class Writing {
 public:
    explicit Writing(const Page& page) : notation_(page.notation()), width_(page.width()) {}

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

    void sentence(const Both& words) {
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

    void formula(const Both& left, const std::string& right, int indent) {
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

    void matrix(const Both& left, const std::vector<std::vector<std::string>>& rows) {
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

void Page::heading(const Both& words) { blocks_.push_back({Block::Kind::heading, words, {}}); }

void Page::caption(const std::string& words) { blocks_.push_back({Block::Kind::caption, {words, escaped(words)}, {}}); }

void Page::sentence(const Both& words) { blocks_.push_back({Block::Kind::sentence, words, {}}); }

void Page::lines(const std::vector<std::vector<std::string>>& rows) {
    blocks_.push_back({Block::Kind::lines, {}, {}, rows});
}

void Page::formula(const Both& left, const std::string& right, int indent) {
    blocks_.push_back({Block::Kind::formula, left, right, {}, indent});
}

void Page::matrix(const Both& left, const std::vector<std::vector<std::string>>& rows) {
    blocks_.push_back({Block::Kind::matrix, left, {}, rows});
}

std::string Page::finish() const {
    Writing writing(*this);
    for (const Block& block : blocks_) writing.write(block);
    return writing.finish();
}

}  // namespace achilles
