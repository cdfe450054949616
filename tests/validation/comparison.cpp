#include "validation/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "app/program.hpp"

namespace achilles::validation {

namespace {

// Significant digits of a decimal number; trailing zeros count.
int significant_digits(std::string_view number) {
    int digits = 0;
    bool leading = true;
    for (const char c : number) {
        if (c == 'e' || c == 'E') break;
        if (c < '0' || c > '9') continue;
        leading = leading && c == '0';
        if (!leading) ++digits;
    }
    return digits;
}

double number_of(std::string_view text) {
    const std::string whole(text);
    std::size_t end = 0;
    const double value = std::stod(whole, &end);
    if (end != whole.size()) throw std::invalid_argument("not a number: " + whole);
    return value;
}

std::vector<std::vector<std::string>> table_of(const std::string& csv) {
    std::vector<std::vector<std::string>> table;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        table.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) table.back().push_back(cell);
    }
    return table;
}

std::string table_of(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths(rows[0].size(), 3);
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        text += "|";
        for (std::size_t i = 0; i < rows[k].size(); ++i) text += fmt::format(" {:<{}} |", rows[k][i], widths[i]);
        text += "\n";
        if (k > 0) continue;
        text += "|";
        for (const std::size_t width : widths) text += std::string(width + 2, '-') + "|";
        text += "\n";
    }
    return text;
}

constexpr std::string_view introduction = R"(# Published numbers, side by side

Each table compares numbers of the literature, closed forms, and independent computations with the output of the command above
it. A program of the tests runs the commands and writes this page, and the tests fail where the page and the results differ.
The numbers of the paper that Achilles implements are in `achilles help paper`.

A number agrees in n digits if it differs by at most one unit of the n-th. No more digits are compared than every processor
gives. "Extrapolation" is an independent program in 113 bits whose steps are extrapolated to order 22. Where a command follows a
branch, `--out branch.svg` draws it.
)";

}  // namespace

Agreement compare(std::string_view reference, double value, int digits) {
    const double wanted = number_of(reference), difference = std::abs(value - wanted);
    const int printed = significant_digits(reference), compared = std::min(printed, digits);
    if (compared == 0) throw std::invalid_argument("a reference of 0 has no digits to compare");
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(wanted))) - compared + 1.0);
    constexpr double rounding = 1e-15;
    if (difference <= unit + rounding * std::abs(wanted))
        return {true,
                compared == printed ? fmt::format("all {} digits", compared) : fmt::format("{} digits", compared)};
    return {false, fmt::format("differs by {:.2g}", difference)};
}

const Output& output_of(const std::string& arguments) {
    static std::map<std::string, Output> outputs;
    const auto known = outputs.find(arguments);
    if (known != outputs.end()) return known->second;
    const test::Folder folder;
    const test::Answer answer = folder.run(arguments);
    const bool is_table = arguments.find("--csv") != std::string::npos;
    Output output;
    if (is_table)
        output.table = table_of(answer.out);
    else
        output.json = nlohmann::json::parse(answer.out, nullptr, false);
    if (is_table ? output.table.size() < 2 : output.json.is_discarded())
        throw std::runtime_error(fmt::format("achilles {}: status {}\n{}", arguments, answer.status, answer.err));
    return outputs.emplace(arguments, std::move(output)).first->second;
}

std::string page() {
    std::string text(introduction);
    for (const Topic& topic : topics()) {
        text += fmt::format("\n## {}\n\n{}\n", topic.title, topic.source);
        for (const Command& command : topic.commands) {
            std::vector<std::vector<std::string>> rows{{"quantity", "source", "reference", "Achilles", "agreement"}};
            std::string reasons;
            for (const Row& row : command.rows) {
                const double value = row.value(output_of(command.arguments));
                const Agreement agreement = compare(row.reference, value, row.digits);
                rows.push_back({row.quantity, row.place, row.reference, fmt::format("{:.{}g}", value, row.digits),
                                agreement.text});
                if (reasons.find(row.reason) == std::string::npos) reasons += "\n" + row.reason + "\n";
            }
            text += fmt::format("\n    achilles {}\n\n{}{}", command.arguments, table_of(rows), reasons);
        }
    }
    return text;
}

}  // namespace achilles::validation
