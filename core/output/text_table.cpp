#include "output/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace achilles {

namespace {

// Characters that a terminal shows: bytes of UTF-8 that begin one.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

// The characters before the decimal point, or all of a text without one.
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
