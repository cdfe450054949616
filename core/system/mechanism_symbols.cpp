// The symbols of a mechanism: coordinates, rates, parameters, time and the abscissa of curves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "system/mechanism.hpp"

namespace achilles {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace

MechanismSymbols::MechanismSymbols(const SystemDescription& system, const std::vector<std::string>& contacts)
    : graph_(std::make_unique<Graph>()) {
    using Rank = ProductSumWriter::Rank;
    std::vector<std::string> names;
    std::vector<Rank> ranks;
    const auto add = [&](const std::string& name, Rank rank, double value) {
        names.push_back(name);
        ranks.push_back(rank);
        start_.push_back(value);
        return static_cast<std::uint32_t>(names.size() - 1);
    };
    const auto symbol = [&](std::uint32_t slot) { return graph_->symbol(slot); };
    std::vector<std::uint32_t> q, v;
    Scope constants;
    for (const CoordinateDescription& c : system.coordinates) q.push_back(add(c.name, Rank::state, c.start));
    for (const CoordinateDescription& c : system.coordinates) v.push_back(add(c.name + "'", Rank::rate, c.rate));
    // Nodes of coordinates come first, so that they lead in sums: z - z0 rather than z0 - z.
    for (std::uint32_t slot = 0; slot < names.size(); ++slot) symbol(slot);
    for (const ParameterDescription& p : system.parameters)
        constants.allowed.emplace(p.name, symbol(add(p.name, Rank::constant, p.value)));
    for (const DerivedDescription& derived : system.derived) {
        Scope scope = constants;
        allow_units(scope, derived.unit, *graph_);
        double value = no_value;
        try {
            value = achilles::value_of(parse(derived.definition.text, scope, *graph_), start_);
        } catch (const ParseError&) {  // reported elsewhere
        }
        constants.allowed.emplace(derived.name, symbol(add(derived.name, Rank::constant, value)));
    }
    const std::uint32_t time = add("t", Rank::state, system.options.start_time);
    // A curve is drawn with a name for its abscissa that the file does not use.
    std::string abscissa = "x";
    for (const char* other : {"s", "u", "w", "xi"})
        if (std::find(names.begin(), names.end(), abscissa) != names.end()) abscissa = other;
    while (std::find(names.begin(), names.end(), abscissa) != names.end()) abscissa += "_";
    abscissa_ = add(abscissa, Rank::state, no_value);
    for (const auto& [name, expression] : constants.allowed)
        constants.forbidden.emplace(name + "'", fmt::format("'{}' is a parameter: it has no rate", name));

    Scope timed = constants;
    timed.allowed.emplace("t", symbol(time));
    Scope curve = timed;
    curve.allowed.insert_or_assign("x", symbol(abscissa_));
    constants.forbidden.emplace("t", "'t' is not allowed here: use only parameters");
    Scope positions = timed, rates = timed;
    for (Scope* scope : {&constants, &timed, &curve, &positions})
        scope->forbidden.emplace("held",
                                 "held(NAME) is allowed only in a force, a torque and a damper; write what else "
                                 "depends on contact as a [[force]]");
    for (const std::string& contact : contacts)
        rates.of_contact["held"].emplace(contact, symbol(add("held(" + contact + ")", Rank::constant, 0.0)));
    allow_units(positions, "rad", *graph_);
    allow_units(rates, "rad", *graph_);
    for (std::size_t i = 0; i < q.size(); ++i) {
        const std::string &name = names[q[i]], &rate = names[v[i]];
        for (Scope* scope : {&positions, &rates}) scope->allowed.emplace(name, symbol(q[i]));
        rates.allowed.emplace(rate, symbol(v[i]));
        positions.forbidden.emplace(
            rate, fmt::format("the rate {} is not allowed here: use only coordinates, parameters and t", rate));
        for (Scope* scope : {&constants, &timed, &curve}) {
            scope->forbidden.emplace(name, fmt::format("the coordinate '{}' is not allowed here: use only parameters{}",
                                                       name, scope == &constants ? "" : " and t"));
            scope->forbidden.emplace(rate, fmt::format("the rate {} is not allowed here: use only parameters{}", rate,
                                                       scope == &constants ? "" : " and t"));
        }
        for (Scope* scope : {&positions, &rates})
            scope->forbidden.emplace(rate + "'", fmt::format("the acceleration {}' is not allowed in an expression: it "
                                                             "follows from the equations of motion",
                                                             rate));
    }
    scopes_[static_cast<std::size_t>(Allowed::constants)] = std::move(constants);
    scopes_[static_cast<std::size_t>(Allowed::constants_and_time)] = std::move(timed);
    scopes_[static_cast<std::size_t>(Allowed::positions)] = std::move(positions);
    scopes_[static_cast<std::size_t>(Allowed::rates)] = std::move(rates);
    scopes_[static_cast<std::size_t>(Allowed::curve)] = std::move(curve);
    kinematics_ = std::make_unique<Kinematics>(*graph_, std::move(q), std::move(v), time);
    writer_ = std::make_unique<ProductSumWriter>(*graph_, std::move(names), std::move(ranks));
}

double MechanismSymbols::at_start(const ProductSum& sum) const { return value_of(sum.expression(*graph_), start_); }

bool MechanismSymbols::is_constant(const ProductSum& sum) const {
    return writer_->rank(sum.expression(*graph_)) == ProductSumWriter::Rank::constant;
}

ProductSum MechanismSymbols::positive_root(const ProductSum& square) const {
    const ProductSum root = square_root(square);
    if (!square.is_single()) return root;
    // c x^2 y^4 is the square of sqrt(c) x y^2.
    const auto& [coefficient, factors] = square.products().front();
    ProductSum base = square_root(ProductSum::from(coefficient));
    for (const auto& [atom, exponent] : factors) {
        if (exponent % 2 != 0) return root;
        base = base * power(ProductSum::from(Expression(graph_.get(), atom)), exponent / 2);
    }
    const double value = at_start(base);
    if (!(value != 0.0) || !is_constant(base)) return root;
    return value < 0.0 ? -base : base;
}

LocalPoint MechanismSymbols::direction(const PlacedShape& shape) const {
    const ProductSum x = shape.corners[1].x - shape.corners[0].x, y = shape.corners[1].y - shape.corners[0].y;
    const auto sign = [&](const ProductSum& size) { return number(at_start(size) < 0.0 ? -1 : 1); };
    if (y.is_zero() && !x.is_zero()) return {sign(x), {}};
    if (x.is_zero() && !y.is_zero()) return {{}, sign(y)};
    const ProductSum length = positive_root((x * x + y * y).without_squares());
    if (length.is_zero()) return {};
    return {x / length, y / length};
}

ProductSum MechanismSymbols::angle_of(const LocalPoint& direction) const {
    const ProductSum pi = ProductSum::from(graph_->pi()), half = number(1, 2);
    const double x = at_start(direction.x), y = at_start(direction.y);
    if (direction.x.is_zero()) return y < 0.0 ? -(half * pi) : half * pi;
    if (direction.y.is_zero()) return x < 0.0 ? pi : ProductSum{};
    // (cos(a), sin(a)) has the angle a.
    const Graph::Node& node = graph_->node(direction.x.expression(*graph_).id());
    if (node.operation == Operation::cos) {
        const ProductSum angle = ProductSum::from(Expression(graph_.get(), node.a));
        if (cosine_and_sine(angle, *graph_).second == direction.y) return angle;
    }
    const ProductSum turn = ProductSum::function(Operation::atan, direction.y.packed() / direction.x, *graph_);
    return x < 0.0 ? turn + pi : turn;
}

bool MechanismSymbols::depends_on_time(const ProductSum& sum) const {
    const std::uint32_t slots[] = {kinematics_->time()};
    return sum.depends_on(slots);
}

}  // namespace achilles
