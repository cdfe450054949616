#include "check/equations_on_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "check/simplified.hpp"
#include "expression/graph.hpp"
#include "model/degenerate_gap.hpp"
#include "output/page.hpp"

namespace achilles {

namespace {

// A Newton step for h = 0 along dh. Returns |h| before the step; nullopt if dh = 0.
std::optional<double> newton_step(ContactTerms<Evaluator<double>>& terms, State& state) {
    set_state(terms, state);
    terms.run();
    const auto dof = static_cast<std::size_t>(state.q.size());
    double slope = 0.0;
    for (std::size_t i = 0; i < dof; ++i) slope += terms.gradient(i) * terms.gradient(i);
    if (!(slope > 0.0)) return std::nullopt;
    for (std::size_t i = 0; i < dof; ++i)
        state.q[static_cast<Eigen::Index>(i)] -= terms.h() / slope * terms.gradient(i);
    return std::abs(terms.h());
}

// True if the last few Newton steps reduced |h| as at a zero of order m > 1: by the factor (1 - 1/m)^m, which is
// between 1/4 and 1/e, the factor of a gap that never closes. At a simple zero |h| decreases faster and faster. If
// true, `state` is moved close to the zero; the steps shorten by 1 - 1/m.
bool converges_to_multiple_zero(const Model& model, const Run& run, std::size_t contact, State& state) {
    constexpr int steps = 12, looked_at = 4, until_near = 60;
    constexpr double least = 0.2, most = 0.35;
    auto terms = model.evaluator(model.programs_of(contact).contact_terms, run.parameters);
    double before = 0.0;
    State near = state;  // the state after `steps` steps
    for (int round = 0; round <= steps; ++round) {
        near = state;
        const auto h = newton_step(terms, state);
        const double share = h.value_or(0.0) / before;
        if (round > steps - looked_at && !(share > least && share < most)) return false;
        before = h.value_or(0.0);
        if (!h) break;
    }
    if (!(before > 0.0 && is_flat(model, run.parameters, near, contact))) return false;
    for (int round = 0; round < until_near && newton_step(terms, state); ++round) {
    }
    return true;
}

// A state with h = 0 and dh = 0 of a contact, as for a gap y^2 or y^3. It has no normal, so no impact can be computed
// there. Newton's method for h = 0 starts at the initial state and at some states in the ranges of the coordinates. At
// such a state it converges linearly only. nullopt if none is found.
std::optional<State> flat_place(const Model& model, const Run& run, std::size_t contact) {
    constexpr int tries = 8;
    std::mt19937_64 engine(4);
    for (int i = 0; i < tries; ++i) {
        State state = run.start();
        for (Eigen::Index k = 0; i > 0 && k < state.q.size(); ++k) {
            const auto& range = model.description().coordinates[static_cast<std::size_t>(k)].range;
            state.q[k] = range[0] + (range[1] - range[0]) * (static_cast<double>(engine() >> 11) * 0x1p-53);
        }
        if (converges_to_multiple_zero(model, run, contact, state)) return state;
    }
    return std::nullopt;
}

}  // namespace

namespace {

// Longer formulas, in terms, are not printed.
constexpr std::size_t max_terms = 150;

// Longer unsimplified expressions, in symbols, are not printed.
constexpr double max_symbols = 400.0;

// Number of symbols of an expression in full, where shared parts count repeatedly.
double written_size(Expression expression) {
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::vector<double> size(needed.size(), 0.0);
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node& node = expression.graph().node(id);
        size[id] = 1.0;
        if (is_leaf(node.operation)) continue;
        size[id] += size[node.a];
        if (is_binary(node.operation)) size[id] += size[node.b];
    }
    return size[expression.id()];
}

// The numerator and the denominator without factoring.
FactoredForm unfactored(const Fraction& fraction) {
    FactoredForm result;
    const auto put = [&](const Multinomial& base, int exponent) {
        if (base.terms().size() != 1) return result.factors.push_back({base, exponent});
        const Multinomial::Term& term = base.terms().front();
        const boost::multiprecision::cpp_rational number(term.coefficient);
        result.number *= exponent > 0 ? number : 1 / number;
        if (!base.is_number()) result.factors.push_back({Multinomial({{term.powers, 1}}), exponent});
    };
    put(fraction.numerator, 1);
    put(fraction.denominator, -1);
    return result;
}

std::size_t terms(const Fraction& f) { return f.numerator.terms().size() + f.denominator.terms().size(); }

}  // namespace

