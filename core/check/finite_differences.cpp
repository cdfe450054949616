#include "check/finite_differences.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <random>

#include "check/simplified.hpp"
#include "model/scopes.hpp"

namespace achilles {

namespace {

namespace mp = boost::multiprecision;
using Real = mp::number<mp::backends::cpp_bin_float<50>, mp::et_off>;
using Reals = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

// Solves A X = B for a square A by elimination with row pivots. No number of X is finite if a pivot is not larger than
// `least`. Eigen's decompositions and products of this type would take a third of the time that this room takes to
// compile.
Matrix solution(Matrix A, Matrix X, const Real& least = 0) {
    const Eigen::Index n = A.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
        Eigen::Index pivot = k;
        for (Eigen::Index i = k + 1; i < n; ++i)
            if (abs(A(i, k)) > abs(A(pivot, k))) pivot = i;
        if (!(abs(A(pivot, k)) > least)) return Matrix::Constant(n, X.cols(), std::numeric_limits<Real>::quiet_NaN());
        A.row(k).swap(A.row(pivot));
        X.row(k).swap(X.row(pivot));
        for (Eigen::Index i = k + 1; i < n; ++i) {
            const Real factor = A(i, k) / A(k, k);
            A.row(i) -= factor * A.row(k);
            X.row(i) -= factor * X.row(k);
        }
    }
    for (Eigen::Index k = n; k-- > 0;) {
        for (Eigen::Index i = k + 1; i < n; ++i) X.row(k) -= A(k, i) * X.row(i);
        X.row(k) /= A(k, k);
    }
    return X;
}

struct PreciseState {
    Reals q, v;
    Real t;
};

// Evaluates expressions of one graph as functions of the state.
class Functions {
 public:
    Functions(const Model& model, const Run& run, const std::vector<Expression>& outputs)
        : dof_(model.layout().dof), program_(outputs, model.layout().slots()) {
        evaluator_ = model.evaluator<Real>(program_, run.parameters);
    }
    Functions(const Functions&) = delete;

    Reals operator()(const PreciseState& at) {
        for (std::size_t i = 0; i < dof_; ++i) {
            evaluator_.input(i) = at.q[static_cast<Eigen::Index>(i)];
            evaluator_.input(dof_ + i) = at.v[static_cast<Eigen::Index>(i)];
        }
        evaluator_.clock() = at.t;
        evaluator_.run();
        Reals values(static_cast<Eigen::Index>(program_.output_count()));
        for (std::size_t i = 0; i < program_.output_count(); ++i)
            values[static_cast<Eigen::Index>(i)] = evaluator_.output(i);
        return values;
    }

 private:
    std::size_t dof_;
    Program program_;
    Evaluator<Real> evaluator_;
};

const Real step("1e-11");

// d f/dx_i at a point, where x is q or v of the point.
Real slope(const std::function<Real(const PreciseState&)>& f, const PreciseState& point, Reals PreciseState::*x,
           Eigen::Index i) {
    PreciseState at = point;
    const Real middle = (at.*x)[i];
    (at.*x)[i] = middle + step;
    const Real up = f(at);
    (at.*x)[i] = middle - step;
    return (up - f(at)) / (2 * step);
}

// The same derivative by the time.
Real slope_in_time(const std::function<Real(const PreciseState&)>& f, const PreciseState& point) {
    return (f({point.q, point.v, point.t + step}) - f({point.q, point.v, point.t - step})) / (2 * step);
}

// The expected equations from L, the forces and the gaps: d/dt dL/dv = dL/dq + force - dR/dv along the motion.
class Differences {
 public:
    Differences(const Model& model, const Run& run)
        : dof_(model.dof()),
          has_prescribed_motion_(model.equations().has_prescribed_motion()),
          lagrangian_(model, run, {model.equations().given.kinetic - model.equations().given.potential}),
          graph_(model.equations().energy.graph()),
          forces_(model, run, given_forces(model, graph_)),
          gaps_(model, run, model.equations().gaps),
          slips_(model, run, slips_of(model)) {
        for (const auto& [which, law] : model.equations().friction)
            if (!is_joint(which)) rough_.push_back(static_cast<Eigen::Index>(which));
    }

