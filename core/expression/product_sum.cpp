#include "expression/product_sum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <tuple>

#include "expression/graph.hpp"

namespace achilles {

namespace {

using boost::multiprecision::denominator, boost::multiprecision::numerator;

// Far above the needs of a chain of twelve links (500 terms), and low enough to end within a second.
constexpr std::size_t max_products = 10000;
constexpr long max_exponent = 100000;
// Nested sums that share their parts are short in a graph and may be endless as a text.
constexpr std::size_t max_text = 200000;

int exponent_within_limits(long exponent) {
    if (std::abs(exponent) > max_exponent)
        throw ExpressionTooLarge(fmt::format("it takes an exponent above {}", max_exponent));
    return static_cast<int>(exponent);
}

bool is_sum_node(Expression e) { return Builder::is(e, Operation::add) || Builder::is(e, Operation::subtract); }

// The positive number that the coefficients of a sum share, so that it leaves small integers; 1 for decimals.
Rational content_of(const std::vector<Rational>& numbers) {
    boost::multiprecision::cpp_int top = 0, bottom = 1;
    for (const Rational& number : numbers) {
        top = gcd(top, numerator(number));
        bottom = lcm(bottom, denominator(number));
    }
    if (bottom <= 1000 && bottom % 5 != 0) return {abs(top), bottom};
    const bool is_same = std::all_of(numbers.begin(), numbers.end(),
                                     [&](const Rational& number) { return abs(number) == abs(numbers.front()); });
    return is_same ? Rational(abs(numbers.front())) : Rational(1);
}

// The order of products in a node. The first product that is not a number gives a sum its sign.
bool before(const ProductSum::Product& a, const ProductSum::Product& b) { return a.factors < b.factors; }
bool is_negative_sum(const std::vector<ProductSum::Product>& products) {
    const auto first = std::min_element(products.begin(), products.end(), [](const auto& a, const auto& b) {
        return a.factors.empty() != b.factors.empty() ? b.factors.empty() : before(a, b);
    });
    return Builder::value(first->coefficient) < 0;
}

}  // namespace

ProductSum ProductSum::product(Graph& graph, const Expression& coefficient, Factors factors) {
    ProductSum result;
    result.graph_ = &graph;
    if (!coefficient.is_zero()) result.products_.push_back({coefficient, std::move(factors)});
    return result;
}

ProductSum ProductSum::number(Graph& graph, long top, long bottom) {
    return product(graph, graph.number(top, bottom), {});
}

ProductSum ProductSum::atom(Expression e) { return product(e.graph(), e.graph().number(1), {{e.id(), 1}}); }

bool ProductSum::is_number() const { return is_zero() || (is_single() && products_.front().factors.empty()); }

void ProductSum::add(const Expression& coefficient, const Factors& factors) {
    const auto like =
        std::find_if(products_.begin(), products_.end(), [&](const Product& p) { return p.factors == factors; });
    if (like == products_.end()) {
        if (products_.size() == max_products)
            throw ExpressionTooLarge(fmt::format("it takes more than {} terms in one sum", max_products));
        products_.push_back({coefficient, factors});
        return;
    }
    like->coefficient = like->coefficient + coefficient;
    if (like->coefficient.is_zero()) products_.erase(like);
}

ProductSum operator+(ProductSum a, const ProductSum& b) {
    if (a.is_zero()) return b;
    for (const auto& [coefficient, factors] : b.products_) a.add(coefficient, factors);
    return a;
}

ProductSum operator-(ProductSum a) {
    for (ProductSum::Product& product : a.products_) product.coefficient = -product.coefficient;
    return a;
}

ProductSum operator-(ProductSum a, const ProductSum& b) { return std::move(a) + -b; }

ProductSum operator*(const ProductSum& a, const ProductSum& b) {
    ProductSum result;
    for (const auto& [x, left] : a.products_) {
        for (const auto& [y, right] : b.products_) {
            Graph& graph = *a.graph_;
            ProductSum squares;  // of square roots
            ProductSum::Factors merged;
            auto i = left.begin(), j = right.begin();
            while (i != left.end() || j != right.end()) {
                ProductSum::Factor next = j == right.end() || (i != left.end() && i->atom <= j->atom) ? *i : *j;
                const bool is_both = i != left.end() && j != right.end() && i->atom == j->atom;
                if (is_both) next.exponent = exponent_within_limits(long{i->exponent} + j->exponent);
                const bool is_left = i != left.end() && i->atom == next.atom,
                           is_right = j != right.end() && j->atom == next.atom;
                if (is_left) ++i;
                if (is_right) ++j;
                if (next.exponent == 0) continue;
                const Expression atom(&graph, next.atom);
                if (Builder::is(atom, Operation::sqrt) && std::abs(next.exponent) > 1) {  // sqrt(u)^2 = u
                    const ProductSum square = power(ProductSum::from_part(Builder::first(atom)), next.exponent / 2);
                    squares = squares.is_zero() ? square : squares * square;
                    next.exponent %= 2;
                    if (next.exponent == 0) continue;
                }
                merged.push_back(next);
            }
            const ProductSum plain = ProductSum::product(graph, x * y, std::move(merged));
            result = std::move(result) + (squares.is_zero() ? plain : plain * squares);
        }
    }
    return result;
}

ProductSum operator/(const ProductSum& a, const ProductSum& b) {
    if (b.is_zero()) throw std::domain_error("division by zero");
    return a * power(b, -1);
}

ProductSum power(const ProductSum& base, int exponent) {
    const ProductSum whole = base.packed();
    if (whole.is_zero()) {
        if (exponent < 0) throw std::domain_error("division by zero");
        return whole;
    }
    const auto& [coefficient, factors] = whole.products().front();
    Graph& graph = coefficient.graph();
    const Expression number = power(coefficient, exponent);  // a very large power is not folded
    ProductSum result = number.is_number() ? ProductSum::product(graph, number, {}) : ProductSum::atom(number);
    for (const auto& [atom, one] : factors) {
        ProductSum factor = ProductSum::number(graph, 1);
        const Expression e(&graph, atom);
        const int all = exponent_within_limits(long{one} * exponent);
        if (Builder::is(e, Operation::sqrt)) {
            factor = power(ProductSum::from_part(Builder::first(e)), all / 2);
            if (all % 2 != 0) factor = factor * ProductSum::product(graph, graph.number(1), {{atom, all % 2}});
        } else {
            factor = ProductSum::product(graph, graph.number(1), {{atom, all}});
        }
        result = result * factor;
    }
    return exponent == 0 ? ProductSum::number(graph, 1) : result;
}

ProductSum ProductSum::collect(Expression expression, bool keeps_functions) {
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    std::vector<ProductSum> of(needed.size());
    Graph& graph = expression.graph();
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        if (!needed[id]) continue;
        const Graph::Node node = graph.node(id);
        const Expression e(&graph, id);
        const auto& a = of[is_leaf(node.operation) ? 0 : node.a];
        const auto& b = of[is_binary(node.operation) ? node.b : 0];
        if (keeps_functions && is_function(node.operation)) {
            of[id] = atom(e);
            continue;
        }
        switch (node.operation) {
            case Operation::number:
                of[id] = product(graph, e, {});
                break;
            case Operation::add:
                of[id] = a + b;
                break;
            case Operation::subtract:
                of[id] = a - b;
                break;
            case Operation::negate:
                of[id] = -a;
                break;
            case Operation::multiply:
                of[id] = a.is_number() || b.is_number() ? a * b : a.packed() * b.packed();
                break;
            case Operation::divide:
                of[id] = b.is_number() && !b.is_zero() ? a / b : a.packed() / b;
                break;
            case Operation::power:
                of[id] = power(a, node.exponent);
                break;
            case Operation::cos:
                of[id] = cosine_and_sine(a, graph).first;
                break;
            case Operation::sin:
                of[id] = cosine_and_sine(a, graph).second;
                break;
            case Operation::sqrt:
                of[id] = square_root(a);
                break;
            case Operation::pi:
            case Operation::symbol:
                of[id] = atom(e);
                break;
            case Operation::real_power:
                of[id] = atom(real_power(a.expression(graph), b.expression(graph)));
                break;
            default:
                of[id] = function(node.operation, a, graph);
        }
    }
    // Like the nodes, products stand in the order of their first factors.
    std::vector<Product>& products = of[expression.id()].products_;
    std::stable_sort(products.begin(), products.end(), before);
    return of[expression.id()];
}

