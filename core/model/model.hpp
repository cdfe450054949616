// What the machine evaluates: the equations of motion of one system, derived symbolically once (THEORY section 1).
//
//     M(q) a + b(q,v) = 0                      free motion,  f = -M^-1 b
//     g = dh,  W = g M^-1 g',  n = M^-1 g'/W    normal direction, g n = 1
//     hddot = v'Hv + g f                        normal acceleration of the free motion
//     lambda = -hddot/W,  f_c = f - n hddot     contact force, constrained acceleration
//     s = v - n hdot                            tangential velocity: impacts do not change it
//
// Input slots of every program: q (n), v (n), the parameters (p), then t, contact (1 in contact, 0 in flight) and sigma.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "expression/parse.hpp"
#include "expression/program.hpp"
#include "model/description.hpp"

namespace achilles {

// Where each input of a program stands.
struct Layout {
    std::uint32_t n = 0, p = 0;  // coordinates, parameters
    std::uint32_t q(std::size_t i) const { return static_cast<std::uint32_t>(i); }
    std::uint32_t v(std::size_t i) const { return n + static_cast<std::uint32_t>(i); }
    std::uint32_t parameter(std::size_t i) const { return 2 * n + static_cast<std::uint32_t>(i); }
    std::uint32_t t() const { return 2 * n + p; }
    std::uint32_t contact() const { return 2 * n + p + 1; }
    std::uint32_t sigma() const { return 2 * n + p + 2; }  // stands for hdot where v = s + n sigma
    std::uint32_t own() const { return 2 * n + p + 3; }    // a drawn curve's own parameter
    Slots slots() const { return {2 * n + p + 4, 2 * n, 2 * n + p}; }
};

// The derived equations, as expressions. Vectors have n entries; M and H are full, row by row.
struct Equations {
    std::vector<Expression> M, bias, f, g, H, n, s, f_c;
    Expression kinetic, potential, gap, restitution;
    Expression W, hdot, hddot, lambda, energy;
    Expression jerk;     // h''': the rate of hddot along the constrained motion
    std::vector<Expression> pivots;  // of M = L D L': all positive exactly where M is positive definite
};

class Model {
 public:
    // Derives everything. Throws InputError (the file's) for a text that is not what it should be.
    explicit Model(SystemDescription description);

    const SystemDescription& description() const { return description_; }
    const Layout& layout() const { return layout_; }
    int n() const { return static_cast<int>(layout_.n); }
    const Equations& equations() const { return equations_; }
    std::span<const std::string> slot_names() const { return slot_names_; }

    // Programs, compiled once; their outputs in order.
    const Program& flight() const { return flight_; }    // f (n), hddot, pivots (n)
    const Program& contact() const { return contact_; }  // f_c (n), hddot, jerk, h, hdot, n (n), pivots (n)
    const Program& surface() const { return surface_; }  // h, hdot, n (n), g (n), W
    const Program& bounds() const { return bounds_; }    // hddot, n (n), f (n): what Def. 7 needs over a box
    const Program& energy() const { return energy_; }    // T + V, and the rounding scale |T| + |V|
    const Program& restitution() const { return restitution_; }

    // The run that the description asks for.
    Run default_run() const;
    // Throws InputError if the run cannot start: start not finite, restitution outside [0,1], M not positive definite,
    // gap clearly negative, eps or tolerance not positive.
    void check(const Run& run) const;

    // Programs for what a view or a drawing says, over t, coordinates, rates, parameters, gap, gap', gap'', lambda, energy
    // (view) or over coordinates and parameters, plus a curve's own parameter (drawing). Throw InputError.
    Program compile_view(std::span<const Text> texts) const;
    Program compile_drawing(std::span<const Text> texts, const std::string& own = {}) const;

 private:
    SystemDescription description_;
    Layout layout_;
    std::unique_ptr<Graph> graph_;
    Equations equations_;
    std::vector<std::string> slot_names_;
    Program flight_, contact_, surface_, bounds_, energy_, restitution_;
};

}  // namespace achilles
