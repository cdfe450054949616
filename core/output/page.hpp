// Page layout: headings, sentences, formulas and matrices as plain text or LaTeX; tables for a terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "expression/notation.hpp"

namespace achilles {

// Text in both notations.
struct TextAndLatex {
    std::string text, latex;
};

// One element of a page, which can also be laid out by other code.
struct Block {
    enum class Kind { title, heading, caption, sentence, lines, formula, matrix } kind = Kind::sentence;
    TextAndLatex words;  // title: its two lines; formula or matrix: the left-hand side
    std::string right;   // formula: the right-hand side
    std::vector<std::vector<std::string>> rows{};
    int indent = 0;
};

class Page {
 public:
    // `width` is the maximum length of a formula on one line, in visible characters.
    Page(Notation notation, std::size_t width) : notation_(notation), width_(width) {}
    explicit Page(Notation notation) : Page(notation, notation == Notation::text ? 100 : 92) {}

    Notation notation() const { return notation_; }
    std::size_t width() const { return width_; }

    void title(const std::string& title, const std::string& source);
    void heading(const TextAndLatex& words);
    void heading(const std::string& words) { heading(TextAndLatex{words, words}); }
    void caption(const std::string& words);                         // describes the next formula
    void sentence(const TextAndLatex& words);                       // the LaTeX version is not escaped
    void lines(const std::vector<std::vector<std::string>>& rows);  // a table of plain text
    void formula(const TextAndLatex& left, const std::string& right, int indent = 0);
    void matrix(const TextAndLatex& left, const std::vector<std::vector<std::string>>& rows);

    const std::vector<Block>& blocks() const { return blocks_; }
    // The whole page as one text.
    std::string finish() const;

    // Plain text escaped for LaTeX.
    static std::string escaped(std::string_view words);

 private:
    Notation notation_;
    std::size_t width_;
    std::vector<Block> blocks_;
};

// Approximate number of visible characters of a formula: a LaTeX command counts as one, a brace as none.
std::size_t visible_length(std::string_view formula, Notation notation);

// Splits a formula before + and - signs into lines of at most `width` visible characters, if possible. Prefers signs
// outside brackets; never splits LaTeX arguments.
std::vector<std::string> wrap(const std::string& formula, std::size_t width, Notation notation);

// A table for a terminal: columns as wide as their widest cell, numbers aligned at the decimal point.

class TextTable {
 public:
    enum class Align { left, decimal_point };
    // Appends a column with its heading.
    void add_column(std::string heading, Align align);
    // Appends a row with one cell per column; it may be shorter.
    void add_row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    // Appends a line across all columns.
    void add_line(std::string text) { rows_.push_back({std::move(text)}), lines_.push_back(rows_.size() - 1); }
    // The table, each line indented by two spaces, without trailing spaces.
    std::string text() const;

 private:
    struct TextColumn {
        std::string heading;
        Align align = Align::left;
    };
    std::vector<TextColumn> columns_;
    std::vector<std::vector<std::string>> rows_;
    std::vector<std::size_t> lines_;  // indices of rows that are lines
};

// For more than ten rows, adds only the first four and the last four, with a line between them for the number of
// others.
template <class Row, class AddRow, class AddLine>
void add_first_and_last(const std::vector<Row>& rows, const AddRow& add_row, const AddLine& add_line) {
    constexpr std::size_t most = 10, kept = 4;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows.size() > most && i == kept) {
            add_line(rows.size() - 2 * kept);
            i = rows.size() - kept;
        }
        add_row(rows[i]);
    }
}

}  // namespace achilles
