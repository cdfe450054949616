// Formatting of formulas, as plain text that parse() can read or as LaTeX.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <span>
#include <string>
#include <string_view>

#include "expression/expression.hpp"

namespace achilles {

enum class Notation { text, latex };

// A formatted term and its binding strength: sums and signs 1, products 2, factors that cannot be a base 3, powers 4,
// atoms 5.
struct Written {
    std::string text;
    int binding = 5;
    std::string head;  // LaTeX functions: the part before the exponent; text = head + the rest
};

std::string inside(const Written& part, int least, Notation notation);  // in parentheses if it binds less tightly

Written write_number(const boost::multiprecision::cpp_rational& value, Notation notation);
Written write_name(std::string_view name, Notation notation);  // a symbol's name, including primes
Written write_sum(const Written& a, bool minus, const Written& b, Notation notation);
Written write_negated(const Written& a, Notation notation);
Written write_product(const Written& a, const Written& b, Notation notation);
Written write_quotient(const Written& a, const Written& b, Notation notation);
Written write_power(const Written& base, int exponent, Notation notation);
Written write_real_power(const Written& base, const Written& exponent, Notation notation);
Written write_function(Operation function, const Written& argument, Notation notation);

// Formats an expression without simplifying it; symbols are names[slot].
Written write(Expression expression, std::span<const std::string> names, Notation notation);

}  // namespace achilles
