#include "session/document.hpp"

#include <fmt/format.h>

#include "cli/write_files.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

constexpr const char* template_text =
    R"toml(# A ball in a bowl. Change anything: what can be read takes effect when you pause.
title = "A new system"

coordinate = [
    {name = "x", start = -1.0, rate = 1.5, unit = "m"},
    {name = "y", start = 1.5, unit = "m"},
]

parameter = [
    {name = "m", value = 1.0, unit = "kg", range = [0.1, 10.0], about = "mass"},
    {name = "g", value = 9.81, unit = "m/s^2", range = [0.1, 20.0], about = "gravity"},
    {name = "e", value = 0.6, range = [0.0, 1.0], about = "restitution: normal speed after an impact over that before"},
]

# x' is the rate of x.
lagrangian.kinetic   = "m/2*(x'^2 + y'^2)"
lagrangian.potential = "m*g*y"

# The motion keeps the gap at zero or above; at an impact its rate is reversed and scaled.
constraint = [{gap = "y - x^2/8", restitution = "e"}]

run = {end_time = 6.0}

# The surface, and the ball.
drawing = [
    {shape = "curve", over = ["s", -4.0, 4.0], at = ["s", "s^2/8"]},
    {shape = "disc", at = ["x", "y"], radius = 0.05},
]

# The plots.
view = [
    {name = "height", x = "t", y = ["y"]},
    {name = "path", x = "x", y = ["y"]},
    {name = "energy", x = "t", y = ["energy"]},
    {name = "contact force", x = "t", y = ["lambda"]},
]
)toml";

// Canonical path, to compare files.
fs::path place_of(const std::string& file) {
    std::error_code problem;
    const fs::path place = fs::weakly_canonical(fs::absolute(file), problem);
    return problem ? fs::path(file) : place;
}

}  // namespace

Document new_document() { return {"untitled", "", "untitled", template_text, template_text, {}}; }

Document open_document(const std::string& name, const fs::path& file) {
    const std::string text = read_text(file);
    return {name, file == fs::path(name) ? name : "", file.string(), text, text, {}};
}

void save(Document& document, const std::string& file, bool overwrite) {
    if (file.empty()) throw InputError({}, {}, "the file to save to is missing");
    if (file == "-") throw InputError({}, {}, "the text must be saved to a file, not to standard output");
    const bool is_own = !document.file.empty() && place_of(document.file) == place_of(file);
    std::error_code ignored;
    if (!is_own && !overwrite && fs::exists(file, ignored))
        throw InputError(file, {}, "the file already exists",
                         "save under another name, or overwrite it: save FILE overwrite");
    OutputFiles files;
    files.add(file);
    files.put(file, document.text);
    files.commit();
    mark_saved(document, file);
}

void mark_saved(Document& document, const std::string& file) {
    document.file = document.name = document.source = file;
    document.saved = document.text;
}

Run carried_over(const SystemDescription& before, const Run& run, const Model& after) {
    const SystemDescription& now = after.description();
    Run result = after.default_run();
    for (std::size_t i = 0; i < now.parameters.size(); ++i)
        for (std::size_t j = 0; j < before.parameters.size(); ++j)
            if (now.parameters[i].name == before.parameters[j].name &&
                now.parameters[i].value == before.parameters[j].value)
                result.parameters[i] = run.parameters[j];
    for (std::size_t i = 0; i < now.coordinates.size(); ++i)
        for (std::size_t j = 0; j < before.coordinates.size(); ++j) {
            const CoordinateDescription &here = now.coordinates[i], &there = before.coordinates[j];
            if (here.name != there.name) continue;
            const auto to = static_cast<Eigen::Index>(i), from = static_cast<Eigen::Index>(j);
            if (here.start == there.start) result.q[to] = run.q[from];
            if (here.rate == there.rate) result.v[to] = run.v[from];
        }
    for (const Option& option : all_options())
        if (option.get(now.options) == option.get(before.options)) option.set(result.options, option.get(run.options));
    return result;
}

}  // namespace achilles