    // Returns M, bias and Q (with the forces of a prescribed motion), then dh, hdot, hddot and lambda of each contact.
    // Last comes hddot of each contact while one of the others is held, for each of the others in turn; with friction
    // it sticks.
    Reals operator()(const PreciseState& at) {
        const auto L = [&](const PreciseState& x) { return lagrangian_(x)[0]; };
        const auto R = [&](const PreciseState& x) { return forces_(x)[dof_]; };
        Matrix M(dof_, dof_);
        Reals b(dof_), Q = forces_(at).head(dof_);
        for (Eigen::Index i = 0; i < dof_; ++i) {
            const auto momentum = [&](const PreciseState& x) { return slope(L, x, &PreciseState::v, i); };
            b[i] = -slope(L, at, &PreciseState::q, i);
            Q[i] -= slope(R, at, &PreciseState::v, i);
            for (Eigen::Index j = 0; j < dof_; ++j) {
                M(i, j) = slope(momentum, at, &PreciseState::v, j);
                b[i] += slope(momentum, at, &PreciseState::q, j) * at.v[j];
            }
            if (has_prescribed_motion_) {
                b[i] += slope_in_time(momentum, at);
                const Real inertia = force_of_motion(at, i);
                b[i] += inertia;
                Q[i] += inertia;
            }
        }
        const Reals f = solution(M, Q - b), now = gaps_(at);
        // h along q + v t + f t^2/2
        const auto later = [&](const Real& t) {
            return PreciseState{at.q + at.v * t + f * (t * t / 2), at.v + f * t, at.t + t};
        };
        const Reals up = gaps_(later(step)), down = gaps_(later(-step));
        const Eigen::Index m = now.size();
        const Reals hddot = (up - 2 * now + down) / (step * step);
        Matrix G(m, dof_);
        for (Eigen::Index k = 0; k < m; ++k)
            for (Eigen::Index i = 0; i < dof_; ++i)
                G(k, i) = slope([&](const PreciseState& x) { return gaps_(x)[k]; }, at, &PreciseState::q, i);
        const Matrix rows = joined(G, at);
        // W has a row for each gap, then one for each slip. Without rows there is nothing to solve.
        Matrix W;
        if (rows.rows() > 0) W = rows.lazyProduct(solution(M, rows.transpose()));
        Reals accelerations(rows.rows());
        accelerations.head(m) = hddot;
        accelerations.tail(rows.rows() - m) = (slips_(later(step)) - slips_(later(-step))) / (2 * step);
        Reals all(dof_ * dof_ + 2 * dof_ + m * (dof_ + 3) + m * (m - 1));
        all.head(dof_ * dof_ + 2 * dof_) << M.reshaped(), b, Q;
        Eigen::Index next = dof_ * dof_ + 2 * dof_;
        for (Eigen::Index k = 0; k < m; ++k) {
            all.segment(next, dof_) = G.row(k).transpose();
            next += dof_;
            all[next++] = (up[k] - down[k]) / (2 * step);
            all[next++] = hddot[k];
            all[next++] = -hddot[k] / W(k, k);
        }
        for (Eigen::Index k = 0; k < m; ++k)
            for (Eigen::Index j = 0; j < m; ++j)
                if (j != k) all[next++] = while_kept(k, rows_of(j, m), W, accelerations);
        return all;
    }