void EquationsOnPage::contact(std::size_t index, bool forces, bool named) {
    const SimplifiedContact& c = simplified_.contacts[index];
    const auto caption = [&](const char* words) {
        if (named) page_.caption(words);
    };
    const bool moves = !model_.equations().free.contacts[index].gap_t.is_zero();
    page_.heading("Contact" + of(" {}", index));
    caption("gap");
    if (named)
        page_.formula({"h", "h"},
                      achilles::write(model_.equations().gaps[index], model_.slot_names(), page_.notation()).text);
    caption("gradient of the gap");
    const ContactEquations& derived = model_.equations().free.contacts[index];
    matrix({"dh", "\\mathrm{d}h"}, c.dh, derived.g, model_.layout().dof);
    flat(index);
    caption("rate of the gap");
    formula({"hdot", "\\dot{h}"}, c.hdot, derived.hdot,
            {moves ? "dh q' + h_t" : "dh q'", moves ? "\\mathrm{d}h\\,\\dot{q} + h_t" : "\\mathrm{d}h\\,\\dot{q}"});
    caption("acceleration of the gap in free motion");
    formula({"hddot", "\\ddot{h}"}, c.hddot, derived.hddot,
            {fmt::format("q'^T Hess(h) q'{} {}", moves ? " + 2 dh_t q' + h_tt" : "",
                         forces ? "+ dh M^-1 (Q - bias)" : "- dh M^-1 bias"),
             fmt::format("\\dot{{q}}^{{\\top}}\\,\\mathrm{{Hess}}(h)\\,\\dot{{q}}{} {}",
                         moves ? " + 2\\,\\mathrm{d}h_t\\,\\dot{q} + h_{tt}" : "",
                         forces ? "+ \\mathrm{d}h\\,M^{-1} (Q - b)" : "- \\mathrm{d}h\\,M^{-1} b")});
    caption("contact force while held");
    formula({"lambda", "\\lambda"}, c.lambda, derived.lambda,
            {"-hddot/(dh M^-1 dh^T)", "-\\ddot{h} / (\\mathrm{d}h\\,M^{-1}\\,\\mathrm{d}h^{\\top})"});
}

// Warns about a gap whose gradient vanishes at h = 0.
void EquationsOnPage::flat(std::size_t index) {
    const std::optional<State> place = flat_place(model_, run_, index);
    if (!place) return;
    std::string at;
    for (int i = 0; i < model_.dof(); ++i)
        at += fmt::format("{}{} = {:.2g}", at.empty() ? "" : ", ", model_.slot_names()[static_cast<std::size_t>(i)],
                          place->q[i]);
    const std::string flat_text = fmt::format("dh = 0 where h = 0, near {}: no impact can be computed there", at);
    for (const std::string& sentence : {flat_text, std::string(flat_hint)})
        page_.sentence({sentence, Page::escaped(sentence)});
}

void EquationsOnPage::unwritten_conditions() {
    const std::size_t contacts = model_.contacts(), pairs = contacts * (contacts - 1);
    const bool has_pairs = simplified_.while_held.size() == pairs;
    if (contacts < 2 || (has_pairs && contacts == 2)) return;
    const char* const held = simplified_.while_held.empty() ? "any other contacts"
                             : has_pairs                    ? "two or more other contacts"
                             : contacts == 2                ? "a contact with friction"
                                                            : "a contact with friction, or two or more other contacts,";
    const std::string left_out =
        fmt::format("Zeno conditions with {} held are not printed; a run derives those that it needs.", held);
    page_.sentence({left_out, left_out});
}

void EquationsOnPage::matrix(const TextAndLatex& left, const std::vector<std::optional<Fraction>>& entries,
                             std::span<const Expression> derived, std::size_t columns) {
    std::vector<std::vector<std::string>> rows;
    std::vector<std::size_t> widths(columns, 0);
    bool complete = true;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i % columns == 0) rows.emplace_back();
        complete = complete && entries[i] && terms(*entries[i]) <= max_terms;
        rows.back().push_back(complete ? written(*entries[i]) : std::string());
        widths[i % columns] = std::max(widths[i % columns], visible_length(rows.back().back(), page_.notation()) + 3);
    }
    std::size_t width = left.text.size() + 6;
    for (const std::size_t column : widths) width += column;
    if (complete && width <= page_.width()) return page_.matrix(left, rows);
    const bool vector = rows.size() == 1 || columns == 1;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const std::size_t row = i / columns, column = i % columns;
        if (!vector && column < row) continue;  // M is symmetric
        const std::string number = vector ? fmt::format("{}", i + 1) : fmt::format("{}{}", row + 1, column + 1);
        formula({left.text + number, fmt::format("{{{}}}_{{{}}}", left.latex, number)}, entries[i], derived[i], {});
    }
}

