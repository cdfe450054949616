// Text laid out: headings, sentences, formulas and matrices on a page of plain text or of LaTeX; tables for a terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "expression/notation.hpp"

namespace achilles {

// A word or name in both notations.
struct Both {
    std::string text, latex;
};

// A piece of a page, for whoever sets it in another way.
struct Block {
    enum class Kind { title, heading, caption, sentence, lines, formula, matrix } kind = Kind::sentence;
    Both words;         // of a title its two lines, of a formula or a matrix the left hand side
    std::string right;  // of a formula
    std::vector<std::vector<std::string>> rows{};
    int indent = 0;
};

class Page {
 public:
    // What a formula may take on a line, in visible characters.
    Page(Notation notation, std::size_t width) : notation_(notation), width_(width) {}
    explicit Page(Notation notation) : Page(notation, notation == Notation::text ? 100 : 92) {}

    Notation notation() const { return notation_; }
    std::size_t width() const { return width_; }

    void title(const std::string& title, const std::string& source);
    void heading(const Both& words);
    void heading(const std::string& words) { heading(Both{words, words}); }
    void caption(const std::string& words);                         // what the next formula is
    void sentence(const Both& words);                               // in LaTeX as it is
    void lines(const std::vector<std::vector<std::string>>& rows);  // a table of plain words
    void formula(const Both& left, const std::string& right, int indent = 0);
    void matrix(const Both& left, const std::vector<std::vector<std::string>>& rows);

    const std::vector<Block>& blocks() const { return blocks_; }
    // All of it as one text.
    std::string finish() const;

    // Plain words for LaTeX.
    static std::string escaped(std::string_view words);

 private:
    Notation notation_;
    std::size_t width_;
    std::vector<Block> blocks_;
};

// About how many characters a formula shows: LaTeX commands count as one, braces as none.
std::size_t visible_length(std::string_view formula, Notation notation);

// The formula cut before the signs of sums into lines of at most `width` visible characters where that can be: outside
// brackets first, inside where it must, never inside LaTeX arguments.
std::vector<std::string> wrap(const std::string& formula, std::size_t width, Notation notation);

// A table for a terminal: columns as wide as their widest cell, numbers aligned at the decimal point.

class TextTable {
 public:
    enum class Align { left, decimal_point };
    // Columns from left to right, with their headings.
    void add_column(std::string heading, Align align);
    // One cell per column; a row may be shorter.
    void add_row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    // A line across all columns.
    void add_line(std::string text) { rows_.push_back({std::move(text)}), lines_.push_back(rows_.size() - 1); }
    // Every line indented by two spaces, without trailing spaces.
    std::string text() const;

 private:
    struct Column {
        std::string heading;
        Align align = Align::left;
    };
    std::vector<Column> columns_;
    std::vector<std::vector<std::string>> rows_;
    std::vector<std::size_t> lines_;  // indices of rows that are one line
};

// Keeps the first and last four rows of more than ten, with a line in between that counts the others.
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
