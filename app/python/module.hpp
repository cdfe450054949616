// What the files of the Python module share. The compiled half, achilles._core, is thin: it takes and gives texts, numbers and
// arrays; what a person sees of it is said in Python.
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

// A system as runs are made of it. Never changes.
struct System {
    System(std::string text, std::string name);
    std::string name;  // of the gallery, a path, or "<text>"
    std::shared_ptr<const Model> model;
};

// Of one run: what was asked for as --set says it, and the options by flag, as typed.
struct Asked {
    std::vector<std::string> settings;
    std::map<std::string, std::string> options;
};
OptionOverrides overrides_of(const Asked& asked);
Run run_of(const System& system, const Asked& asked);
// What the command line warns of.
std::vector<std::string> warnings_of(const System& system, const Run& run);

// Works on a thread of its own while this one listens, without the interpreter's lock: for signals, of which the first to
// raise an exception (Ctrl-C) calls `stop`, and is thrown when the work has ended. From time to time `tick` is called, with
// the lock; what it throws counts as a signal.
void work_and_listen(const std::function<void()>& work, const std::function<void()>& stop,
                     const std::function<void()>& tick);

// How a figure looks: the views of these names, all if there are none.
struct Look {
    std::vector<std::string> views;
    PictureSize size;
    PaperSize page;
    PublicationStyle style;
};
// As Python says it: views, pixels, scale, millimetres (width, height, font in points, dots an inch), columns, dark, transparent.
using AskedLook =
    std::tuple<std::vector<std::string>, std::array<int, 2>, double, std::array<double, 4>, int, bool, bool>;
// Of a picture in this format. Throws InputError.
Look look_of(const AskedLook& asked, const std::string& format);
// Words of a command line that ask for it.
void add(std::vector<std::string>& words, const Look& look);
// The picture as a file, which carries the command line that makes it again and the files that this reads, first the system's.
std::string picture_of(const Figure& figure, const Look& look, const std::string& format, const std::string& command,
                       const std::vector<Source>& sources, const Trajectory& shown);
// What it makes, without the lock.
pybind11::bytes unlocked(const std::function<std::string()>& make);

// Of a class whose objects this module alone makes. __new__ would leave them without a value, and what is called on them then
// reads memory that nobody has written: it raises TypeError instead, also for copies and pickles.
inline pybind11::custom_type_setup made_here_alone() {
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
