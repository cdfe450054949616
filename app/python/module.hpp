// What the files of the Python module share. The compiled half, achilles._core, is thin: it takes and gives texts, numbers and
// arrays; what a person sees of it is said in Python.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"
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
Run run_of(const System& system, const Asked& asked);
// What the command line warns of.
std::vector<std::string> warnings_of(const System& system, const Run& run);

// Works on a thread of its own while this one listens, without the interpreter's lock: for signals, of which the first to
// raise an exception (Ctrl-C) calls `stop`, and is thrown when the work has ended. From time to time `tick` is called, with
// the lock; what it throws counts as a signal.
void work_and_listen(const std::function<void()>& work, const std::function<void()>& stop,
                     const std::function<void()>& tick);

void bind_errors(pybind11::module_& module);
void bind_systems(pybind11::module_& module);
void bind_runs(pybind11::module_& module);
void bind_sweeps(pybind11::module_& module);

}  // namespace achilles::python