// The simplified formula, or the derived expression if there is none.
void EquationsOnPage::formula(const TextAndLatex& left, const std::optional<Fraction>& fraction, Expression derived,
                              const TextAndLatex& definition) {
    if (!fraction) return unsimplified(left, derived, definition);
    if (terms(*fraction) <= max_terms) return long_formula(page_, left, factor_or_sum(*fraction));
    page_.formula(left, is_text() ? definition.text : definition.latex);
    const std::string why = fmt::format("not printed: {} terms", terms(*fraction));
    page_.sentence({"  (" + why + ")", "\\quad (" + why + ")"});
}

// The derived expression if it is short enough, else the definition.
void EquationsOnPage::unsimplified(const TextAndLatex& left, Expression derived, const TextAndLatex& definition) {
    const double size = written_size(derived);
    const bool short_enough = size <= max_symbols;
    page_.formula(left, short_enough ? achilles::write(derived, model_.slot_names(), page_.notation()).text
                        : is_text()  ? definition.text
                                     : definition.latex);
    const std::string why =
        short_enough ? "not simplified: too many operations"
                     : fmt::format("neither simplified nor printed: the derived form has {:.2g} symbols", size);
    page_.sentence({"  (" + why + ")", "\\quad (" + why + ")"});
}

std::string EquationsOnPage::written(const Fraction& fraction, const AlgebraWriter& writer, Algebra& algebra) const {
    algebra.work() = Work{1000000};
    try {
        return writer.write(fraction, algebra).text;
    } catch (const SimplificationLimit&) {
        return writer.write(unfactored(fraction)).text;
    }
}

EquationsOnPage::Quotient EquationsOnPage::factor_or_sum(const Fraction& fraction) const {
    Algebra& algebra = simplified_.algebra();
    Quotient result{written(fraction), {}, {}};
    if (fraction.denominator.is_number()) return result;
    algebra.work() = Work{1000000};
    try {
        return split(factor(fraction, algebra), result.whole, writer_);
    } catch (const SimplificationLimit&) {
        return split(unfactored(fraction), result.whole, writer_);
    }
}

EquationsOnPage::Quotient EquationsOnPage::split(const FactoredForm& factored, const std::string& whole,
                                                 const AlgebraWriter& writer) {
    FactoredForm top{numerator(factored.number), {}}, bottom{denominator(factored.number), {}};
    for (const auto& [base, exponent] : factored.factors)
        (exponent > 0 ? top : bottom).factors.push_back({base, std::abs(exponent)});
    return {whole, writer.write(top).text, writer.write(bottom).text};
}

// A quotient too wide for one line is written as N/D, with N and D below.
void EquationsOnPage::long_formula(Page& page, const TextAndLatex& left, const Quotient& quotient) {
    const std::size_t length = visible_length(quotient.whole, page.notation()) + left.text.size() + 5;
    const bool tall = page.notation() == Notation::latex && !quotient.top.empty();
    const std::size_t across = tall ? std::max(visible_length(quotient.top, page.notation()),
                                               visible_length(quotient.bottom, page.notation())) +
                                          8
                                    : length;
    if (quotient.top.empty() || across <= page.width()) return page.formula(left, quotient.whole);
    page.formula(left, page.notation() == Notation::text ? "N/D, where" : "N/D, \\quad\\text{where}");
    page.formula({"N", "N"}, quotient.top, 2);
    page.formula({"D", "D"}, quotient.bottom, 2);
}