Expression ProductSum::expression(Graph& graph) const {
    std::vector<const Product*> sorted;
    for (const Product& product : products_) sorted.push_back(&product);
    std::sort(sorted.begin(), sorted.end(), [](const Product* a, const Product* b) { return a->factors < b->factors; });
    Expression sum = graph.number(0);
    for (const Product* product : sorted) {
        Expression term = product->coefficient;
        for (const auto& [atom, exponent] : product->factors)
            term = term * achilles::power(Expression(&graph, atom), exponent);
        sum = sum + term;
    }
    return sum;
}

ProductSum ProductSum::packed() const {
    if (products_.size() < 2) return *this;
    Graph& graph = *graph_;
    std::vector<Rational> numbers;
    for (const Product& product : products_) numbers.push_back(Builder::value(product.coefficient));
    Rational content = content_of(numbers);
    if (is_negative_sum(products_)) content = -content;
    ProductSum rest = *this;
    for (Product& product : rest.products_)
        product.coefficient = Builder::number(graph, Rational(Builder::value(product.coefficient) / content));
    return ProductSum::product(graph, Builder::number(graph, content), {{rest.expression(graph).id(), 1}});
}

ProductSum ProductSum::without_squares() const {
    ProductSum result = *this;
    while (result.merge_squares()) {
    }
    return result;
}

