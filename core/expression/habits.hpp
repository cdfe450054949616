// What people write who know other languages, and what stands for it here. Endings of messages; "" where there is nothing to say.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace achilles {

struct Habit {
    std::string_view written, instead;  // what people write, and a sentence
    std::string_view right = {};        // what stands for it, where one sign does
};
// The sign at the start of the rest of a text, where it has no meaning here; null where it has one.
const Habit* sign_at(std::string_view rest);
// Of a sign that has no meaning here, at the start of the rest of a text: "; write '*' for a product" of a dot.
std::string instead_of_sign(std::string_view rest);
// Of a name that has none: "; the gap is called gap" of h, where that is known.
std::string instead_of_name(std::string_view name, const std::function<bool(std::string_view)>& is_known);
// Of a function that has corners or jumps: "sqrt(x^2 + w^2) is nearly |x|, with a small w" of abs. A sentence of its own.
std::string_view instead_of_corner(std::string_view name);

}  // namespace achilles
