#include "module.hpp"

#include <pybind11/stl.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "cli/assets.hpp"
#include "output/output.hpp"

namespace py = pybind11;

namespace achilles::python {

void run_interruptibly(const std::function<void()>& work, const std::function<void()>& stop,
                       const std::function<void()>& tick) {
    constexpr std::chrono::milliseconds between(50);
    std::mutex mutex;
    std::condition_variable changed;
    bool is_done = false;
    std::exception_ptr of_work, of_listening;
    {
        const py::gil_scoped_release released;
        std::thread worker([&] {
            try {
                work();
            } catch (...) {
                of_work = std::current_exception();
            }
            const std::scoped_lock lock(mutex);
            is_done = true;
            changed.notify_one();
        });
        std::unique_lock lock(mutex);
        while (!changed.wait_for(lock, between, [&] { return is_done; })) {
            if (of_listening) continue;
            lock.unlock();
            {
                const py::gil_scoped_acquire held;
                try {
                    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                    tick();
                } catch (...) {
                    of_listening = std::current_exception();
                    stop();
                }
            }
            lock.lock();
        }
        lock.unlock();
        worker.join();
    }
    if (of_listening) std::rethrow_exception(of_listening);
    if (of_work) std::rethrow_exception(of_work);
}

namespace {

// The parts of errors.InputError: the text, and for each error its text, file, line, column, message and hint.
py::tuple parts_of(const InputError& error) {
    py::list mistakes;
    for (const InputError& each : each_of(error))
        mistakes.append(py::make_tuple(each.what(), each.file, each.at.line, each.at.column, each.message, each.hint));
    return py::make_tuple(error.what(), mistakes);
}

void translate(std::exception_ptr problem) {
    try {
        std::rethrow_exception(std::move(problem));
    } catch (const InputError& error) {
        const py::object type = py::module_::import("achilles._errors").attr("InputError");
        PyErr_SetObject(type.ptr(), type(*parts_of(error)).ptr());
    }
}

}  // namespace

void bind_errors(py::module_&) { py::register_exception_translator(&translate); }

}  // namespace achilles::python

PYBIND11_MODULE(_core, module) {
    using namespace achilles;
    python::bind_errors(module);
    python::bind_systems(module);
    python::bind_runs(module);
    python::bind_orbits(module);
    python::bind_sweeps(module);
    module.attr("version") = version();
    module.def("look_for_assets_beside", [](const std::string& file) { look_for_assets_beside(file); });
}
