// Tables for a terminal.
#include "output/page.hpp"

#include <gtest/gtest.h>

namespace achilles {
namespace {

TEST(TextTable, AlignsNumbersAtTheirPoints) {
    TextTable table;
    table.add_column("t (s)", TextTable::Align::decimal_point);
    table.add_column("event", TextTable::Align::left);
    table.add_column("", TextTable::Align::left);
    table.add_row({"0", "start", "free flight"});
    table.add_row({"12.25", "end", ""});
    table.add_row({"-1.5"});
    EXPECT_EQ(table.text(),
              "  t (s)   event\n"
              "   0      start   free flight\n"
              "  12.25   end\n"
              "  -1.5\n");
}

TEST(TextTable, HasLinesAcrossAllColumns) {
    TextTable table;
    table.add_column("a", TextTable::Align::left);
    table.add_row({"1"});
    table.add_line("... 5 more events");
    EXPECT_EQ(table.text(), "  a\n  1\n  ... 5 more events\n");
}

TEST(TextTable, KeepsTheFirstAndTheLastRows) {
    const auto shown = [](int count) {
        std::vector<int> rows;
        for (int i = 0; i < count; ++i) rows.push_back(i);
        std::string text;
        add_first_and_last(
            rows, [&](int row) { text += std::to_string(row) + " "; },
            [&](std::size_t left) { text += "(" + std::to_string(left) + ") "; });
        return text;
    };
    EXPECT_EQ(shown(10), "0 1 2 3 4 5 6 7 8 9 ");
    EXPECT_EQ(shown(11), "0 1 2 3 (3) 7 8 9 10 ");
}

}  // namespace
}  // namespace achilles
