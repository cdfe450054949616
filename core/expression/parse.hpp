// Parser for the expressions of system files:
//   + - * / ^ (right-associative, above unary minus), parentheses, functions, pi, decimal numbers, names, x' for rates.
#pragma once

#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "expression/expression.hpp"

namespace achilles {

// The names that an expression may use. `allowed` maps a name, including primes ("x", "x'", "gap''"), to its
// expression. `forbidden` maps names and units that exist but are not allowed here to the reason, a full sentence.
struct Scope {
    std::map<std::string, Expression, std::less<>> allowed;
    std::map<std::string, std::string, std::less<>> forbidden;
    std::map<std::string, Expression, std::less<>> units{};  // factors of units after a value, as in 30 deg
    // Quantities with an index from 1 in parentheses, as in zeno_time(2).
    std::map<std::string, std::function<Expression(int)>, std::less<>> listed{};
    // Quantities of a contact, with its name in parentheses, as in held(foot).
    std::map<std::string, std::map<std::string, Expression, std::less<>>, std::less<>> of_contact{};
};

// A syntax error; `offset` counts bytes from the start of the text.
struct ParseError : std::runtime_error {
    ParseError(std::size_t where, const std::string& message, std::string_view the_name = {},
               std::string_view what_would_be_right = {})
        : std::runtime_error(message), offset(where), name(the_name), hint(what_would_be_right) {}
    std::size_t offset;
    std::string name;  // the name with primes, if it is unknown or not allowed here; else empty
    std::string hint;  // a suggested correction; may be empty
};

// Positions of the parts of a text.
struct TextPart {
    std::size_t offset, size;  // in bytes
    Expression value;
};
struct TextParts {
    std::vector<TextPart> terms;  // of the outermost sum or difference, without their signs
    std::vector<TextPart> all;    // every term, factor, base and exponent, ordered by their ends
};

// Parses one expression. If `parts` is given, also records the positions of its parts. Throws ParseError with a message
// that shows the offending text and the nearest allowed name.
Expression parse(std::string_view text, const Scope& scope, Graph& graph, TextParts* parts = nullptr);

// Reserved names, which coordinates and parameters cannot have: the functions, t, pi, gap, lambda, energy, work, loss,
// power, deg.
bool is_reserved(std::string_view name);
// The names in an expression, including functions and units, without primes. Repeated names are listed repeatedly.
std::vector<std::string> names_in(std::string_view text);
// True for a letter followed by letters, digits or underscores.
bool is_name(std::string_view text);

// A number as entered in a file, on the command line, in a journal or in a field: a constant expression such as 0.3,
// pi/6, 1/3 or 30 deg.
struct ParsedNumber {
    double value = 0.0;     // finite
    bool has_unit = false;  // written with a unit of angle: 30 deg, 30°, 0.5 rad
    bool has_pi = false;
};

// Allows units after a value: deg, ° and rad if `unit` is rad or rad/s, and also deg/s, °/s and rad/s if it is rad/s.
void allow_units(Scope& scope, std::string_view unit, Graph& graph);
// True if the text is an expression with names that are not constants, such as "m*L^2/12".
bool has_names(std::string_view text);

// Parses the whole text as a number. `unit` is the unit of the quantity. If it is rad, deg, ° (both pi/180) and rad (1)
// may follow a value; if it is rad/s, also deg/s, °/s and rad/s. Throws ParseError, whose message begins with the text:
// "'0,4' is not a finite number: ...".
ParsedNumber read_number(std::string_view text, std::string_view unit = {});

}  // namespace achilles
