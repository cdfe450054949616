// How formulas are written: as plain text that parse() reads back, or as LaTeX.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <span>
#include <string>
#include <string_view>

#include "expression/expression.hpp"

namespace achilles {

enum class Notation { text, latex };

// A written part and how tightly it holds together: sums and signs 1, products 2, factors that are no base 3, powers 4,
// atoms 5.
struct Written {
    std::string text;
    int binding = 5;
    std::string head;  // of a function in LaTeX: where its exponent goes; text = head + the rest
};

std::string inside(const Written& part, int least, Notation notation);  // in parentheses if it holds less tightly

Written write_number(const boost::multiprecision::cpp_rational& value, Notation notation);
Written write_name(std::string_view name, Notation notation);  // a symbol's, primes included
Written write_sum(const Written& a, bool minus, const Written& b, Notation notation);
Written write_negated(const Written& a, Notation notation);
Written write_product(const Written& a, const Written& b, Notation notation);
Written write_quotient(const Written& a, const Written& b, Notation notation);
Written write_power(const Written& base, int exponent, Notation notation);
Written write_real_power(const Written& base, const Written& exponent, Notation notation);
Written write_function(Operation function, const Written& argument, Notation notation);

// An expression as it stands; symbols are names[slot].
Written write(Expression expression, std::span<const std::string> names, Notation notation);

}  // namespace achilles
