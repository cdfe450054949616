// Numbers of the literature beside those of the program: each row of the manual's page `validation` compares a reference
// with a number in the output of a command.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace achilles::validation {

// What a command printed: JSON, or a table as CSV.
struct Output {
    nlohmann::json json;
    std::vector<std::vector<std::string>> table;
};

struct Row {
    std::string quantity;   // with its unit
    std::string place;      // in the publication, or how the reference was computed
    std::string reference;  // as printed there
    std::function<double(const Output&)> value;
    int digits = 11;       // significant digits that every processor gives
    std::string reason{};  // why the numbers differ; empty: they agree in all digits that are compared
};

struct Command {
    std::string arguments;  // after `achilles`, in shell syntax
    std::vector<Row> rows;
};

struct Topic {
    std::string title;
    std::string source;
    std::vector<Command> commands;
};

// The comparisons of the page, in its order.
std::vector<Topic> topics();

// How far a number agrees with a reference.
struct Agreement {
    bool agrees = false;  // within one unit of the last digit that is compared
    std::string text;     // "all 5 digits", "11 digits" or "differs by 0.021"
};
// Compares the leading digits of a reference as it is printed, at most `digits` of them. Throws std::invalid_argument if
// it is not a decimal number.
Agreement compare(std::string_view reference, double value, int digits);

// Runs the command in a temporary folder; each command only once. Throws std::runtime_error if it fails.
const Output& output_of(const std::string& arguments);

// The page of the manual.
std::string page();

}  // namespace achilles::validation
