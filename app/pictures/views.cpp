#include "pictures/views.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "expression/nearest.hpp"

namespace achilles {

std::vector<ViewDescription> views_of(const SystemDescription& description, const std::vector<std::string>& names) {
    std::vector<ViewDescription> views;
    if (names.empty()) {
        views = description.views;
        std::stable_partition(views.begin(), views.end(),
                              [](const ViewDescription& view) { return view.x.text == "t"; });
        return views;
    }
    std::vector<std::string> known;
    for (const ViewDescription& view : description.views) known.push_back(view.name);
    for (const std::string& name : names) {
        const auto at = std::find(known.begin(), known.end(), name);
        if (at == known.end()) {
            std::string all;
            for (const std::string& view : known) all += (all.empty() ? "" : ", ") + view;
            throw InputError("--view " + name, {},
                             fmt::format("this system has no view '{}'{}", name, did_you_mean(name, known)),
                             "its views are: " + all);
        }
        views.push_back(description.views[static_cast<std::size_t>(at - known.begin())]);
    }
    return views;
}

}  // namespace achilles
