// Where the coordinates of a set of states stand (theory-enclosure.md 1): the member's own time, q, v, of every contact its gap h
// and the rate u of that once more, and the parameters that are intervals.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "enclose/doubleton.hpp"
#include "expression/scalar.hpp"

namespace achilles {

// A number with its derivatives by one direction at least: Jet<Number, 0> has none.
template <class Number>
inline constexpr bool has_directions = [] {
    if constexpr (HasDerivatives<Number>)
        return std::tuple_size_v<decltype(Number::slope)> > 0;
    else
        return false;
}();

struct Coordinates {
    std::size_t dof = 0;
    bool autonomous = true;
    Intervals parameters;             // all of the system's: those that are no coordinates are the same for all members
    std::vector<std::size_t> varied;  // of them, which are coordinates
    std::size_t contacts = 1;

    static constexpr std::size_t t() { return 0; }
    std::size_t q(std::size_t i) const { return 1 + i; }
    std::size_t v(std::size_t i) const { return 1 + dof + i; }
    std::size_t h(std::size_t contact = 0) const { return 1 + 2 * dof + 2 * contact; }
    std::size_t u(std::size_t contact = 0) const { return 2 + 2 * dof + 2 * contact; }
    std::size_t parameter(std::size_t k) const { return 1 + 2 * dof + 2 * contacts + k; }
    std::size_t size() const { return parameter(varied.size()); }

    // The coordinates that the accelerations depend on, and those that maps do: h and u besides.
    std::vector<std::size_t> of_motion() const {
        std::vector<std::size_t> result;
        for (std::size_t i = 0; i < 2 * dof; ++i) result.push_back(q(i));
        if (!autonomous) result.push_back(t());
        for (std::size_t k = 0; k < varied.size(); ++k) result.push_back(parameter(k));
        return result;
    }
    std::vector<std::size_t> of_maps() const {
        std::vector<std::size_t> result = of_motion();
        for (std::size_t i = 0; i < contacts; ++i) result.insert(result.end(), {h(i), u(i)});
        return result;
    }
    // The coordinates of a box as numbers with derivatives by these variables; all of the system's parameters likewise.
    template <class Number>
    std::vector<Number> numbers(const Intervals& box, const std::vector<std::size_t>& variables) const {
        std::vector<Number> result;
        for (const Interval& entry : box) result.emplace_back(entry);
        mark(result, variables);
        return result;
    }
    template <class Number>
    std::vector<Number> parameter_numbers(const std::vector<Number>& state) const {
        std::vector<Number> result;
        for (const Interval& value : parameters) result.emplace_back(value);
        for (std::size_t k = 0; k < varied.size(); ++k) result[varied[k]] = state[parameter(k)];
        return result;
    }

 private:
    template <class Number>
    static void mark(std::vector<Number>& state, const std::vector<std::size_t>& variables) {
        if constexpr (has_directions<Number>)
            for (std::size_t j = 0; j < variables.size(); ++j)
                state[variables[j]] = Number::variable(state[variables[j]].value, j);
    }
};

// Makes maker.template operator()<N>() for the least N that holds so many directions. Throws Undecided for too many.
template <class Maker>
auto with_directions(std::size_t count, const Maker& maker) {
    if (count <= 4) return maker.template operator()<4>();
    if (count <= 6) return maker.template operator()<6>();
    if (count <= 8) return maker.template operator()<8>();
    if (count <= 12) return maker.template operator()<12>();
    if (count <= 18) return maker.template operator()<18>();
    if (count <= 26) return maker.template operator()<26>();
    throw Undecided{"too many coordinates and interval parameters for a proof (maximum 26)"};
}

}  // namespace achilles