// Replaces c u cos(a)^2 by c u - c u sin(a)^2 where that leaves fewer terms. False: nowhere.
bool ProductSum::merge_squares() {
    const auto like = [&](const Factors& factors) {
        return std::find_if(products_.begin(), products_.end(), [&](const Product& p) { return p.factors == factors; });
    };
    const auto added_terms = [&](const Factors& factors, const Expression& coefficient) {
        const auto same = like(factors);
        return same == products_.end() ? 1 : (same->coefficient + coefficient).is_zero() ? -1 : 0;
    };
    for (const Product& with_cosine : products_) {
        for (const Factor& factor : with_cosine.factors) {
            const Expression cosine(graph_, factor.atom), coefficient = with_cosine.coefficient;
            if (factor.exponent != 2 || !Builder::is(cosine, Operation::cos)) continue;
            Factors rest = with_cosine.factors;
            std::erase(rest, factor);
            const ProductSum sine = atom(apply(Operation::sin, Builder::first(cosine)));
            const Factors with_sine = (product(*graph_, coefficient, rest) * power(sine, 2)).products_[0].factors;
            if (added_terms(with_sine, -coefficient) + added_terms(rest, coefficient) > 0) continue;
            const Factors old = with_cosine.factors;  // add() moves the products
            add(-coefficient, old);
            add(-coefficient, with_sine);
            add(coefficient, rest);
            return true;
        }
    }
    return false;
}

bool ProductSum::depends_on(std::span<const std::uint32_t> slots) const {
    for (const Product& product : products_)
        for (const Factor& factor : product.factors)
            if (achilles::depends_on(Expression(graph_, factor.atom), slots)) return true;
    return false;
}

ProductSum ProductSum::derivative(std::uint32_t slot) const {
    ProductSum sum;
    for (const auto& [coefficient, factors] : products_) {
        for (std::size_t i = 0; i < factors.size(); ++i) {
            const Expression atom(graph_, factors[i].atom);
            const std::uint32_t slots[] = {slot};
            if (!achilles::depends_on(atom, slots)) continue;
            Factors rest = factors;
            if (--rest[i].exponent == 0) rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
            const Expression front = coefficient * graph_->number(factors[i].exponent);
            sum = std::move(sum) + product(*graph_, front, std::move(rest)) * from(achilles::derivative(atom, slot));
        }
    }
    return sum;
}

