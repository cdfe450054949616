// Shared declarations of the Python module. The compiled part, achilles._core, is thin: it exchanges texts, numbers and
// arrays. The public interface is written in Python.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "cli/overrides.hpp"
#include "figure/publication.hpp"
#include "model/model.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_format.hpp"
#include "run/trajectory.hpp"

namespace achilles::python {

// A system, ready for runs. Immutable.
struct PythonSystem {
    PythonSystem(std::string text, std::string name);
    std::string name;  // name in the gallery, a path, or "<text>"
    std::shared_ptr<const Model> model;
};

// Arguments of one run: settings as for --set, and options by flag, as typed.
struct RunArguments {
    std::vector<std::string> settings;
    std::map<std::string, std::string> options;
};
OptionOverrides overrides_of(const RunArguments& arguments);
Run run_of(const PythonSystem& system, const RunArguments& arguments);
// The warnings that the command line would print.
std::vector<std::string> warnings_of(const PythonSystem& system, const Run& run);

// Runs `work` on another thread while this thread, without the GIL, polls for signals. If a signal raises an exception
// (Ctrl-C), calls `stop` and rethrows it when the work has ended. Calls `tick` at intervals, with the GIL; an exception
// from it is treated like a signal.
void run_interruptibly(const std::function<void()>& work, const std::function<void()>& stop,
                       const std::function<void()>& tick);

// Appearance of a figure: the views of these names, or all if there are none; size and style.
struct FigureStyle {
    std::vector<std::string> views;
    PictureSize size;
    PaperSize page;
    PublicationStyle style;
};
// The same as a Python tuple: views, size in pixels, scale, page (width and height in mm, font in pt, dpi), columns,
// dark, transparent.
using FigureStyleTuple =
    std::tuple<std::vector<std::string>, std::array<int, 2>, double, std::array<double, 4>, int, bool, bool>;
// Converts it for a picture format. Throws InputError.
FigureStyle figure_style(const FigureStyleTuple& tuple, const std::string& format);
// Appends the equivalent options of the command line.
void add(std::vector<std::string>& words, const FigureStyle& look);
// The picture as file content, with the command line that reproduces it and the files which that reads, the system
// first.
std::string picture_of(const Figure& figure, const FigureStyle& look, const std::string& format,
                       const std::string& command, const std::vector<InputSource>& sources, const Trajectory& shown);
// Calls `make` without the GIL and returns the result.
pybind11::bytes without_gil(const std::function<std::string()>& make);

// For classes whose objects only this module creates. The default __new__ would leave their value uninitialized, and
// any method call would read invalid memory. Construction, copying and unpickling raise TypeError instead.
inline pybind11::custom_type_setup not_constructible() {
    return pybind11::custom_type_setup([](PyHeapTypeObject* type) {
        type->ht_type.tp_new = [](PyTypeObject* of, PyObject*, PyObject*) -> PyObject* {
            PyErr_Format(PyExc_TypeError,
                         "%s: only achilles creates these objects; they cannot be constructed or copied directly",
                         of->tp_name);
            return nullptr;
        };
    });
}

void bind_errors(pybind11::module_& module);
void bind_systems(pybind11::module_& module);
void bind_runs(pybind11::module_& module);
void bind_orbits(pybind11::module_& module);
void bind_sweeps(pybind11::module_& module);

}  // namespace achilles::python
