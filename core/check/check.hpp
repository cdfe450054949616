// A system and its derived equations: what `achilles check` says, as text or as a LaTeX document, and the same as a sheet of
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

class Simplified;

// Simplifies, compares with differences of L, and writes. `deriving` is what it took to derive the model, in seconds:
// the only thing that differs from run to run. The largest disagreement goes to `disagreement`.
std::string check_report(const Model& model, const Run& run, double deriving, Notation notation, double& disagreement);

// The default output, at most a page for a small system: whether the derived equations agree with differences of L, when
// impacts end in a Zeno point, and the equations of motion. check_report() has everything.
std::string check_answer(const Model& model, const Run& run, double& disagreement);
std::string check_answer(const Model& model, const Run& run, const Simplified& simplified,
                         const Disagreement& disagreement);

// More than this is a mistake in the derivation: 50 digits and steps of 1e-11 leave less than 1e-15 where the system is as
// smooth as it should be.
constexpr double most_disagreement = 1e-9;

// The equations that `achilles check` says, for whoever sets them himself: the same formulas, in LaTeX, each under
// words that name it, and the Zeno conditions as programs.

// A Zeno condition that was found: bouncing of the contact, while others are held, ends at a Zeno point where the value
// is negative.
struct SheetCondition {
    std::size_t contact = 0;
    Mode mode;
    std::size_t first = 0, last = 0;  // its blocks: first <= i < last
    Program decisive;                 // of hddot on the surface: what its sign depends on
    bool depends = true;              // the sign is not the same everywhere
};

struct EquationSheet {
    std::vector<Block> blocks;
    std::vector<SheetCondition> conditions;
    // How the formulas write each name that may stand in them: coordinates, rates, parameters, t.
    struct Symbol {
        std::string latex, name;
    };
    std::vector<Symbol> symbols;
};

// M, bias and forces; of each contact h, dh, hdot, hddot, lambda and the conditions. Simplifies: a hundredth of a
// second for two links, seconds for a robot with several contacts. Signs are taken over the parameters' ranges and the
// run's values. Told to stop, it returns soon, whatever it has.
EquationSheet equation_sheet(const Model& model, const Run& run, std::stop_token stop = {});

}  // namespace achilles
