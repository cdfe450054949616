#include "system/description.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "expression/nearest.hpp"
#include "number/subnormal.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

// The whole text as one finite or infinite number; nothing where it is anything else.
std::optional<double> plain_number(std::string_view text) {
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

InputError SystemDescription::error(Location at, const std::string& message, const std::string& hint) const {
    return {file, at, message, hint, line_of(source_text, at.line)};
}

Location place_in(const Text& text, std::size_t offset) {
    Location at = text.at;
    for (std::size_t i = 0; i < offset && i < text.text.size(); ++i) {
        if ((static_cast<unsigned char>(text.text[i]) & 0xC0) == 0x80) continue;  // inside a UTF-8 character
        ++at.column;
        if (text.text[i] == '\n') at = {at.line + 1, 1};
    }
    return at;
}

void assign(SystemDescription& description, std::string_view name_value) {
    const auto refuse = [&](const std::string& why, const std::string& hint = {}) {
        return InputError("--set " + shown(name_value), {}, why, hint);
    };
    const std::size_t equals = name_value.find('=');
    if (equals == name_value.npos) {
        throw refuse("a value is missing", "write --set NAME=VALUE, as in --set g=9.81 or --set x'=1.5");
    }
    const std::string name(trimmed(name_value.substr(0, equals))), written(name_value.substr(equals + 1));
    const std::optional<double> value = plain_number(written);
    if (!value || !std::isfinite(*value)) throw refuse(fmt::format("'{}' is not a finite number", shown(written)));

    std::vector<std::string> names;
    for (CoordinateDescription& coordinate : description.coordinates) {
        if (coordinate.name == name) return void(coordinate.start = *value);
        if (coordinate.name + "'" == name) return void(coordinate.rate = *value);
        names.insert(names.end(), {coordinate.name, coordinate.name + "'"});
    }
    for (ParameterDescription& parameter : description.parameters) {
        if (parameter.name == name && is_subnormal(*value))
            throw refuse(subnormal_parameter(name, *value), subnormal_hint);
        if (parameter.name == name) return void(parameter.value = *value);
        names.push_back(parameter.name);
    }
    throw refuse(fmt::format("'{}' is no parameter, coordinate or rate of this system{}", shown(name),
                             did_you_mean(name, names)));
}

std::vector<Text> texts_of(const DrawingDescription& drawing) {
    using Shape = DrawingDescription::Shape;
    std::vector<Text> texts;
    for (const auto& point : drawing.points) texts.insert(texts.end(), point.begin(), point.end());
    if (drawing.shape == Shape::disc) texts.push_back(drawing.radius);
    if (drawing.shape == Shape::curve)
        texts.insert(texts.end(), drawing.over_limits.begin(), drawing.over_limits.end());
    if (!drawing.width.text.empty()) texts.push_back(drawing.width);
    return texts;
}

}  // namespace achilles