ProductSum square_root(const ProductSum& square) {
    if (square.is_zero()) return square;
    const ProductSum whole = square.packed();
    const auto& [coefficient, factors] = whole.products().front();
    Graph& graph = coefficient.graph();
    const Rational& number = Builder::value(coefficient);
    if (number > 0) {
        const boost::multiprecision::cpp_int top = sqrt(numerator(number)), bottom = sqrt(denominator(number));
        if (Rational(top * top, bottom * bottom) == number) {
            const ProductSum root = ProductSum::from(Builder::number(graph, Rational(top, bottom)));
            if (factors.empty()) return root;
            return root * ProductSum::function(Operation::sqrt, whole / power(root, 2), graph);
        }
    }
    return ProductSum::function(Operation::sqrt, square, graph);
}

ProductSum ProductSum::function(Operation function, const ProductSum& argument, Graph& graph) {
    const Expression value = apply(function, argument.expression(graph));
    if (value.is_number()) return product(graph, value, {});
    return Builder::is(value, Operation::negate) ? -atom(Builder::first(value)) : atom(value);
}

std::pair<ProductSum, ProductSum> cosine_and_sine(const ProductSum& angle, Graph& graph) {
    ProductSum rest = angle, tangent;
    int quarters = 0;
    bool is_negative_tangent = false;
    for (const auto& [coefficient, factors] : angle.products()) {
        if (factors.size() != 1 || factors[0].exponent != 1) continue;
        const Expression atom(&graph, factors[0].atom);
        const Rational& number = Builder::value(coefficient);
        const ProductSum term = ProductSum::product(graph, coefficient, factors);
        if (Builder::is(atom, Operation::pi) && denominator(Rational(2 * number)) == 1) {
            quarters = static_cast<int>(numerator(Rational(2 * number)) % 4);
            rest = rest - term;
        } else if (Builder::is(atom, Operation::atan) && abs(number) == 1 && tangent.is_zero()) {
            tangent = ProductSum::from_part(Builder::first(atom));
            is_negative_tangent = number < 0;
            rest = rest - term;
        }
    }
    const ProductSum one = ProductSum::number(graph, 1);
    ProductSum c = one, s;
    if (!rest.is_zero()) {
        const bool is_negative = is_negative_sum(rest.products());
        if (is_negative) rest = -rest;
        c = ProductSum::function(Operation::cos, rest, graph);
        s = ProductSum::function(Operation::sin, rest, graph);
        if (is_negative) s = -s;
    }
    if (!tangent.is_zero()) {
        const ProductSum length = square_root(one + power(tangent, 2));
        const ProductSum ct = one / length, st = (is_negative_tangent ? -tangent : tangent) / length;
        std::tie(c, s) = std::pair(c * ct - s * st, s * ct + c * st);
    }
    for (int i = 0; i < (quarters + 4) % 4; ++i) std::tie(c, s) = std::pair(-s, c);
    return {c, s};
}

// ---- writing ----

