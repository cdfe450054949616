#include "system/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "expression/parse.hpp"
#include "system/expand.hpp"

namespace achilles {

namespace {

// A product of powers of kg, m, s and rad.
struct Unit {
    std::array<double, 4> powers{};
    friend bool operator==(const Unit&, const Unit&) = default;
    bool is_plain() const { return *this == Unit{}; }
};
// nullopt: unknown.
using MaybeUnit = std::optional<Unit>;
constexpr std::array<const char*, 4> base_names{"kg", "m", "s", "rad"};

const std::map<std::string, Unit, std::less<>>& known_units() {
    static const std::map<std::string, Unit, std::less<>> units{
        {"kg", {{1, 0, 0, 0}}},  {"m", {{0, 1, 0, 0}}},   {"s", {{0, 0, 1, 0}}},
        {"rad", {{0, 0, 0, 1}}}, {"N", {{1, 1, -2, 0}}},  {"J", {{1, 2, -2, 0}}},
        {"W", {{1, 2, -3, 0}}},  {"Hz", {{0, 0, -1, 0}}}, {"Pa", {{1, -1, -2, 0}}}};
    return units;
}

// a b^exponent. The angle is dropped from units with a mass or a length.
MaybeUnit product(const MaybeUnit& a, const MaybeUnit& b, double exponent) {
    if (!a || !b) return std::nullopt;
    Unit result = *a;
    for (std::size_t i = 0; i < result.powers.size(); ++i) result.powers[i] += exponent * b->powers[i];
    if (result.powers[0] != 0.0 || result.powers[1] != 0.0) result.powers[3] = 0.0;
    return result;
}

MaybeUnit sum(const MaybeUnit& a, const MaybeUnit& b) {
    if (!a || !b) return std::nullopt;
    if (a->is_plain()) return b;
    return b->is_plain() || *a == *b ? a : std::nullopt;
}

// Reads "kg*m^2/s^2", "N m", "1/m": each slash applies to the next factor only.
MaybeUnit read(std::string_view text) {
    if (text.empty()) return std::nullopt;
    MaybeUnit result = Unit{};
    double sign = 1.0;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (c == ' ' || c == '*' || c == '.') {
            ++at;
            continue;
        }
        if (c == '/') {
            sign = -1.0;
            ++at;
            continue;
        }
        std::size_t end = at;
        while (end < text.size() && std::isalpha(static_cast<unsigned char>(text[end])) != 0) ++end;
        const auto known = known_units().find(text.substr(at, end - at));
        if (end == at && c == '1') {
            ++at;
            continue;
        }
        if (known == known_units().end()) return std::nullopt;
        int exponent = 1;
        if (end < text.size() && text[end] == '^') {
            const auto [last, problem] = std::from_chars(text.data() + end + 1, text.data() + text.size(), exponent);
            if (problem != std::errc() || std::abs(exponent) > 9) return std::nullopt;
            end = static_cast<std::size_t>(last - text.data());
        }
        result = product(result, known->second, sign * exponent);
        sign = 1.0;
        at = end;
    }
    return result;
}

std::string written(const Unit& unit) {
    for (const char* name : {"J", "N", "W"})
        if (unit == known_units().at(name)) return name;
    std::string above, below;
    int factors_below = 0;
    for (std::size_t i = 0; i < unit.powers.size(); ++i) {
        const double power = unit.powers[i], size = std::abs(power);
        if (power == 0.0) continue;
        if (size != std::round(size) || size > 9.0) return "";
        std::string& side = power > 0.0 ? above : below;
        if (power < 0.0) ++factors_below;
        side += fmt::format("{}{}{}", side.empty() ? "" : "*", base_names[i],
                            size == 1.0 ? "" : fmt::format("^{}", static_cast<int>(size)));
    }
    if (below.empty()) return above;
    return (above.empty() ? "1" : above) + "/" + (factors_below > 1 ? "(" + below + ")" : below);
}

// The names of a system as symbols of a separate graph, with the unit of each.
class SymbolUnits {
 public:
    // Of the derived quantities, reads only those that the expression may name, because kinetic energies are long.
    SymbolUnits(const SystemDescription& description, std::string_view expression) : description_(description) {
        const auto names = [&](std::string_view name) { return expression.find(name) != std::string_view::npos; };
        const MaybeUnit second = read("s");
        bool has_units = false;
        for (const CoordinateDescription& c : description.coordinates) {
            has_units = has_units || !c.unit.empty();
            const MaybeUnit unit = read(c.unit);
            add(c.name, unit);
            add(c.name + "'", product(unit, second, -1.0));
        }
        for (const ParameterDescription& p : description.parameters) add(p.name, read(p.unit));
        add("t", has_units ? second : std::nullopt);
        for (const DerivedDescription& d : description.derived)
            add(d.name, d.unit.empty() ? of(d.definition.text) : read(d.unit));
        constexpr const char* energies[] = {"energy", "work", "loss", "power", "lambda", "heat", "friction_force"};
        const bool has_energy = std::any_of(std::begin(energies), std::end(energies), names);
        const bool has_slip = names("slip") || names("friction_force");
        const bool has_gap = has_energy || has_slip || names("gap");
        MaybeUnit energy = has_energy ? of(description.kinetic.text) : std::nullopt;
        if (has_energy && !energy) energy = of(description.potential.text);
        for (const char* name : {"energy", "work", "loss"}) add(name, energy);
        add("power", product(energy, second, -1.0));
        std::vector<MaybeUnit> gap_rates;
        for (std::size_t i = 0; i < description.constraints.size(); ++i) {
            const MaybeUnit gap = has_gap ? of(description.constraints[i].gap.text) : std::nullopt;
            add(output_names(description, "gap")[i], gap);
            gap_rates.push_back(product(gap, second, -1.0));
            add(output_names(description, "gap'")[i], gap_rates.back());
            add(output_names(description, "gap''")[i], product(gap, second, -2.0));
            add(output_names(description, "lambda")[i], product(energy, gap, -1.0));
        }
        if (!description.has_friction()) return;
        add("heat", energy);
        const std::vector<SlidingPlace> places = sliding_places(description);
        for (std::size_t i = 0; i < places.size(); ++i) {  // the friction force times the slip is a power
            MaybeUnit slip = has_slip ? of(places[i].slip->text) : std::nullopt;
            // The slip of a contact is scaled like its gap; as written it may add lengths times angles to lengths.
            if (!slip && !is_joint(places[i].number)) slip = gap_rates[places[i].number];
            const MaybeUnit force = product(product(energy, second, -1.0), slip, -1.0);
            add(sliding_names(description, "friction_force")[i], force);
            add(sliding_names(description, "slip")[i], slip);
        }
    }

