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
struct FormattedTerm {
    std::string text;
    int binding = 5;
    std::string head;  // LaTeX functions: the part before the exponent; text = head + the rest
};

std::string inside(const FormattedTerm& part, int least, Notation notation);  // in parentheses if it binds less tightly

FormattedTerm write_number(const boost::multiprecision::cpp_rational& value, Notation notation);
FormattedTerm write_name(std::string_view name, Notation notation);  // a symbol's name, including primes
FormattedTerm write_sum(const FormattedTerm& a, bool minus, const FormattedTerm& b, Notation notation);
FormattedTerm write_negated(const FormattedTerm& a, Notation notation);
FormattedTerm write_product(const FormattedTerm& a, const FormattedTerm& b, Notation notation);
FormattedTerm write_quotient(const FormattedTerm& a, const FormattedTerm& b, Notation notation);
FormattedTerm write_power(const FormattedTerm& base, int exponent, Notation notation);
FormattedTerm write_real_power(const FormattedTerm& base, const FormattedTerm& exponent, Notation notation);
FormattedTerm write_function(Operation function, const FormattedTerm& argument, Notation notation);

// Formats an expression without simplifying it; symbols are names[slot].
FormattedTerm write(Expression expression, std::span<const std::string> names, Notation notation);

}  // namespace achilles