namespace {

using Rank = ProductSumWriter::Rank;

// A positive coefficient p/q as the numbers before and after a product: 3 and 2 for 3*x/2. Decimals stay decimals.
std::pair<std::string, std::string> front_and_divisor(const Rational& size) {
    const boost::multiprecision::cpp_int top = numerator(size), bottom = denominator(size);
    boost::multiprecision::cpp_int rest = bottom;
    int fives = 0;
    while (rest % 5 == 0) rest /= 5, ++fives;
    while (rest % 2 == 0) rest /= 2;
    const bool is_fraction = fives == 0 && bottom <= 64, is_short = top <= 1000000 && bottom <= 1000000;
    if (bottom == 1 && is_short) return {top == 1 ? "" : top.str(), ""};
    if (is_fraction || (rest != 1 && is_short)) return {top == 1 ? "" : top.str(), bottom.str()};
    return {fmt::format("{}", size.convert_to<double>()), ""};
}

// A sum of terms with their signs, which starts with a positive term if there is one.
std::string joined(std::vector<std::pair<bool, std::string>> terms) {
    const auto plus = std::find_if(terms.begin(), terms.end(), [](const auto& term) { return !term.first; });
    if (plus != terms.end()) std::rotate(terms.begin(), plus, plus + 1);
    std::string result;
    for (const auto& [is_negative, text] : terms) {
        result += (result.empty() ? is_negative ? "-" : "" : is_negative ? " - " : " + ") + text;
        if (result.size() > max_text)
            throw ExpressionTooLarge(fmt::format("it takes more than {} characters as a text", max_text));
    }
    return result;
}

// The factors that two products share, with the smaller exponents.
ProductSum::Factors common_factors(const ProductSum::Factors& a, const ProductSum::Factors& b) {
    ProductSum::Factors common;
    for (const auto& [atom, exponent] : a)
        for (const ProductSum::Factor& other : b)
            if (other.atom == atom && (other.exponent > 0) == (exponent > 0))
                common.push_back(
                    {atom, exponent > 0 ? std::min(exponent, other.exponent) : std::max(exponent, other.exponent)});
    return common;
}

std::string with_exponent(const std::string& base, int exponent) {
    return exponent == 1 ? base : fmt::format("{}^{}", base, exponent);
}

}  // namespace

Rank ProductSumWriter::rank(Expression expression) {
    const auto [known, is_new] = known_ranks_.try_emplace(expression.id(), Rank::constant);
    if (!is_new) return known->second;
    Rank& highest = known->second;
    const std::vector<bool> needed = reachable(std::span(&expression, 1));
    for (std::uint32_t id = 0; id < needed.size(); ++id) {
        const Graph::Node& node = expression.graph().node(id);
        if (needed[id] && node.operation == Operation::symbol) highest = std::max(highest, ranks_[node.a]);
    }
    return highest;
}

// The text of a factor, in parentheses if it is a sum.
std::string ProductSumWriter::base(Expression atom) {
    const auto known = bases_.find(atom.id());
    return known != bases_.end() ? known->second : bases_.emplace(atom.id(), factor_text(atom)).first->second;
}

std::string ProductSumWriter::factor_text(Expression atom) {
    if (Builder::is(atom, Operation::symbol)) return names_[Builder::node(atom).a];
    if (Builder::is(atom, Operation::pi)) return "pi";
    if (is_sum_node(atom)) return fmt::format("({})", text(ProductSum::from(atom)));
    if (Builder::is(atom, Operation::real_power))
        return fmt::format("({})^({})", text(ProductSum::from(Builder::first(atom))),
                           text(ProductSum::from(Builder::second(atom))));
    for (const Function& function : functions)
        if (function.operation == Builder::node(atom).operation)
            return fmt::format("{}({})", function.name, text(ProductSum::from(Builder::first(atom))));
    return fmt::format("({})", to_text(atom, names_));
}

// |coefficient| * factors, with `bracket`, a sum of constants, among the constant factors.
std::string ProductSumWriter::product(const Expression& coefficient, const ProductSum::Factors& factors,
                                      const std::string& bracket) {
    struct Written {
        int order;
        std::uint32_t slot;
        std::string base;
        int exponent;
    };
    std::vector<Written> written;
    for (const auto& [atom, exponent] : factors) {
        const Expression e(&graph_, atom);
        const bool is_symbol = is_leaf(Builder::node(e).operation);
        const Rank highest = rank(e);
        const int order = 2 * static_cast<int>(highest) + (is_symbol ? 0 : 1);
        written.push_back(
            {highest == Rank::rate ? 4 : order, is_symbol ? Builder::node(e).a : atom, base(e), exponent});
    }
    std::stable_sort(written.begin(), written.end(), [](const Written& a, const Written& b) {
        return std::pair(a.order, a.slot) < std::pair(b.order, b.slot);
    });
    const auto [front, divisor] = front_and_divisor(abs(Builder::value(coefficient)));
    std::string result = front;
    const auto multiply = [&](const std::string& factor) { result += (result.empty() ? "" : "*") + factor; };
    const auto divide = [&](const std::string& factor) { result += (result.empty() ? "1/" : "/") + factor; };
    bool is_divided = divisor.empty();
    const auto add_constants_or_others = [&](bool is_constant) {
        for (const bool is_above : {true, false})
            for (const Written& one : written)
                if ((one.order < 2) == is_constant && (one.exponent > 0) == is_above)
                    is_above ? multiply(with_exponent(one.base, one.exponent))
                             : divide(with_exponent(one.base, -one.exponent));
    };
    if (!bracket.empty()) multiply("(" + bracket + ")");
    add_constants_or_others(true);
    if (!is_divided && !result.empty()) divide(divisor), is_divided = true;
    add_constants_or_others(false);
    if (!is_divided) divide(divisor);
    return result.empty() ? "1" : result;
}

