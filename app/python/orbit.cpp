#include <pybind11/stl.h>

#include "figure/publication.hpp"
#include "module.hpp"
#include "output/output.hpp"
#include "pictures/picture_job.hpp"
#include "session/replay_script.hpp"

namespace py = pybind11;

namespace achilles::python {

namespace {

// An orbit request and its result.
struct PythonOrbit {
    std::shared_ptr<const PythonSystem> system;
    std::vector<std::string> words;    // the equivalent command line, without options of a picture
    std::vector<InputSource> sources;  // files that the command line reads
    OrbitResult answer;
    std::vector<std::string> warnings;

    const Orbit& orbit() const { return *answer.orbit; }
    const Branch* branch() const { return answer.branch ? &*answer.branch : nullptr; }
};

std::vector<std::string> words_of(const PythonSystem& system, const OrbitOptions& typed, const RunArguments& of_run) {
    std::vector<std::string> words{"orbit", system.name};
    const auto add = [&](const std::string& flag, const std::string& value) {
        if (!value.empty()) words.insert(words.end(), {flag, value});
    };
    add("--from", typed.from);
    add("--period", typed.period);
    for (const std::string& shift : typed.shifts) add("--shift", shift);
    add("--continue", typed.along);
    // All given options, even those equal to the file's: they take precedence over the options of an orbit search.
    for (const std::string& setting : of_run.settings) add("--set", setting);
    for (const auto& [flag, value] : of_run.options) add(flag, value);
    return words;
}

// `json`: the content of the file named by `from`, if the search starts at a state.
std::shared_ptr<PythonOrbit> search_orbit(const std::shared_ptr<const PythonSystem>& system, OrbitOptions typed,
                                          const std::optional<std::string>& json, const RunArguments& of_run) {
    const Model& model = *system->model;
    const auto found = std::make_shared<PythonOrbit>();
    found->system = system;
    found->words = words_of(*system, typed, of_run);
    found->sources = {{InputSource::Kind::system, system->name, model.description().source_text}};
    typed.settings = of_run.settings;
    const OptionOverrides overrides = overrides_of(of_run);
    for (const Option& option : all_options())
        if (overrides.find(option) != nullptr) typed.options.insert(option.key);
    if (json) {
        typed.guess = orbit_guess(*json, typed.from, model.description().coordinates.size());
        found->sources.push_back({InputSource::Kind::system, typed.from, *json});
    }
    const Run run = run_of(*system, of_run);
    validate_overrides(model, run, typed.settings);
    found->warnings = warnings_of(*system, run);
    std::stop_source source;
    OrbitMonitor watch;
    watch.stop = source.get_token();
    const auto work = [&] {
        found->answer = solve_orbit_request(parse_orbit_request(typed, run, system->model), system->model, &watch);
    };
    run_interruptibly(
        work, [&] { source.request_stop(); }, [] {});
    return found;
}

// The same picture as `achilles orbit --out`.
std::string draw(const PythonOrbit& found, const FigureStyleTuple& tuple, const std::string& format) {
    const FigureStyle look = figure_style(tuple, format);
    const std::vector<ViewDescription> views = views_of(found.system->model->description(), look.views);
    const Figure figure = found.branch() != nullptr ? compose_branch(found.orbit(), *found.branch(), views, look.style)
                                                    : publication(found.orbit().run, views, look.style);
    std::vector<std::string> words = found.words;
    add(words, look);
    return picture_of(figure, look, format, shell_line(words), found.sources, found.orbit().run);
}

// The arguments that turn the file's run into one period of the orbit.
RunArguments one_period_arguments(const PythonOrbit& found) {
    const Model& model = *found.system->model;
    const std::vector<std::string> words = run_options(model.description(), model.default_run(), found.orbit().run.run);
    RunArguments arguments;
    for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
        if (words[i] == "--set")
            arguments.settings.push_back(words[i + 1]);
        else
            arguments.options[words[i]] = words[i + 1];
    }
    return arguments;
}

}  // namespace

void bind_orbits(py::module_& module) {
    const py::call_guard<py::gil_scoped_release> released;
    py::class_<PythonOrbit, std::shared_ptr<PythonOrbit>>(module, "Orbit", not_constructible())
        .def_readonly("warnings", &PythonOrbit::warnings)
        // If no orbit was found: the reason. The other properties must not be used then.
        .def_property_readonly("why", [](const PythonOrbit& f) { return f.answer.orbit ? "" : f.answer.reason; })
        .def_property_readonly("command", [](const PythonOrbit& f) { return shell_line(f.words); })
        .def("of_period",
             [](const PythonOrbit& f) {
                 const RunArguments arguments = one_period_arguments(f);
                 return std::pair(arguments.settings, arguments.options);
             })
        .def(
            "summary", [](const PythonOrbit& f) { return orbit_answer(f.orbit(), f.branch()); }, released)
        .def(
            "json", [](const PythonOrbit& f) { return to_json(f.orbit(), f.branch()); }, released)
        .def("figure", [](const PythonOrbit& f, const FigureStyleTuple& look, const std::string& format) {
            return without_gil([&] { return draw(f, look, format); });
        });
    module.def(
        "orbit", [](const std::shared_ptr<const PythonSystem>& system, std::string from,
                    const std::optional<std::string>& json, std::string period, std::vector<std::string> shifts,
                    std::string along, std::vector<std::string> settings, std::map<std::string, std::string> options) {
            return search_orbit(system, {std::move(from), std::move(period), std::move(shifts), std::move(along)}, json,
                                {std::move(settings), std::move(options)});
        });
}

}  // namespace achilles::python
