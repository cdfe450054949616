// The derived equations of a system: the output of `achilles check` as text or LaTeX, and the same as a sheet of
// formulas.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "check/finite_differences.hpp"
#include "expression/notation.hpp"
#include "model/model.hpp"
#include "output/page.hpp"

namespace achilles {

class SimplifiedEquations;

// The full report: simplifies the equations, compares them with differences of L, and formats them. `deriving`, the
// time to derive the model (s), is the only number that differs between runs. `disagreement` returns the largest
// difference.
std::string check_report(const Model& model, const Run& run, double deriving, Notation notation, double& disagreement);
std::string check_report(const Model& model, const Run& run, double deriving, Notation notation,
                         const SimplifiedEquations& simplified, const MaxDifference& disagreement);

// The default output, at most a page for a small system: whether the derived equations agree with differences of L,
// when impacts end in a Zeno point, and the equations of motion. check_report() has all details.
std::string check_answer(const Model& model, const Run& run, double& disagreement);
std::string check_answer(const Model& model, const Run& run, const SimplifiedEquations& simplified,
                         const MaxDifference& disagreement);

// A larger difference is an error in the derivation: with 50 digits and steps of 1e-11, less than 1e-15 remains for a
// sufficiently smooth system.
constexpr double max_disagreement = 1e-9;

// The equations of `achilles check` for callers with their own layout: the same formulas in LaTeX, each below words
// that name it, and the Zeno conditions as programs.

// A Zeno condition: impacts of the contact in this mode end at a Zeno point where the value of `decisive` is negative.
struct SheetCondition {
    std::size_t contact = 0;
    Mode mode;
    std::size_t first = 0, last = 0;  // its blocks: first <= i < last
    Program decisive;                 // factors of hddot on the surface that determine its sign
    bool depends = true;              // false: the sign is the same everywhere
};

struct EquationSheet {
    std::vector<Block> blocks;
    std::vector<SheetCondition> conditions;
    // The LaTeX of each name in the formulas: coordinates, rates, parameters, t.
    struct Symbol {
        std::string latex, name;
    };
    std::vector<Symbol> symbols;
};

// M, bias and forces; for each contact h, dh, hdot, hddot, lambda and the conditions. Simplification takes a hundredth
// of a second for two links, and seconds for a robot with several contacts. Signs hold over the ranges of the
// parameters and the values of the run. After a stop request it returns soon, with an incomplete result.
EquationSheet equation_sheet(const Model& model, const Run& run, std::stop_token stop = {});

// What the reader understood of a mechanism, as put_mechanism() prints it; no blocks for a system typed as energies without
// friction.
// Takes milliseconds.
EquationSheet mechanism_sheet(const Model& model, const Run& run);

}  // namespace achilles