// Products with the same factors that change in a run, as those factors times a bracket of constants.
std::string ProductSumWriter::group(const Group& group, bool& is_negative) {
    ProductSum::Factors shared = group.constants.front().factors;
    std::vector<Rational> numbers;
    for (const auto& [coefficient, factors] : group.constants) {
        numbers.push_back(Builder::value(coefficient));
        shared = common_factors(shared, factors);
    }
    is_negative = std::all_of(numbers.begin(), numbers.end(), [](const Rational& number) { return number < 0; });
    const auto with_shared = [&](const ProductSum::Factors& constants) {
        ProductSum::Factors all = group.factors;
        all.insert(all.end(), constants.begin(), constants.end());
        return all;
    };
    if (group.constants.size() == 1)
        return product(group.constants[0].coefficient, with_shared(group.constants[0].factors), "");
    const Rational content = is_negative ? Rational(-content_of(numbers)) : content_of(numbers);
    std::vector<std::pair<bool, std::string>> terms;
    for (const auto& [coefficient, factors] : group.constants) {
        ProductSum::Factors rest;
        for (ProductSum::Factor factor : factors) {
            for (const auto& [atom, exponent] : shared)
                if (atom == factor.atom) factor.exponent -= exponent;
            if (factor.exponent != 0) rest.push_back(factor);
        }
        const Rational number = Builder::value(coefficient) / content;
        terms.emplace_back(number < 0, product(Builder::number(graph_, number), rest, ""));
    }
    return product(Builder::number(graph_, content), with_shared(shared), joined(terms));
}

std::string ProductSumWriter::text(const ProductSum& sum) {
    if (sum.is_zero()) return "0";
    for (const auto& [coefficient, factors] : sum.products()) {  // a sum in parentheses alone needs none
        const Expression atom(&graph_, factors.empty() ? coefficient.id() : factors.front().atom);
        if (factors.size() != 1 || factors[0].exponent != 1 || !is_sum_node(atom)) continue;
        if (abs(Builder::value(coefficient)) != 1) continue;
        ProductSum others;
        for (const ProductSum::Product& other : sum.products())
            if (other.factors != factors) others = others + sum.term(other);
        return text(others + ProductSum::product(graph_, coefficient, {}) * ProductSum::from(atom));
    }
    std::vector<Group> groups;
    for (const auto& [coefficient, factors] : sum.products()) {
        ProductSum::Factors constant, other;
        for (const ProductSum::Factor& factor : factors)
            (rank({&graph_, factor.atom}) == Rank::constant ? constant : other).push_back(factor);
        auto like = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.factors == other; });
        if (other.empty() || like == groups.end()) like = groups.insert(groups.end(), Group{other, {}});
        like->constants.push_back({coefficient, constant});
    }
    std::vector<std::pair<bool, std::string>> terms;
    for (const Group& each : groups) {
        bool is_negative = false;
        std::string written = group(each, is_negative);
        terms.emplace_back(is_negative, std::move(written));
    }
    return joined(terms);
}

}  // namespace achilles
