// Formats an expression as text that parse() can read, or as LaTeX.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "expression/expression.hpp"
#include "expression/graph.hpp"
#include "expression/notation.hpp"

namespace achilles {

namespace {

using Op = Operation;

constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr std::array<std::string_view, 34> greek{
    "alpha", "beta",  "gamma",  "delta", "epsilon", "zeta",  "eta",     "theta", "iota", "kappa", "lambda", "mu",
    "nu",    "xi",    "pi",     "rho",   "sigma",   "tau",   "upsilon", "phi",   "chi",  "psi",   "omega",  "Gamma",
    "Delta", "Theta", "Lambda", "Xi",    "Pi",      "Sigma", "Upsilon", "Phi",   "Psi",  "Omega"};

// A run of letters or digits in LaTeX: a Greek letter by its name, a single letter or a number unchanged, other words
// in one \mathit.
std::string latex_word(std::string_view word) {
    if (std::find(greek.begin(), greek.end(), word) != greek.end()) return fmt::format("\\{}", word);
    return word.size() <= 1 || is_digit(word.front()) ? std::string(word) : fmt::format("\\mathit{{{}}}", word);
}

// theta1 is \theta_{1}, m_t is m_{t}, x' is \dot{x}.
std::string latex_name(std::string_view name) {
    const std::size_t primes = name.size() - std::min(name.find('\''), name.size());
    name.remove_suffix(primes);
    std::string base, subscript;
    for (std::size_t at = 0; at < name.size();) {
        std::size_t end = at;
        while (end < name.size() && is_letter(name[end]) == is_letter(name[at]) && name[end] != '_') ++end;
        const std::string_view part = name.substr(at, end - at);
        if (base.empty())
            base = latex_word(part);
        else if (!part.empty())
            subscript += fmt::format("{}{}", subscript.empty() ? "" : ",", latex_word(part));
        at = std::max(end, at + 1);
    }
    if (primes > 0) base = fmt::format("\\{}{{{}}}", primes == 1 ? "dot" : "ddot", base);
    return subscript.empty() ? base : fmt::format("{}_{{{}}}", base, subscript);
}

std::string latex_function(Op function, std::string_view name) {
    switch (function) {
        case Op::asin:
        case Op::acos:
        case Op::atan:
            return fmt::format("\\arc{}", name.substr(1));
        default:
            return fmt::format("\\{}", name);
    }
}

bool starts_with_digit(const std::string& text) { return !text.empty() && is_digit(text.front()); }

}  // namespace

std::string inside(const FormattedTerm& part, int least, Notation notation) {
    if (part.binding >= least) return part.text;
    const bool tall = notation == Notation::latex && part.text.find("\\frac") != std::string::npos;
    return tall ? fmt::format("\\left({}\\right)", part.text) : fmt::format("({})", part.text);
}

FormattedTerm write_number(const boost::multiprecision::cpp_rational& value, Notation notation) {
    const auto top = numerator(value), bottom = denominator(value);
    if (notation == Notation::text || bottom == 1) return {value.str(), value < 0 ? 1 : bottom != 1 ? 2 : 5, {}};
    return {fmt::format("{}\\tfrac{{{}}}{{{}}}", value < 0 ? "-" : "", boost::multiprecision::cpp_int(abs(top)).str(),
                        bottom.str()),
            value < 0 ? 1 : 3,
            {}};
}

FormattedTerm write_name(std::string_view name, Notation notation) {
    return {notation == Notation::text ? std::string(name) : latex_name(name), 5, {}};
}

FormattedTerm write_sum(const FormattedTerm& a, bool minus, const FormattedTerm& b, Notation notation) {
    const bool bare = !minus && !b.text.starts_with('-');  // a + (b + c)
    return {fmt::format("{} {} {}", a.text, minus ? '-' : '+', bare ? b.text : inside(b, 2, notation)), 1, {}};
}

FormattedTerm write_negated(const FormattedTerm& a, Notation notation) {
    return {fmt::format("-{}", inside(a, notation == Notation::text ? 3 : 2, notation)), 1, {}};
}

FormattedTerm write_product(const FormattedTerm& a, const FormattedTerm& b, Notation notation) {
    const std::string left = inside(a, 2, notation);
    // Text keeps the order of evaluation: a*(b*c) is read back unchanged.
    if (notation == Notation::text) return {fmt::format("{}*{}", left, inside(b, 3, notation)), 2, {}};
    const std::string right = inside(b, 2, notation);
    return {fmt::format("{}{}{}", left, starts_with_digit(right) ? " \\cdot " : " ", right), 2, {}};
}

FormattedTerm write_quotient(const FormattedTerm& a, const FormattedTerm& b, Notation notation) {
    if (notation == Notation::latex) return {fmt::format("\\frac{{{}}}{{{}}}", a.text, b.text), 3, {}};
    return {fmt::format("{}/{}", inside(a, 2, notation), inside(b, 4, notation)), 2, {}};
}

FormattedTerm write_power(const FormattedTerm& base, int exponent, Notation notation) {
    if (notation == Notation::text)
        return {
            fmt::format(fmt::runtime(exponent < 0 ? "{}^({})" : "{}^{}"), inside(base, 5, notation), exponent), 4, {}};
    if (base.head.empty() || exponent < 0) {
        const std::string text = base.head.empty() ? inside(base, 5, notation) : fmt::format("({})", base.text);
        return {fmt::format("{}^{{{}}}", text, exponent), 4, {}};
    }
    return {fmt::format("{}^{{{}}}{}", base.head, exponent, base.text.substr(base.head.size())), 4, {}};
}

FormattedTerm write_real_power(const FormattedTerm& base, const FormattedTerm& exponent, Notation notation) {
    if (notation == Notation::text)
        return {fmt::format("{}^{}", inside(base, 5, notation), inside(exponent, 5, notation)), 4, {}};
    const std::string text = base.head.empty() ? inside(base, 5, notation) : fmt::format("({})", base.text);
    return {fmt::format("{}^{{{}}}", text, exponent.text), 4, {}};
}

FormattedTerm write_function(Operation function, const FormattedTerm& argument, Notation notation) {
    for (const auto& [name, operation, value] : functions) {
        if (operation != function) continue;
        if (notation == Notation::text) return {fmt::format("{}({})", name, argument.text), 5, {}};
        if (function == Op::sqrt) return {fmt::format("\\sqrt{{{}}}", argument.text), 5, {}};
        const std::string head = latex_function(function, name);
        // A simple argument needs no parentheses: \sin x. The space ends the name of the function.
        const bool plain = argument.binding == 5 && argument.head.empty();
        const std::string rest =
            plain ? fmt::format(" {}", argument.text) : fmt::format("{}", inside({argument.text, 1, {}}, 5, notation));
        return {head + rest, 5, head};
    }
    return {};
}

namespace {

// The product a b, where a may be an exact number, which is then `first`. Text writes p*b/q for a positive fraction
// p/q, and keeps a negative number as a factor: (-1/2)*x. LaTeX puts a minus sign in front of the product.
FormattedTerm multiplied(Expression first, const FormattedTerm& a, const FormattedTerm& b, Notation notation) {
    if (!first.is_number()) return write_product(a, b, notation);
    const boost::multiprecision::cpp_rational& value = Builder::value(first);
    if (value < 0)
        return notation == Notation::text
                   ? write_product(a, b, notation)
                   : write_negated(write_product(write_number(-value, notation), b, notation), notation);
    if (notation == Notation::latex || denominator(value) == 1) return write_product(a, b, notation);
    const FormattedTerm top =
        numerator(value) == 1 ? b : write_product(write_number(numerator(value), notation), b, notation);
    return write_quotient(top, write_number(denominator(value), notation), notation);
}

}  // namespace

FormattedTerm write(Expression expression, std::span<const std::string> names, Notation notation) {
    const Graph& graph = expression.graph();
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::vector<FormattedTerm> written(needed.size());
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node& node = graph.node(id);
        const bool leaf = is_leaf(node.operation);
        const FormattedTerm &a = written[leaf ? 0 : node.a], &b = written[is_binary(node.operation) ? node.b : 0];
        switch (node.operation) {
            case Op::number:
                written[id] = write_number(Builder::value({&expression.graph(), id}), notation);
                break;
            case Op::pi:
                written[id] = write_name("pi", notation);
                break;
            case Op::symbol:
                written[id] = node.a < names.size() ? write_name(names[node.a], notation) : FormattedTerm{"?", 5, {}};
                break;
            case Op::add:
            case Op::subtract:
                written[id] = write_sum(a, node.operation == Op::subtract, b, notation);
                break;
            case Op::multiply:
                written[id] = multiplied({&expression.graph(), node.a}, a, b, notation);
                break;
            case Op::divide:
                written[id] = write_quotient(a, b, notation);
                break;
            case Op::negate:
                written[id] = write_negated(a, notation);
                break;
            case Op::power:
                written[id] = write_power(a, node.exponent, notation);
                break;
            case Op::real_power:
                written[id] = write_real_power(a, b, notation);
                break;
            case Op::midpoint:
                written[id] = a;
                break;
            default:
                written[id] = write_function(node.operation, a, notation);
        }
    }
    return written[expression.id()];
}

std::string to_text(Expression expression, std::span<const std::string> names) {
    return write(expression, names, Notation::text).text;
}

}  // namespace achilles