 private:
    static std::vector<Expression> slips_of(const Model& model) {
        std::vector<Expression> slips;
        for (const auto& [which, law] : model.equations().friction)
            if (!is_joint(which)) slips.push_back(law.slip);
        return slips;
    }
    // The rows of all gaps, then those of the slips.
    Matrix joined(const Matrix& G, const PreciseState& at) {
        Matrix rows(G.rows() + static_cast<Eigen::Index>(rough_.size()), dof_);
        rows.topRows(G.rows()) = G;
        for (Eigen::Index k = G.rows(); k < rows.rows(); ++k)
            for (Eigen::Index i = 0; i < dof_; ++i)
                rows(k, i) =
                    slope([&](const PreciseState& x) { return slips_(x)[k - G.rows()]; }, at, &PreciseState::v, i);
        return rows;
    }
    // Those that a held contact keeps at acceleration 0.
    std::vector<Eigen::Index> rows_of(Eigen::Index contact, Eigen::Index gaps) const {
        std::vector<Eigen::Index> kept{contact};
        const auto found = std::find(rough_.begin(), rough_.end(), contact);
        if (found != rough_.end()) kept.push_back(gaps + (found - rough_.begin()));
        return kept;
    }
    // The acceleration of row k while forces along the rows `kept` keep theirs at 0.
    static Real while_kept(Eigen::Index k, const std::vector<Eigen::Index>& kept, const Matrix& W,
                           const Reals& accelerations) {
        const auto n = static_cast<Eigen::Index>(kept.size());
        Matrix A(n, n);
        Reals a(n), coupling(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const Eigen::Index row = kept[static_cast<std::size_t>(i)];
            for (Eigen::Index j = 0; j < n; ++j) A(i, j) = W(row, kept[static_cast<std::size_t>(j)]);
            a[i] = accelerations[row];
            coupling[i] = W(k, row);
        }
        const Reals forces = solution(A, a);
        return accelerations[k] - coupling.dot(forces);
    }
    // -dc_i/dt - sum_k (dc_i/dq_k - dc_k/dq_i) v_k, where c is dL/dv at v = 0.
    Real force_of_motion(const PreciseState& at, Eigen::Index i) {
        const auto c = [&](Eigen::Index k) {
            return [this, k](const PreciseState& x) {
                const auto L = [&](const PreciseState& y) { return lagrangian_(y)[0]; };
                return slope(L, {x.q, Reals(Reals::Zero(dof_)), x.t}, &PreciseState::v, k);
            };
        };
        Real force = -slope_in_time(c(i), at);
        for (Eigen::Index k = 0; k < dof_; ++k)
            force -= (slope(c(i), at, &PreciseState::q, k) - slope(c(k), at, &PreciseState::q, i)) * at.v[k];
        return force;
    }

    Eigen::Index dof_;
    bool has_prescribed_motion_;
    Functions lagrangian_;
    Graph graph_;
    Functions forces_, gaps_, slips_;
    std::vector<Eigen::Index> rough_;  // the contacts with friction, in the order of slips_
};

// Reproducible random numbers in [low, high].
class Random {
 public:
    Real between(const std::array<double, 2>& range) {
        const double unit = static_cast<double>(engine_() >> 11) * 0x1p-53;
        return range[0] + (range[1] - range[0]) * unit;
    }

 private:
    std::mt19937_64 engine_{4};
};

double distance(const Real& value, const Real& reference) {
    const Real size = abs(reference);
    return (abs(value - reference) / (size > 1 ? size : Real(1))).convert_to<double>();
}

bool is_finite(const Reals& values) {
    for (const Real& value : values)
        if (!isfinite(value)) return false;
    return true;
}

// Gaps, their rates, and their gradients dh as rows, for the projection to the contact surfaces.
class SurfacePoints {
 public:
    SurfacePoints(const Model& model, const Run& run, const std::vector<std::size_t>& contacts)
        : count_(static_cast<Eigen::Index>(contacts.size())), functions_(model, run, outputs(model, contacts)) {}

    // Projects a state to h = 0 by Newton's method and its rates to hdot = 0. Returns false if that fails.
    bool hold(PreciseState& at) {
        Reals values = functions_(at);
        for (int i = 0; i < 60 && is_finite(values); ++i, values = functions_(at)) {
            const Matrix G = values.tail(values.size() - 2 * count_).reshaped(at.q.size(), count_).transpose();
            const Matrix square = G.lazyProduct(G.transpose());
            const Real least = count_ * std::numeric_limits<Real>::epsilon() * square.cwiseAbs().maxCoeff();
            const auto back = [&](const Reals& x) -> Reals {
                return G.transpose().lazyProduct(solution(square, x, least));
            };
            if (values.head(count_).cwiseAbs().maxCoeff() < Real("1e-45")) {
                at.v -= back(values.segment(count_, count_));
                return is_finite(at.v);
            }
            at.q -= back(values.head(count_));
        }
        return false;
    }

 private:
    static std::vector<Expression> outputs(const Model& model, const std::vector<std::size_t>& contacts) {
        const auto& all = model.equations().free.contacts;
        std::vector<Expression> result;
        for (const std::size_t i : contacts) result.push_back(all[i].gap);
        for (const std::size_t i : contacts) result.push_back(all[i].hdot);
        for (const std::size_t i : contacts) result.insert(result.end(), all[i].g.begin(), all[i].g.end());
        return result;
    }
    Eigen::Index count_;
    Functions functions_;
};

// A Zeno condition as printed, and the derived hddot that it should equal on the surfaces of these contacts.
class ZenoConditionCheck {
 public:
    ZenoConditionCheck(const Model& model, const Run& run, const ZenoCondition& zeno, Expression hddot,
                       const std::vector<std::size_t>& contacts)
        : surface_(model, run, contacts), hddot_(model, run, {hddot}), shown_(model, run, {as_expression(zeno)}) {}

