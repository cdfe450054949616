// What a view plots: its expressions, what they are called and in which units they are shown.
#include <algorithm>

#include "figure/compose.hpp"
#include "figure/label.hpp"
#include "figure/shown_unit.hpp"
#include "system/units.hpp"

namespace achilles {

std::string name_of(const ViewDescription& view) {
    std::string name;
    for (const Text& y : view.y) name += (name.empty() ? "" : ", ") + y.text;
    return view.x.text == "t" ? name : name + " over " + view.x.text;
}

std::string title_of(const ViewDescription& view) {
    const bool is_word = view.name == "gap";  // and is read as one
    return view.name == name_of(view) && !is_word ? typeset(view.name) : view.name;
}

PreparedView::PreparedView(const Model& model, const ViewDescription& view)
    : title_(title_of(view)), label_(view.label) {
    std::vector<Text> texts{view.x};
    texts.insert(texts.end(), view.y.begin(), view.y.end());
    program_ = model.compile_view(texts);
    for (const Text& text : texts)
        quantities_.push_back(quantity(model.description(), text.text, quantities_.empty() ? "" : view.unit));
    constexpr std::size_t most_names = 3;
    for (std::size_t i = 1; i < quantities_.size() && view.label.empty() && view.y.size() <= most_names; ++i)
        label_ += (i > 1 ? ", " : "") + quantities_[i].label;
    if (!view.label.empty() && view.y.size() == 1) quantities_[1].label = view.label;
}

std::string PreparedView::unit() const {
    const auto other = [&](const Quantity& quantity) { return quantity.unit != quantities_[1].unit; };
    return std::any_of(quantities_.begin() + 1, quantities_.end(), other) ? "" : quantities_[1].unit;
}

PreparedView::Quantity PreparedView::quantity(const SystemDescription& description, const std::string& written,
                                              const std::string& unit) {
    const std::size_t begin = std::min(written.find_first_not_of(' '), written.size());
    const std::string text = written.substr(begin, written.find_last_not_of(' ') + 1 - begin);
    Quantity result{typeset(text), unit, 1.0, text == "t"};
    result.text = text;
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const CoordinateDescription& c = description.coordinates[i];
        if (text == c.name) result.coordinate = i;
        // Whatever the unit is called, a rate's is so much a second.
        if (unit.empty() && (text == c.name || text == c.name + "'")) result.unit = unit_of(description, text);
    }
    if (result.unit.empty()) result.unit = unit_of_expression(description, text);
    const ShownUnit shown = shown_unit(result.unit);
    result.unit = shown.text;
    result.factor = shown.factor;
    return result;
}

}  // namespace achilles
