#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <mutex>
#include <optional>

#include "module.hpp"
#include "number/float_environment.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "pictures/picture_job.hpp"
#include "pictures/player.hpp"
#include "sensitivity/error_estimate.hpp"
#include "sensitivity/quantities.hpp"
#include "session/replay_script.hpp"
#include "simulate/contact_forces.hpp"
#include "simulate/simulate.hpp"

namespace py = pybind11;

namespace achilles::python {

namespace {

// States of a run at given times. NumPy arrays refer to this memory and keep it alive.
struct StateTable {
    std::vector<double> t, q, v;  // q and v row by row
    std::vector<int> j;
    std::vector<std::uint8_t> is_constrained;
    py::ssize_t coordinates = 0;
};

struct PythonRun {
    std::shared_ptr<const PythonSystem> system;
    RunArguments arguments;
    Trajectory trajectory;
    std::vector<std::string> warnings;
    // Computed on first use: it takes longer than the run.
    const ErrorEstimate& estimate() const {
        std::call_once(estimated, [this] { made_estimate = estimate_error(trajectory); });
        return *made_estimate;
    }
    mutable std::once_flag estimated;
    mutable std::optional<ErrorEstimate> made_estimate;
};

using Times = py::array_t<double, py::array::c_style | py::array::forcecast>;

// A read-only array that refers to `data` without a copy and keeps its owner alive.
template <class Number>
py::array array_view(const std::shared_ptr<const StateTable>& owner, const std::vector<Number>& data,
                     py::ssize_t columns) {
    const py::capsule keeper(new std::shared_ptr<const StateTable>(owner),
                             [](void* kept) { delete static_cast<std::shared_ptr<const StateTable>*>(kept); });
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(owner->t.size())};
    if (columns >= 0) shape.push_back(columns);
    py::array_t<Number> array(shape, data.data(), keeper);
    array.attr("flags").attr("writeable") = false;
    return array;
}

std::shared_ptr<const StateTable> table_of(const Trajectory& trajectory, const std::vector<Sample>& samples) {
    const auto table = std::make_shared<StateTable>();
    table->coordinates = trajectory.model->dof();
    for (const Sample& sample : samples) {
        table->t.push_back(sample.t);
        table->j.push_back(sample.j);
        table->is_constrained.push_back(sample.phase == Phase::Kind::constrained);
        table->q.insert(table->q.end(), sample.state.q.begin(), sample.state.q.end());
        table->v.insert(table->v.end(), sample.state.v.begin(), sample.state.v.end());
    }
    return table;
}

// The arrays of a run, t first; by default at the rows of its CSV.
py::dict arrays_of(const std::shared_ptr<PythonRun>& made, const std::optional<Times>& times) {
    std::shared_ptr<const StateTable> table;
    {
        const std::vector<double> instants =
            times ? std::vector<double>(times->data(), times->data() + times->size()) : std::vector<double>();
        const py::gil_scoped_release released;
        const FloatEnvironmentGuard ground;
        table = table_of(made->trajectory,
                         times ? samples_at(made->trajectory, instants) : samples_of_curve(made->trajectory));
    }
    py::dict arrays;
    arrays["t"] = array_view(table, table->t, -1);
    arrays["q"] = array_view(table, table->q, table->coordinates);
    arrays["v"] = array_view(table, table->v, table->coordinates);
    arrays["j"] = array_view(table, table->j, -1);
    arrays["constrained"] = array_view(table, table->is_constrained, -1).attr("view")("bool");
    return arrays;
}

// Values of a view expression, at the given times or at the rows of the CSV.
py::array_t<double> values_of(const PythonRun& made, const std::string& expression, const std::optional<Times>& times) {
    const std::vector<double> instants =
        times ? std::vector<double>(times->data(), times->data() + times->size()) : std::vector<double>();
    std::vector<double> values;
    {
        const py::gil_scoped_release released;
        const FloatEnvironmentGuard ground;
        const Trajectory& trajectory = made.trajectory;
        const std::array<Text, 1> texts{Text{expression, {}}};
        const Program program = trajectory.model->compile_view(texts);
        auto view = trajectory.model->evaluator(program, trajectory.run.parameters);
        ContactForces forces(*trajectory.model, trajectory.run.parameters);
        for (const Sample& sample : times ? samples_at(trajectory, instants) : samples_of_curve(trajectory)) {
            forces.run_view(view, sample);
            values.push_back(view.output(0));
        }
    }
    return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

std::shared_ptr<PythonRun> made_from(const std::shared_ptr<const PythonSystem>& system,
                                     std::vector<std::string> settings, std::map<std::string, std::string> options) {
    const auto made = std::make_shared<PythonRun>();
    made->system = system;
    made->arguments = {std::move(settings), std::move(options)};
    const Run run = run_of(*system, made->arguments);
    validate_overrides(*system->model, run, made->arguments.settings);
    made->warnings = warnings_of(*system, run);
    std::stop_source source;
    RunMonitor watch;
    watch.stop = source.get_token();
    run_interruptibly([&] { made->trajectory = simulate(system->model, run, &watch); }, [&] { source.request_stop(); },
                      [] {});
    return made;
}

Instants instants_from(const std::optional<Times>& times) {
    if (!times) return {};
    return std::vector<double>(times->data(), times->data() + times->size());
}

// The equivalent command line, which pictures store.
std::string command_of(const PythonRun& made, const FigureStyle& look) {
    const Model& model = *made.system->model;
    std::vector<std::string> words{"figure", made.system->name};
    add(words, look);
    const std::vector<std::string> options = run_options(model.description(), model.default_run(), made.trajectory.run);
    words.insert(words.end(), options.begin(), options.end());
    return shell_line(words);
}

// The same picture as `achilles figure`.
std::string draw(const PythonRun& made, const FigureStyleTuple& tuple, const std::string& format) {
    const FigureStyle look = figure_style(tuple, format);
    const SystemDescription& description = made.system->model->description();
    return picture_of(publication(made.trajectory, views_of(description, look.views), look.style, nullptr,
                                  horizon_before_end(made.trajectory, made.estimate())),
                      look, format, command_of(made, look),
                      {{InputSource::Kind::system, made.system->name, description.source_text}}, made.trajectory);
}

// The same page as from `achilles html`.
std::string page_of(const PythonRun& made, const std::vector<std::string>& names) {
    const SystemDescription& description = made.system->model->description();
    const std::string& system = made.system->name;
    const std::string prove = prove_line(system, made.arguments.settings, overrides_of(made.arguments));
    return player_page(
        made.trajectory, made.estimate(), views_of(description, names),
        {answer(made.trajectory, made.estimate(), prove), player_command(made.trajectory, system, names)});
}

}  // namespace

void bind_runs(py::module_& module) {
    const py::call_guard<py::gil_scoped_release> released;
    py::class_<PythonRun, std::shared_ptr<PythonRun>>(module, "Run", not_constructible())
        .def_readonly("warnings", &PythonRun::warnings)
        .def_property_readonly("settings", [](const PythonRun& m) { return m.arguments.settings; })
        .def_property_readonly("given", [](const PythonRun& m) { return m.arguments.options; })
        .def_property_readonly("start_time", [](const PythonRun& m) { return m.trajectory.run.options.start_time; })
        .def_property_readonly("end_time", [](const PythonRun& m) { return m.trajectory.end_time; })
        .def_property_readonly("outcome", [](const PythonRun& m) { return to_text(m.trajectory.outcome.kind); })
        .def_property_readonly("message", [](const PythonRun& m) { return m.trajectory.outcome.message; })
        .def_property_readonly("seconds", [](const PythonRun& m) { return m.trajectory.statistics.seconds; })
        .def(
            "remarks",
            [](const PythonRun& m) {
                std::vector<std::string> sentences;
                for (const RunWarning& remark : remarks(m.trajectory)) sentences.push_back(remark.sentence);
                return sentences;
            },
            released)
        .def_property_readonly("trusted_until",
                               [](const PythonRun& m) {
                                   const py::gil_scoped_release without_gil;
                                   return m.estimate().trusted_until;
                               })
        .def("arrays", &arrays_of)
        .def("values", &values_of)
        .def(
            "summary",
            [](const PythonRun& m) {
                return answer(m.trajectory, m.estimate(),
                              prove_line(m.system->name, m.arguments.settings, overrides_of(m.arguments)));
            },
            released)
        .def("json",
             [](const PythonRun& m, const std::optional<Times>& times) {
                 const Instants instants = instants_from(times);
                 const py::gil_scoped_release without_gil;
                 return to_json(m.trajectory, instants, nullptr, &m.estimate());
             })
        // The run repeated with derivatives, and the derivatives of expressions.
        .def(
            "dependence",
            [](const PythonRun& m, std::vector<std::string> of) {
                const FloatEnvironmentGuard ground;
                const Quantities quantities(m.system->model, std::move(of));
                Dependence dependence{differentiate(m.trajectory), {}};
                dependence.quantities = quantities.of(m.trajectory, dependence.derivatives);
                return to_json(m.trajectory, {}, &dependence, &m.estimate());
            },
            released)
        .def("csv",
             [](const PythonRun& m, const std::optional<Times>& times, bool plain_names, bool units) {
                 const CsvStyle style{instants_from(times), plain_names, units};
                 const py::gil_scoped_release without_gil;
                 return to_csv(m.trajectory, style);
             })
        .def("html", &page_of, released)
        .def("figure", [](const PythonRun& m, const FigureStyleTuple& look, const std::string& format) {
            return without_gil([&] { return draw(m, look, format); });
        });
    module.def("simulate", &made_from);
    module.def("equidistant", &equidistant);
}

}  // namespace achilles::python
