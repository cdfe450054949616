// Formats simplified expressions in the usual order: common factors before brackets, parameters before coordinates
// before rates before functions. For the files of this library only: see multinomial.hpp.
#pragma once

#include <string>
#include <vector>

#include "algebra/algebra.hpp"
#include "expression/notation.hpp"

namespace achilles {

class AlgebraWriter {
 public:
    // `names` and `ranks` are indexed by slot. Symbols of lower rank come first in a product. Sums start with the terms
    // of the highest degree in symbols of the highest rank.
    AlgebraWriter(const Algebra& algebra, std::span<const std::string> names, std::span<const int> ranks,
                  Notation notation);

    FormattedTerm write(const Multinomial& polynomial) const;
    // A polynomial over a number becomes a sum with fractional coefficients, anything else a quotient of products.
    FormattedTerm write(const Fraction& fraction, Algebra& algebra) const;
    FormattedTerm write(const FactoredForm& factored) const;

 private:
    using Rational = boost::multiprecision::cpp_rational;
    struct SumTerm {  // a term of a sum
        Rational number;
        Monomial powers;
    };
    struct Piece {  // one term of a formatted sum, or several terms with their common factor
        bool negative = false;
        FormattedTerm written;
    };
    void gather_sines(std::vector<SumTerm>& items, const Algebra& algebra) const;
    FormattedTerm sum(std::vector<SumTerm> items) const;
    std::vector<std::size_t> next_group(const std::vector<SumTerm>& items, const std::vector<std::size_t>& left) const;
    FormattedTerm product(const Rational& number, const Monomial& powers, const FormattedTerm* bracket) const;
    Piece collected(std::vector<SumTerm> items, const Monomial& shared) const;
    int degree_of_highest(const Monomial& powers) const;
    bool before(const SumTerm& a, const SumTerm& b) const;

    Notation notation_;
    std::vector<FormattedTerm> written_;  // by atom
    std::vector<std::size_t> order_;      // atoms in the order of a product
    std::vector<bool> highest_;           // by atom: is it a symbol of the highest rank?
};

}  // namespace achilles
