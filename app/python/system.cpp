#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "check/check.hpp"
#include "cli/assets.hpp"
#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "expression/repair.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "module.hpp"
#include "output/page.hpp"
#include "system/expand.hpp"
#include "system/read_tables.hpp"

namespace py = pybind11;

namespace achilles::python {

PythonSystem::PythonSystem(std::string text, std::string name_)
    : name(std::move(name_)), model(std::make_shared<const Model>(parse_system(std::move(text), name))) {}

OptionOverrides overrides_of(const RunArguments& arguments) {
    OptionOverrides overrides;
    for (const Option& option : all_options())
        for (const std::string& flag : {std::string(option.flag), common_flag(option)})
            if (const auto given = arguments.options.find(flag); given != arguments.options.end())
                overrides.by_flag.insert_or_assign(flag, value_from(option, flag, given->second));
    return overrides;
}

Run run_of(const PythonSystem& system, const RunArguments& arguments) {
    return requested_run(system.model->description(), arguments.settings, overrides_of(arguments));
}

std::vector<std::string> warnings_of(const PythonSystem& system, const Run& run) {
    const SystemDescription& description = system.model->description();
    std::vector<std::string> all = warnings(run.options);
    for (const auto& more : {outside_ranges(description, run), unseen_lines(description)})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

namespace {

// The value of an option as a Python object.
py::object value_of(const OptionValue& value) {
    return std::visit([](const auto& one) -> py::object { return py::cast(one); }, value);
}

// The table of options: one row per option, and one per flag that sets several.
py::list option_table() {
    py::list rows;
    const auto add = [&](std::string_view key, const std::string& flag, std::string_view about, const Option& option) {
        rows.append(py::dict(py::arg("key") = key, py::arg("flag") = flag, py::arg("about") = about,
                             py::arg("unit") = option.unit,
                             py::arg("words") = std::vector<std::string>(option.words.begin(), option.words.end()),
                             py::arg("default") = value_of(option.get({}))));
    };
    for (const Option& option : all_options()) {
        if (const std::string common = common_flag(option);
            common != option.flag && &option == &options_set_by(option.command)[0])
            add(option.command, common, "set eps_q, eps_v and eps_t together", option);
        add(option.key, std::string(option.flag), option.help, option);
    }
    return rows;
}

py::dict parameters_of(const PythonSystem& system) {
    const Run run = system.model->default_run();
    const SystemDescription& description = system.model->description();
    py::dict values;
    for (std::size_t i = 0; i < run.parameters.size(); ++i)
        values[py::str(description.parameters[i].name)] = run.parameters[i];
    const std::vector<double> derived = derived_values(*system.model, run.parameters);
    for (std::size_t i = 0; i < derived.size(); ++i) values[py::str(description.derived[i].name)] = derived[i];
    return values;
}

py::dict options_of(const PythonSystem& system) {
    py::dict values;
    for (const Option& option : all_options())
        values[py::str(std::string(option.key))] = value_of(option.get(system.model->description().options));
    return values;
}

py::dict units_of(const PythonSystem& system) {
    const SystemDescription& description = system.model->description();
    py::dict units;
    for (const std::string& name : settable_names(description))
        if (const std::string unit = unit_of(description, name); !unit.empty()) units[py::str(name)] = unit;
    return units;
}

// Each coordinate's name, and its initial value and rate.
std::vector<std::tuple<std::string, double, double>> start_of(const PythonSystem& system) {
    std::vector<std::tuple<std::string, double, double>> start;
    for (const CoordinateDescription& coordinate : system.model->description().coordinates)
        start.emplace_back(coordinate.name, coordinate.start, coordinate.rate);
    return start;
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& list) {
    std::vector<std::string> names;
    for (const Named& one : list) names.push_back(one.name);
    return names;
}

// A dict, list, text or number as TOML.
TomlValue toml_value(const py::handle& value) {
    TomlValue made;
    if (py::isinstance<py::dict>(value)) {
        for (const auto& [key, entry] : py::reinterpret_borrow<py::dict>(value))
            made.entries.push_back({py::cast<std::string>(key), {}, toml_value(entry)});
    } else if (py::isinstance<py::list>(value)) {
        made.kind = TomlValue::Kind::array;
        for (const py::handle item : value) made.items.push_back(toml_value(item));
    } else if (py::isinstance<py::str>(value)) {
        made.kind = TomlValue::Kind::string;
        made.text.text = py::cast<std::string>(value);
    } else {
        made.kind = TomlValue::Kind::number;
        made.text.text = py::cast<std::string>(py::repr(value));
    }
    return made;
}

// The file of a system as it was given, or with energies, forces and gaps in place of bodies.
std::string file_of(const PythonSystem& system, bool is_expanded) {
    const SystemDescription& description = system.model->description();
    return is_expanded ? expand_system(description.source_text, description.file) : titled_text(description);
}

std::vector<std::string> function_names() {
    std::vector<std::string> names;
    for (const Function& function : functions) names.emplace_back(function.name);
    return names;
}

// The text of a file. Throws InputError at the place of a byte that is not UTF-8.
py::str decoded_text(const std::string& file) {
    const std::string text = read_text(file);
    try {
        return py::str(text);
    } catch (const py::error_already_set& problem) {
        if (text.size() > largest_file) parse_system(text, file);  // throws: the last character may be cut off
        const auto place = py::cast<std::size_t>(problem.value().attr("start"));
        const std::string before = text.substr(0, place);
        const auto line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1;
        const auto column = static_cast<int>(py::len(py::str(before.substr(before.rfind('\n') + 1)))) + 1;
        throw InputError(file, {line, column}, "this character is not UTF-8", "save the file as UTF-8",
                         line_of(text, line));
    }
}

// The derived equations as displayed formulas, each with its description: (words, LaTeX).
std::vector<std::pair<std::string, std::string>> equations_of(const PythonSystem& system) {
    const EquationSheet sheet = equation_sheet(*system.model, system.model->default_run());
    std::vector<std::pair<std::string, std::string>> equations;
    std::string words, contact;  // contact: "Contact knee: ", where there are several
    for (const Block& block : sheet.blocks) {
        const bool is_matrix = block.kind == Block::Kind::matrix;
        if (!is_matrix && block.kind != Block::Kind::formula) {
            const std::string& text = block.words.text;
            if (block.kind == Block::Kind::heading) {
                words = text;
                contact = text.starts_with("Contact ") ? text + ": " : "";
            }
            if (block.kind == Block::Kind::caption) words = contact + text;
            continue;
        }
        std::string right;
        for (const auto& row : block.rows) {
            right += fmt::format("{} \\\\ ", fmt::join(row, " & "));
        }
        right = is_matrix ? fmt::format("\\begin{{pmatrix}} {}\\end{{pmatrix}}", right) : block.right;
        equations.emplace_back(std::exchange(words, ""),
                               block.words.latex + (block.words.latex.empty() ? "" : " = ") + right);
    }
    return equations;
}

}  // namespace

void bind_systems(py::module_& module) {
    py::class_<PythonSystem, std::shared_ptr<PythonSystem>>(module, "System", not_constructible())
        .def_readonly("name", &PythonSystem::name)
        .def_property_readonly("title", [](const PythonSystem& s) { return s.model->description().title; })
        .def_property_readonly("source", [](const PythonSystem& s) { return s.model->description().source; })
        .def_property_readonly("text", [](const PythonSystem& s) { return s.model->description().source_text; })
        .def_property_readonly("start", &start_of)
        .def_property_readonly("parameters", &parameters_of)
        .def_property_readonly("contacts",
                               [](const PythonSystem& s) { return names_of(s.model->description().constraints); })
        .def_property_readonly("views", [](const PythonSystem& s) { return names_of(s.model->description().views); })
        .def_property_readonly("settable", [](const PythonSystem& s) { return settable_names(s.model->description()); })
        .def_property_readonly("options", &options_of)
        .def_property_readonly("units", &units_of)
        .def("equations", &equations_of, py::call_guard<py::gil_scoped_release>())
        .def("to_toml", &file_of, py::call_guard<py::gil_scoped_release>());
    module.def(
        "system",
        [](std::string text, std::string name) {
            return std::make_shared<PythonSystem>(std::move(text), std::move(name));
        },
        py::call_guard<py::gil_scoped_release>());
    module.def("toml", [](const py::dict& tables) { return to_toml(toml_value(tables)); });
    module.attr("functions") = function_names();
    module.def("is_name", [](const std::string& text) { return is_name(text); });
    module.def("is_reserved", [](const std::string& name) { return is_reserved(name); });
    module.def("spelled_out", [](const std::string& text) { return spelled_out(text); });
    module.def("instead_of_corner", [](const std::string& function) { return instead_of_corner(function); });
    module.def("option_table", &option_table);
    module.def("did_you_mean", [](const std::string& word, const std::vector<std::string>& names) {
        return did_you_mean(word, names);
    });
    module.def("find_system", [](const std::string& name) { return find_system(name).string(); });
    module.def("read_text", &decoded_text);
    module.def("system_names", &system_names);
}

}  // namespace achilles::python