void EquationsOnPage::zeno(const std::optional<ZenoCondition>& found) {
    if (!found) {
        page_.sentence({"(not simplified: too many operations)", "(not simplified: too many operations)"});
        return;
    }
    const ZenoCondition& zeno = *found;
    if (const auto there = on_surface(zeno); !there.empty()) {
        const std::string line = fmt::format("there {}", fmt::join(there, ", "));
        page_.sentence({line, line});
    }
    const AlgebraWriter writer = writer_of(zeno);
    const FactoredForm whole = zeno.positive * zeno.decisive;
    const std::string hddot = writer.write(whole).text;
    const bool divided = !zeno.positive.factors.empty() || zeno.positive.number != 1;
    if (zeno.verdict == ZenoCondition::Verdict::depends) {
        if (divided) {
            long_formula(page_, {"hddot", "\\ddot{h}"}, split(whole, hddot, writer));
            reason(zeno, writer);
        }
        page_.formula({}, fmt::format("{} < 0", writer.write(zeno.decisive).text));
        const auto value = is_text() ? decisive_here(zeno) : std::nullopt;  // a sheet has its own sliders
        if (!value) return;
        const std::string line =
            *value < 0.0
                ? fmt::format("it holds with these parameters: {:.6g} < 0", *value)
                : fmt::format("it does not hold with these parameters, so impacts do not pile up: {:.6g} >= 0", *value);
        page_.sentence({line, line});
        return;
    }
    long_formula(page_, {"hddot", "\\ddot{h}"}, split(whole, hddot, writer));
    const std::string verdict = zeno.verdict == ZenoCondition::Verdict::always
                                    ? "hddot < 0 at every contact"
                                    : "hddot >= 0 at every contact: no Zeno point exists";
    const std::string because = grounds(zeno);
    page_.sentence({verdict + because, Page::escaped(verdict) + because});
}

std::optional<double> EquationsOnPage::decisive_here(const ZenoCondition& zeno) const {
    const Layout& layout = model_.layout();
    std::vector<std::uint32_t> varying(2 * layout.dof);  // slots of the state and the time
    std::iota(varying.begin(), varying.end(), 0U);
    varying.push_back(layout.t());
    const Expression decisive = expression_of(zeno.decisive, *zeno.algebra);
    if (depends_on(decisive, varying)) return std::nullopt;
    const Program program(std::span(&decisive, 1), layout.slots());
    auto evaluator = model_.evaluator(program, run_.parameters);
    evaluator.run();
    return evaluator.output(0);
}

// The writer covers the atoms that the algebra has created so far.
AlgebraWriter EquationsOnPage::writer_of(const ZenoCondition& zeno) const {
    return AlgebraWriter(*zeno.algebra, model_.slot_names(), simplified_.ranks(), page_.notation());
}

std::vector<std::string> EquationsOnPage::on_surface(const ZenoCondition& zeno) const {
    std::vector<Fraction> values;
    for (const auto& [symbol, value] : zeno.solved) {
        zeno.algebra->work() = Work{1000000};
        try {
            values.push_back(zeno.algebra->simplify(value));
        } catch (const SimplificationLimit&) {
            return {};
        }
    }
    const AlgebraWriter writer = writer_of(zeno);
    std::vector<std::string> there;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string symbol = achilles::write(zeno.solved[i].first, model_.slot_names(), page_.notation()).text;
        there.push_back(in_line(fmt::format("{} = {}", symbol, written(values[i], writer, *zeno.algebra))));
    }
    return there;
}

void EquationsOnPage::zeno_restitution(std::size_t contact) {
    const double e = model_.restitution(run_.parameters, contact);
    const std::string line =
        e >= 1.0 ? "but no Zeno point: restitution is 1 here, and the bounces never die out"
        : e <= 0.0
            ? "but no Zeno point: restitution is 0 here, and contact begins at the first impact (a plastic impact)"
            : fmt::format("and 0 < restitution < 1 (here {})", e);
    page_.sentence({line, Page::escaped(line)});
}

// The assumptions of the proof of a sign.
std::string EquationsOnPage::grounds(const ZenoCondition& zeno) const {
    std::vector<std::string> names, reasons;
    for (const Expression e : zeno.assumed)
        names.push_back(in_line(achilles::write(e, model_.slot_names(), page_.notation()).text));
    if (!names.empty())
        reasons.push_back(fmt::format("by the range{} of {}{}", names.size() > 1 ? "s" : "", fmt::join(names, ", "),
                                      zeno.vanishing ? " where not 0" : ""));
    if (zeno.definite) reasons.emplace_back("where M is positive definite");
    return reasons.empty() ? "" : fmt::format(", {}", fmt::join(reasons, " and "));
}

void EquationsOnPage::reason(const ZenoCondition& zeno, const AlgebraWriter& writer) {
    const std::string divisor = in_line(writer.write(zeno.positive).text);
    const std::string because = grounds(zeno);
    if (is_text() && divisor.size() > 60)
        return page_.sentence({fmt::format("divided by the positive factors{}:", because), {}});
    const std::string line = fmt::format("divided by {}, which is positive{}:", divisor, because);
    page_.sentence({line, line});
}

}  // namespace achilles
