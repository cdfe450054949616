#include "expression/graph.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace achilles {

namespace {

using boost::multiprecision::numerator, boost::multiprecision::denominator;

std::uint64_t hash(const Graph::Node& node) {
    std::uint64_t value = static_cast<std::uint64_t>(node.operation);
    for (const std::uint64_t part : {std::uint64_t{node.a}, std::uint64_t{node.b},
                                     static_cast<std::uint64_t>(static_cast<std::uint32_t>(node.exponent))}) {
        value = (value ^ part) * 0x9E3779B97F4A7C15ULL;
        value ^= value >> 29;
    }
    return value;
}

bool same(const Graph::Node& x, const Graph::Node& y) {
    return x.operation == y.operation && x.a == y.a && x.b == y.b && x.exponent == y.exponent;
}

std::uint64_t hash(const Rational& value) {
    return std::hash<Rational>()(value) * 0x9E3779B97F4A7C15ULL;  // the low bits select the entry
}

// Boost compares rationals by long division, even for equality.
bool same(const Rational& x, const Rational& y) {
    return numerator(x) == numerator(y) && denominator(x) == denominator(y);
}

// Size in bits of the numerator and the denominator together.
std::size_t bits(const Rational& value) {
    return value.is_zero() ? 0 : msb(abs(numerator(value))) + msb(denominator(value)) + 2;
}

constexpr double infinity = std::numeric_limits<double>::infinity();

// The largest double that is not above the value. Starts from the library's conversion and corrects it by exact
// comparisons.
double round_down(const Rational& value) {
    constexpr double largest = std::numeric_limits<double>::max();
    if (value >= Rational(largest)) return largest;
    if (value < Rational(-largest)) return -infinity;
    double guess = value.convert_to<double>();
    if (!std::isfinite(guess)) guess = guess > 0 ? largest : -largest;
    while (Rational(guess) > value) guess = std::nextafter(guess, -infinity);
    for (double next = std::nextafter(guess, infinity); Rational(next) <= value;
         next = std::nextafter(next, infinity)) {
        guess = next;
        if (guess == largest) break;
    }
    return guess;
}

}  // namespace

std::uint32_t Graph::Table::intern(const Node& node) {
    node_ids.room(nodes.size(), [&](std::uint32_t id) { return hash(nodes[id]); });
    std::uint32_t& id = node_ids.find(hash(node), [&](std::uint32_t other) { return same(nodes[other], node); });
    if (id == IdSet::none) {
        if (nodes.size() == max_nodes) throw ExpressionTooLarge(fmt::format("more than {} operations", max_nodes));
        id = static_cast<std::uint32_t>(nodes.size());
        nodes.push_back(node);
    }
    return id;
}

std::uint32_t Graph::Table::intern(const Rational& value) {
    const std::size_t size = bits(value);
    if (size > max_bits) throw ExpressionTooLarge(fmt::format("an exact number has more than {} bits", max_bits));
    bits_in_all += size;
    if (bits_in_all > max_bits_in_all)
        throw ExpressionTooLarge(fmt::format("the exact numbers have more than {} bits in total", max_bits_in_all));
    number_ids.room(numbers.size(), [&](std::uint32_t id) { return hash(numbers[id]); });
    std::uint32_t& id = number_ids.find(hash(value), [&](std::uint32_t other) { return same(numbers[other], value); });
    if (id == IdSet::none) {
        const auto next = static_cast<std::uint32_t>(numbers.size());
        number_nodes.push_back(intern(Node{Operation::number, next, 0, 0}));
        numbers.push_back(value);
        id = next;
    }
    return number_nodes[id];
}

Graph::Graph() : table_(std::make_unique<Table>()) {}
Graph::Graph(const Graph& other) : table_(std::make_unique<Table>(*other.table_)) {}
Graph::~Graph() = default;

const Graph::Node& Graph::node(std::uint32_t id) const { return table_->nodes[id]; }
std::uint32_t Graph::size() const { return static_cast<std::uint32_t>(table_->nodes.size()); }

