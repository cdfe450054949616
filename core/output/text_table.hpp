// A table for a terminal: columns as wide as their widest cell, numbers aligned at the decimal point.
#pragma once

#include <string>
#include <vector>

namespace achilles {

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