    MaybeUnit of(std::string_view text) {
        try {
            return unit_of(parse(with_body_values(description_, scope_, {std::string(text), {}}).text, scope_, graph_));
        } catch (const Mistake&) {  // an unknown name of a body
            return std::nullopt;
        } catch (const ParseError&) {
            return std::nullopt;
        } catch (const ExpressionTooLarge&) {
            return std::nullopt;
        }
    }

 private:
    void add(const std::string& name, const MaybeUnit& unit) {
        scope_.allowed.emplace(name, graph_.symbol(static_cast<std::uint32_t>(symbols_.size())));
        symbols_.push_back(unit);
    }

    MaybeUnit unit_of(Expression expression) {
        // Operands have smaller ids than their node.
        for (auto id = static_cast<std::uint32_t>(nodes_.size()); id <= expression.id(); ++id)
            nodes_.push_back(unit_of(graph_.node(id)));
        return nodes_[expression.id()];
    }

    MaybeUnit unit_of(const Graph::Node& node) {
        switch (node.operation) {
            case Operation::symbol:
                return symbols_[node.a];
            case Operation::add:
            case Operation::subtract:
                return sum(nodes_[node.a], nodes_[node.b]);
            case Operation::multiply:
                return product(nodes_[node.a], nodes_[node.b], 1.0);
            case Operation::divide:
                return product(nodes_[node.a], nodes_[node.b], -1.0);
            case Operation::negate:
                return nodes_[node.a];
            case Operation::power:
                return product(Unit{}, nodes_[node.a], node.exponent);
            case Operation::real_power: {
                const double exponent = value_of_constant({&graph_, node.b});
                return std::isfinite(exponent) ? product(Unit{}, nodes_[node.a], exponent) : std::nullopt;
            }
            case Operation::sqrt:
                return product(Unit{}, nodes_[node.a], 0.5);
            case Operation::asin:
            case Operation::acos:
            case Operation::atan:
                return read("rad");
            default:
                return Unit{};  // numbers, and functions whose values are numbers
        }
    }