Expression Graph::number(long numerator, long denominator) {
    return Builder::number(*this, Rational(numerator, denominator));
}

Expression Graph::decimal(std::string_view digits) {
    // Limits the length and the exponent: a huge exponent would need gigabytes of digits.
    constexpr std::size_t longest = 400;
    boost::multiprecision::cpp_int mantissa = 0;
    long exponent = 0;
    std::size_t at = 0;
    bool after_point = false;
    if (digits.size() > longest) throw std::out_of_range("a number with more than 400 characters");
    for (; at < digits.size() && digits[at] != 'e' && digits[at] != 'E'; ++at) {
        if (digits[at] == '.') {
            after_point = true;
            continue;
        }
        mantissa = mantissa * 10 + (digits[at] - '0');
        if (after_point) --exponent;
    }
    if (at < digits.size()) {
        const bool negative = digits[at + 1] == '-';
        if (digits[at + 1] == '-' || digits[at + 1] == '+') ++at;
        long written = 0;
        for (++at; at < digits.size() && written < 1000000; ++at) written = written * 10 + (digits[at] - '0');
        exponent += negative ? -written : written;
    }
    if (std::abs(exponent) > 400 + static_cast<long>(longest)) throw std::out_of_range("an exponent beyond 400");
    // Not auto, because the expression template would refer to a destroyed temporary.
    const boost::multiprecision::cpp_int scale =
        boost::multiprecision::pow(boost::multiprecision::cpp_int(10), static_cast<unsigned>(std::abs(exponent)));
    return Builder::number(*this, exponent < 0 ? Rational(mantissa, scale) : Rational(mantissa * scale));
}

Expression Graph::pi() { return Builder::make(*this, Node{Operation::pi, 0, 0, 0}); }
Expression Graph::symbol(std::uint32_t slot) { return Builder::make(*this, Node{Operation::symbol, slot, 0, 0}); }

Constant Graph::constant(std::uint32_t id) const {
    const Rational& value = table_->numbers[table_->nodes[id].a];
    const auto p = numerator(value), q = denominator(value);
    if (constexpr std::int64_t exact = std::int64_t{1} << 53; abs(p) <= exact && q <= exact) {
        // One correctly rounded division. The sign of the exact remainder tells on which side of the quotient the value
        // lies.
        const double top = p.convert_to<double>(), bottom = q.convert_to<double>();
        const double nearest = top / bottom, rest = std::fma(-nearest, bottom, top);
        return {nearest, rest < 0.0 ? std::nextafter(nearest, -infinity) : nearest,
                rest > 0.0 ? std::nextafter(nearest, infinity) : nearest, p.str(), q.str()};
    }
    const double low = round_down(value);
    const double high = -round_down(-value);
    const bool low_is_nearer =
        std::isfinite(low) && (!std::isfinite(high) || value - Rational(low) <= Rational(high) - value);
    return {low_is_nearer ? low : high, low, high, p.str(), q.str()};
}

bool Expression::is_number() const { return Builder::is(*this, Operation::number); }
bool Expression::is_zero() const { return is_number() && Builder::value(*this).is_zero(); }
bool Expression::is_one() const {
    return is_number() && numerator(Builder::value(*this)) == 1 && denominator(Builder::value(*this)) == 1;
}

std::vector<bool> reachable(std::span<const Expression> outputs) {
    std::uint32_t last = 0;
    for (const Expression output : outputs) last = std::max(last, output.id());
    std::vector<bool> mark(outputs.empty() ? 0 : last + 1, false);
    for (const Expression output : outputs) mark[output.id()] = true;
    for (std::uint32_t id = last + 1; id-- > 0 && !outputs.empty();) {
        if (!mark[id]) continue;
        const Graph::Node& node = outputs.front().graph().node(id);
        if (is_leaf(node.operation)) continue;
        mark[node.a] = true;
        if (is_binary(node.operation)) mark[node.b] = true;
    }
    return mark;
}

}  // namespace achilles