    // The relative difference; nullopt if no state on the surfaces is found from this point.
    std::optional<double> disagreement(PreciseState at) {
        if (!surface_.hold(at)) return std::nullopt;
        const Reals there = hddot_(at);
        if (!is_finite(there)) return std::nullopt;
        return distance(shown_(at)[0], there[0]);
    }

 private:
    static Expression as_expression(const ZenoCondition& zeno) {
        Algebra& algebra = *zeno.algebra;
        algebra.work() = Work{1000000};
        const FactoredForm whole = zeno.positive * zeno.decisive;
        try {
            return algebra.expression(expand(whole, algebra));
        } catch (const SimplificationLimit&) {
            return expression_of(whole, algebra);
        }
    }
    SurfacePoints surface_;
    Functions hddot_, shown_;
};

// The printed equations as expressions, and the derived equations that they should equal.
struct PrintedEquations {
    std::vector<Expression> written, derived;
    std::vector<std::string> names;
};

// "hddot", or "hddot knee" for a system with several contacts.
std::string name_of(const Model& model, const std::string& quantity, std::size_t contact) {
    return model.contacts() == 1 ? quantity : quantity + " " + model.description().constraints[contact].name;
}

PrintedEquations printed_equations(const Model& model, const SimplifiedEquations& simplified) {
    const Equations& e = model.equations();
    PrintedEquations printed;
    const auto add = [&](const std::string& name, const std::optional<Fraction>& fraction, Expression derived) {
        if (!fraction) return;
        printed.written.push_back(simplified.algebra().expression(*fraction));
        printed.derived.push_back(derived);
        printed.names.push_back(name);
    };
    for (std::size_t i = 0; i < e.M.size(); ++i) add("M", simplified.M[i], e.M[i]);
    for (std::size_t i = 0; i < e.bias.size(); ++i) add("bias", simplified.bias[i], e.bias[i]);
    for (std::size_t i = 0; i < e.Q.size() && has_forces(e); ++i) add("Q", simplified.Q[i], e.Q[i]);
    for (std::size_t k = 0; k < model.contacts(); ++k) {
        const ContactEquations& c = e.free.contacts[k];
        const SimplifiedContact& contact = simplified.contacts[k];
        for (std::size_t i = 0; i < c.g.size(); ++i) add(name_of(model, "dh", k), contact.dh[i], c.g[i]);
        add(name_of(model, "hddot", k), contact.hddot, c.hddot);
        add(name_of(model, "lambda", k), contact.lambda, c.lambda);
    }
    return printed;
}

// The derived equations in the order of Differences.
struct DerivedEquations {
    std::vector<Expression> all;
    std::vector<std::string> names;
    void add(const std::string& name, const std::vector<Expression>& some) {
        all.insert(all.end(), some.begin(), some.end());
        names.resize(all.size(), name);
    }
};

DerivedEquations derived_equations(const Model& model) {
    const Equations& e = model.equations();
    DerivedEquations derived;
    derived.add("M", e.M);
    derived.add("bias", e.bias);
    derived.add(has_forces(e) ? "Q" : "", e.Q);
    for (std::size_t k = 0; k < model.contacts(); ++k) {
        const ContactEquations& c = e.free.contacts[k];
        derived.add(name_of(model, "dh", k), c.g);
        derived.add(c.gap_t.is_zero() ? "" : name_of(model, "hdot", k), {c.hdot});
        derived.add(name_of(model, "hddot", k), {c.hddot});
        derived.add(name_of(model, "lambda", k), {c.lambda});
    }
    return derived;
}

// Keeps the largest distance for each name, in order of first appearance.
void note(std::vector<MaxDifference::CheckedQuantity>& quantities, const std::string& name, double distance) {
    if (name.empty()) return;  // a quantity that is not compared
    for (MaxDifference::CheckedQuantity& quantity : quantities)
        if (quantity.name == name) {
            quantity.largest = std::max(quantity.largest, distance);
            return;
        }
    quantities.push_back({name, distance});
}

}  // namespace

double MaxDifference::largest() const {
    double result = 0.0;
    for (const auto* list : {&derived, &simplified})
        for (const CheckedQuantity& quantity : *list) result = std::max(result, quantity.largest);
    return result;
}

