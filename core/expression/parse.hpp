// Text to expression: the language of system files.
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

// What a name means where an expression stands. `allowed` maps a name, primes included ("x", "x'", "gap''"), to its
// expression; `forbidden` maps names (and units) that exist but may not stand here to the reason, a full sentence.
struct Scope {
    std::map<std::string, Expression, std::less<>> allowed;
    std::map<std::string, std::string, std::less<>> forbidden;
    std::map<std::string, Expression, std::less<>> units{};  // what may follow a value, as in 30 deg: a factor
    // What stands in a list, each by a whole number from 1 on in parentheses, as in zeno_time(2).
    std::map<std::string, std::function<Expression(int)>, std::less<>> listed{};
};

// What is wrong, and where: `offset` counts bytes from the start of the text.
struct ParseError : std::runtime_error {
    ParseError(std::size_t where, const std::string& message, std::string_view the_name = {},
               std::string_view what_would_be_right = {})
        : std::runtime_error(message), offset(where), name(the_name), hint(what_would_be_right) {}
    std::size_t offset;
    std::string name;  // primes included, where a name is unknown or may not stand here; else empty
    std::string hint;  // what would be right; may be empty
};

// Where the parts of a text stand.
struct TextPart {
    std::size_t offset, size;  // in bytes
    Expression value;
};
struct TextParts {
    std::vector<TextPart> terms;  // of the outermost sum or difference, without their signs
    std::vector<TextPart> all;    // every term, factor, base and exponent, in the order in which they end
};

// Reads one expression, and where its parts stand if `parts` is given. Throws ParseError with a message that names the
// offender and the nearest allowed name.
Expression parse(std::string_view text, const Scope& scope, Graph& graph, TextParts* parts = nullptr);

// Names a coordinate or parameter may not take: the functions, t, pi, gap, lambda, energy, work, loss, power, deg.
bool is_reserved(std::string_view name);
// The names in an expression, functions and units included, without their primes; each as often as it stands there.
std::vector<std::string> names_in(std::string_view text);
// A letter, then letters, digits, underscores.
bool is_name(std::string_view text);

// A number as a person gives it, in a file, on the command line, in a journal or typed into a field: a constant
// expression, 0.3, pi/6, 1/3, 30 deg. All of them are read here.
struct GivenNumber {
    double value = 0.0;     // finite
    bool has_unit = false;  // it says that it is in degrees or radians: 30 deg, 30°, 0.5 rad
    bool has_pi = false;
};

// Lets deg, ° and rad follow a value in an expression whose unit is rad or rad/s, and where it is rad/s deg/s, °/s and rad/s.
void allow_units(Scope& scope, std::string_view unit, Graph& graph);
// Whether a text is an expression in names that stand for something else than a number, as "m*L^2/12".
bool has_names(std::string_view text);

// Reads the whole text. deg, ° (both pi/180) and rad (1) may follow a value where `unit`, that of the quantity, is rad; the same
// and deg/s, °/s and rad/s where it is rad/s.
// Throws ParseError, whose message begins with the text: "'0,4' is not a finite number: ...".
GivenNumber read_number(std::string_view text, std::string_view unit = {});

}  // namespace achilles