    const SystemDescription& description_;
    Graph graph_;
    Scope scope_;
    std::vector<MaybeUnit> symbols_, nodes_;
};

}  // namespace

std::string unit_of_expression(const SystemDescription& description, std::string_view expression) {
    const MaybeUnit unit = SymbolUnits(description, expression).of(expression);
    if (!unit) return "";
    const std::string text = written(*unit);
    const std::size_t begin = std::min(expression.find_first_not_of(' '), expression.size());
    const std::string_view word = expression.substr(begin, expression.find_last_not_of(' ') + 1 - begin);
    std::vector<std::string> forces = output_names(description, "lambda");
    for (const std::string& force : sliding_names(description, "friction_force")) forces.push_back(force);
    const bool is_force = std::find(forces.begin(), forces.end(), word) != forces.end();
    return is_force && text == "J" ? "N*m" : text;
}

std::string unit_of_quotient(std::string_view above, std::string_view below) {
    if (below.empty()) return std::string(above);
    const MaybeUnit unit = product(read(above), read(below), -1.0);
    return unit ? written(*unit) : "";
}

namespace {

// m/s² becomes m/s^2.
std::string with_plain_powers(std::string unit) {
    for (const auto& [sign, right] : {std::pair{"\u00b2", "^2"}, std::pair{"\u00b3", "^3"}, std::pair{"\u00b7", "*"}})
        for (std::size_t i = unit.find(sign); i != std::string::npos; i = unit.find(sign))
            unit.replace(i, std::string_view(sign).size(), right);
    return unit;
}

}  // namespace

std::optional<ValueWithUnit> measured(std::string_view text) {
    constexpr std::array<std::string_view, 36> words{
        "kg", "g", "mg", "t",  "m", "mm", "cm", "dm",  "km", "um",  "s",   "ms",  "us",   "min", "h",  "N",  "kN", "mN",
        "Nm", "J", "kJ", "mJ", "W", "kW", "Hz", "kHz", "Pa", "kPa", "MPa", "rad", "mrad", "rpm", "in", "ft", "K",  "A"};
    ValueWithUnit result;
    std::string plain(text);
    std::replace(plain.begin(), plain.end(), ',', '.');
    const std::size_t at = plain.find_first_not_of(" \t");
    if (at == plain.npos || std::string_view("+-.0123456789").find(plain[at]) == std::string_view::npos)
        return std::nullopt;
    const char* const first = plain.data() + at + (plain[at] == '+' ? 1 : 0);
    double value = 0.0;
    const auto [last, problem] = std::from_chars(first, plain.data() + plain.size(), value);
    if (problem != std::errc()) return std::nullopt;
    result.number.assign(first, last);
    result.unit = with_plain_powers(plain.substr(static_cast<std::size_t>(last - plain.data())));
    result.unit.erase(0, std::min(result.unit.find_first_not_of(" \t*"), result.unit.size()));
    result.unit.erase(result.unit.find_last_not_of(" \t") + 1);
    const std::vector<std::string> names = names_in(result.unit);
    const bool is_unit = !names.empty() && std::all_of(names.begin(), names.end(), [&](const std::string& name) {
        return std::find(words.begin(), words.end(), name) != words.end();
    });
    const bool has_signs =
        result.unit.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789*/^-() ") !=
        std::string::npos;
    if (!is_unit || has_signs || !std::isalpha(static_cast<unsigned char>(result.unit[0]))) return std::nullopt;
    return result;
}

std::string without_unit(const ValueWithUnit& typed, std::string_view name, std::string_view unit,
                         const std::string& right) {
    if (unit.empty()) return fmt::format("{} has no unit here: write the number alone", name);
    const std::string own = with_plain_powers(std::string(unit));
    const MaybeUnit known = read(typed.unit);
    if (typed.unit == own || (known && known == read(own))) return "write " + right;
    return fmt::format("{} is in {}: convert {} {} and write the number alone", name, unit, typed.number, typed.unit);
}

}  // namespace achilles