std::vector<Expression> given_forces(const Model& model, Graph& graph) {
    const SystemDescription& system = model.description();
    const Scope scope = force_scope(system, model.layout(), graph);
    std::vector<Expression> given;
    const auto add = [&](const Text& text) {
        given.push_back(text.text.empty() ? graph.number(0) : parse(text.text, scope, graph));
    };
    for (const CoordinateDescription& coordinate : system.coordinates) add(coordinate.force);
    add(system.dissipation);
    return given;
}

bool has_forces(const Equations& equations) {
    return std::any_of(equations.Q.begin(), equations.Q.end(), [](Expression force) { return !force.is_zero(); });
}

MaxDifference compare_with_differences(const Model& model, const Run& run, const SimplifiedEquations& simplified,
                                       int states) {
    const Equations& e = model.equations();
    const auto n = static_cast<Eigen::Index>(model.dof());
    const DerivedEquations equations = derived_equations(model);
    Functions derived(model, run, equations.all), pivots(model, run, e.pivots);
    std::vector<Expression> while_held;
    for (const HeldCondition& condition : simplified.while_held)
        while_held.push_back(simplified.held_equations(condition).hddot);
    std::optional<Functions> held;
    if (!while_held.empty()) held.emplace(model, run, while_held);
    Differences differences(model, run);
    const PrintedEquations printed = printed_equations(model, simplified);
    Functions written(model, run, printed.written), originals(model, run, printed.derived);
    std::deque<ZenoConditionCheck> in_contact;
    std::vector<std::string> in_contact_names;
    for (std::size_t k = 0; k < model.contacts(); ++k) {
        if (!simplified.contacts[k].zeno) continue;
        in_contact.emplace_back(model, run, *simplified.contacts[k].zeno, e.free.contacts[k].hddot,
                                std::vector<std::size_t>{k});
        in_contact_names.push_back(name_of(model, "hddot", k) + " in contact");
    }
    for (std::size_t i = 0; i < simplified.while_held.size(); ++i) {
        const HeldCondition& condition = simplified.while_held[i];
        if (!condition.zeno) continue;
        std::vector<std::size_t> contacts{condition.contact};
        for (std::size_t k = 0; k < model.contacts(); ++k)
            if (condition.mode.is_held(k)) contacts.push_back(k);
        in_contact.emplace_back(model, run, *condition.zeno, while_held[i], contacts);
        in_contact_names.emplace_back("hddot in contact while others are held");
    }

    MaxDifference result;
    Random random;
    for (int tried = 0; tried < 10 * states && result.states < states; ++tried) {
        PreciseState at{Reals(n), Reals(n), run.options.start_time};
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto& coordinate = model.description().coordinates[static_cast<std::size_t>(i)];
            at.q[i] = random.between(coordinate.range);
            at.v[i] = random.between(coordinate.rate_range);
        }
        if (!e.autonomous) at.t = random.between({run.options.start_time, run.options.end_time});
        const Reals found = derived(at), found_held = held ? (*held)(at) : Reals(), wanted = differences(at);
        if (!is_finite(found) || !is_finite(found_held) || !is_finite(wanted) || !(pivots(at).minCoeff() > 0)) continue;
        ++result.states;
        for (Eigen::Index i = 0; i < found.size(); ++i)
            note(result.derived, equations.names[static_cast<std::size_t>(i)], distance(found[i], wanted[i]));
        for (Eigen::Index i = 0; i < found_held.size(); ++i) {
            const HeldCondition& condition = simplified.while_held[static_cast<std::size_t>(i)];
            const std::size_t k = condition.contact, j = condition.mode.held().only(),
                              pair = k * (model.contacts() - 1) + j - (j > k ? 1 : 0);
            note(result.derived, "hddot while others are held",
                 distance(found_held[i], wanted[found.size() + static_cast<Eigen::Index>(pair)]));
        }
        const Reals text = written(at), meant = originals(at);
        for (Eigen::Index i = 0; i < text.size(); ++i)
            note(result.simplified, printed.names[static_cast<std::size_t>(i)], distance(text[i], meant[i]));
        for (std::size_t i = 0; i < in_contact.size(); ++i)
            if (const auto disagreement = in_contact[i].disagreement(at))
                note(result.simplified, in_contact_names[i], *disagreement);
    }
    return result;
}

}  // namespace achilles
