#include "check/finite_differences.hpp"

#include <Eigen/LU>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <cstdint>
#include <functional>
#include <random>

#include "check/simplified.hpp"

namespace achilles {

namespace {

namespace mp = boost::multiprecision;
using Real = mp::number<mp::backends::cpp_bin_float<50>, mp::et_off>;
using Reals = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

struct Point {
    Reals q, v;
};

// Expressions of one graph as functions of the state.
class Functions {
 public:
    Functions(const Model& model, const Run& run, const std::vector<Expression>& outputs)
        : dof_(model.layout().dof), program_(outputs, model.layout().slots()) {
        evaluator_ = model.evaluator<Real>(program_, run.parameters);
    }
    Functions(const Functions&) = delete;

    Reals operator()(const Point& at) {
        for (std::size_t i = 0; i < dof_; ++i) {
            evaluator_.input(i) = at.q[static_cast<Eigen::Index>(i)];
            evaluator_.input(dof_ + i) = at.v[static_cast<Eigen::Index>(i)];
        }
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

// d f/dx_i at a point, x one of its two vectors.
Real slope(const std::function<Real(const Point&)>& f, const Point& point, Reals Point::*x, Eigen::Index i) {
    Point at = point;
    const Real middle = (at.*x)[i];
    (at.*x)[i] = middle + step;
    const Real up = f(at);
    (at.*x)[i] = middle - step;
    return (up - f(at)) / (2 * step);
}

// What the equations should be, from L and h alone: d/dt dL/dv = dL/dq along the motion.
class Differences {
 public:
    Differences(const Model& model, const Run& run)
        : dof_(model.dof()),
          lagrangian_(model, run, {model.equations().kinetic - model.equations().potential}),
          gap_(model, run, {model.equations().gaps[0]}) {}

    // M, bias, dh, hddot, lambda, one after the other
    Reals operator()(const Point& at) {
        const auto L = [&](const Point& x) { return lagrangian_(x)[0]; };
        const auto h = [&](const Point& x) { return gap_(x)[0]; };
        Matrix M(dof_, dof_);
        Reals b(dof_), g(dof_);
        for (Eigen::Index i = 0; i < dof_; ++i) {
            const auto momentum = [&](const Point& x) { return slope(L, x, &Point::v, i); };
            b[i] = -slope(L, at, &Point::q, i);
            for (Eigen::Index j = 0; j < dof_; ++j) {
                M(i, j) = slope(momentum, at, &Point::v, j);
                b[i] += slope(momentum, at, &Point::q, j) * at.v[j];
            }
            g[i] = slope(h, at, &Point::q, i);
        }
        const Eigen::PartialPivLU<Matrix> inverse(M);
        const Reals f = inverse.solve(-b);
        // h along q + v t + f t^2/2
        const auto later = [&](const Real& t) { return h({at.q + at.v * t + f * (t * t / 2), at.v}); };
        const Real hddot = (later(step) - 2 * later(0) + later(-step)) / (step * step);
        const Reals impulse = inverse.solve(g);
        Reals all(dof_ * dof_ + 2 * dof_ + 2);
        all << M.reshaped(), b, g, hddot, -hddot / g.dot(impulse);
        return all;
    }

 private:
    Eigen::Index dof_;
    Functions lagrangian_, gap_;
};

// Numbers in [low, high], the same ones everywhere.
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

// Moves a state to h = 0, hdot = 0, by Newton's method and a projection. False if it does not get there.
bool put_in_contact(Point& at, Functions& gap_and_slope) {
    Reals values = gap_and_slope(at);
    for (int i = 0; i < 60 && is_finite(values); ++i, values = gap_and_slope(at)) {
        const Reals g = values.tail(at.q.size());
        const Real square = g.squaredNorm();
        if (square == 0) return false;
        if (abs(values[0]) < Real("1e-45")) {
            at.v -= g * (g.dot(at.v) / square);
            return true;
        }
        at.q -= g * (values[0] / square);
    }
    return false;
}

// What Simplified prints, as expressions, and the derived equations that they should equal.
struct Printed {
    std::vector<Expression> written, derived;
    std::vector<std::string> names;
};

Printed printed_equations(const Model& model, const Simplified& simplified) {
    const Equations& e = model.equations();
    const ContactEquations& c = e.free.contacts[0];
    Printed printed;
    const auto add = [&](const char* name, const std::optional<Fraction>& fraction, Expression derived) {
        if (!fraction) return;
        printed.written.push_back(simplified.algebra().expression(*fraction));
        printed.derived.push_back(derived);
        printed.names.emplace_back(name);
    };
    for (std::size_t i = 0; i < e.M.size(); ++i) add("M", simplified.M[i], e.M[i]);
    for (std::size_t i = 0; i < e.bias.size(); ++i) add("bias", simplified.bias[i], e.bias[i]);
    for (std::size_t i = 0; i < c.g.size(); ++i) add("dh", simplified.dh[i], c.g[i]);
    add("hddot", simplified.hddot, c.hddot);
    add("lambda", simplified.lambda, c.lambda);
    return printed;
}

// Keeps the largest of each name, in the order of their first appearance.
void note(std::vector<Disagreement::Quantity>& quantities, const std::string& name, double distance) {
    for (Disagreement::Quantity& quantity : quantities)
        if (quantity.name == name) {
            quantity.largest = std::max(quantity.largest, distance);
            return;
        }
    quantities.push_back({name, distance});
}

}  // namespace

double Disagreement::largest() const {
    double result = 0.0;
    for (const auto* list : {&derived, &simplified})
        for (const Quantity& quantity : *list) result = std::max(result, quantity.largest);
    return result;
}

Disagreement compare_with_differences(const Model& model, const Run& run, const Simplified& simplified, int states) {
    const Equations& e = model.equations();
    const ContactEquations& c = e.free.contacts[0];
    const auto n = static_cast<Eigen::Index>(model.dof());
    std::vector<Expression> all = e.M;
    std::vector<std::string> names(all.size(), "M");
    const auto add = [&](const char* name, const std::vector<Expression>& some) {
        all.insert(all.end(), some.begin(), some.end());
        names.resize(all.size(), name);
    };
    add("bias", e.bias);
    add("dh", c.g);
    add("hddot", {c.hddot});
    add("lambda", {c.lambda});
    Functions derived(model, run, all), pivots(model, run, e.pivots), hddot(model, run, {c.hddot});
    std::vector<Expression> gap{c.gap};
    gap.insert(gap.end(), c.g.begin(), c.g.end());
    Functions gap_and_slope(model, run, gap);
    Differences differences(model, run);
    const Printed printed = printed_equations(model, simplified);
    Functions written(model, run, printed.written), originals(model, run, printed.derived);
    std::optional<Functions> in_contact;
    if (simplified.zeno) {
        Algebra& algebra = *simplified.zeno->algebra;
        algebra.work() = Work{1000000};
        in_contact.emplace(model, run,
                           std::vector<Expression>{algebra.expression(
                               expand(simplified.zeno->positive * simplified.zeno->decisive, algebra))});
    }

    Disagreement result;
    Random random;
    for (int tried = 0; tried < 10 * states && result.states < states; ++tried) {
        Point at{Reals(n), Reals(n)};
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto& coordinate = model.description().coordinates[static_cast<std::size_t>(i)];
            at.q[i] = random.between(coordinate.range);
            at.v[i] = random.between(coordinate.rate_range);
        }
        const Reals found = derived(at), wanted = differences(at);
        if (!is_finite(found) || !is_finite(wanted) || !(pivots(at).minCoeff() > 0)) continue;
        ++result.states;
        for (Eigen::Index i = 0; i < found.size(); ++i)
            note(result.derived, names[static_cast<std::size_t>(i)], distance(found[i], wanted[i]));
        const Reals text = written(at), meant = originals(at);
        for (Eigen::Index i = 0; i < text.size(); ++i)
            note(result.simplified, printed.names[static_cast<std::size_t>(i)], distance(text[i], meant[i]));
        if (!in_contact || !put_in_contact(at, gap_and_slope)) continue;
        const Reals there = hddot(at), shown = (*in_contact)(at);
        if (is_finite(there)) note(result.simplified, "hddot in contact", distance(shown[0], there[0]));
    }
    return result;
}

}  // namespace achilles
