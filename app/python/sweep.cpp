#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <atomic>
#include <map>
#include <mutex>

#include "analysis/chunks.hpp"
#include "cli/overrides.hpp"
#include "module.hpp"
#include "output/contacts.hpp"
#include "output/sweep_files.hpp"

namespace py = pybind11;

namespace achilles::python {

namespace {

// Codes for strings that occur repeatedly.
class StringCodes {
 public:
    std::uint32_t code(const std::string& word) {
        const auto [at, is_new] = codes_.try_emplace(word, static_cast<std::uint32_t>(words_.size()));
        if (is_new) words_.push_back(word);
        return at->second;
    }
    const std::vector<std::string>& words() const { return words_; }

 private:
    std::map<std::string, std::uint32_t> codes_;
    std::vector<std::string> words_;
};

// All rows of a sweep, stored by column.
struct SweepColumnData {
    std::vector<std::uint64_t> points;
    std::vector<double> numbers, times;
    std::vector<std::uint32_t> held, contacts, ends, modes;
    StringCodes words;  // strings of the four columns above
};

void append(SweepColumnData& columns, const SweepTable& table, const Rows& rows) {
    const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    add(columns.points, rows.points);
    add(columns.numbers, rows.numbers);
    add(columns.times, rows.times);
    const auto names = [&](ContactSet set) { return columns.words.code(joined_names(table.model(), set, "+")); };
    for (const ContactSet held : rows.held) columns.held.push_back(names(held));
    for (const ContactSet contacts : rows.contacts) columns.contacts.push_back(names(contacts));
    for (const Mode mode : rows.modes) columns.modes.push_back(columns.words.code(modes_text(table.model(), mode)));
    for (const RunEnd end : rows.ends) columns.ends.push_back(columns.words.code(std::string(end.text())));
}

template <class Number>
py::array_t<Number> array_of(const std::vector<Number>& numbers) {
    return py::array_t<Number>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

// An array that takes over the memory of the numbers, without a copy.
py::array owned(std::vector<double>&& numbers, py::ssize_t width) {
    auto* const kept = new std::vector<double>(std::move(numbers));
    const py::capsule keeper(kept, [](void* data) { delete static_cast<std::vector<double>*>(data); });
    const py::ssize_t rows = width == 0 ? 0 : static_cast<py::ssize_t>(kept->size()) / width;
    return py::array_t<double>({rows, width}, kept->data(), keeper);
}

// Each axis: its values along the axis, on the grid, and in every row.
py::list axes_of(const SweepTable& table, const SweepColumnData& columns) {
    const SweepSpec& sweep = table.sweep();
    py::list axes;
    for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
        const SweepAxis& axis = sweep.axes[i];
        std::vector<double> along, of_rows;
        for (std::uint64_t k = 0; k < axis.count; ++k) along.push_back(axis.value(k));
        for (const std::uint64_t point : columns.points) of_rows.push_back(sweep.value(i, point));
        axes.append(py::make_tuple(axis.name, array_of(along), array_of(of_rows),
                                   unit_of(table.model().description(), axis.name)));
    }
    return axes;
}

py::dict as_dict(const PythonSystem& system, const SweepTable& table, SweepColumnData columns) {
    constexpr std::array<const char*, 4> kinds{"number", "held", "outcome", "modes"};
    py::list prints;
    for (const RunMeasures::Column& column : table.measures().columns())
        prints.append(py::make_tuple(kinds[static_cast<std::size_t>(column.kind)], column.name, column.unit));
    py::dict result;
    result["axes"] = axes_of(table, columns);
    result["prints"] = prints;
    result["is_section"] = table.is_section();
    result["points"] = array_of(columns.points);
    result["numbers"] = owned(std::move(columns.numbers), static_cast<py::ssize_t>(table.measures().numbers()));
    result["times"] = array_of(columns.times);
    result["held"] = array_of(columns.held);
    result["modes"] = array_of(columns.modes);
    result["contacts"] = array_of(columns.contacts);
    result["ends"] = array_of(columns.ends);
    result["words"] = columns.words.words();
    result["warnings"] = warnings_of(system, table.sweep().base);
    result["text"] = to_text(table.sweep(), table.model().description());
    return result;
}

py::dict swept(const std::shared_ptr<const PythonSystem>& system, SweepOptions sweep, const RunArguments& arguments,
               int threads, const py::object& progress) {
    sweep.fixed = fixed_names(arguments.settings, overrides_of(arguments));
    const SweepTable table(system->model, make_sweep(sweep, run_of(*system, arguments), system->model->description()));
    const std::uint64_t points = table.sweep().count();
    SweepColumnData columns;
    std::atomic<bool> stop{false};
    std::atomic<std::uint64_t> done{0};
    const auto tick = [&] {
        if (!progress.is_none()) progress(done.load(), points);
    };
    const auto task = [&](Chunk chunk) { return to_bytes(table.rows(chunk.first, chunk.count)); };
    const auto write = [&](Chunk chunk, const std::string& bytes) {
        append(columns, table, rows_from(bytes, table));
        done = chunk.first + chunk.count;
    };
    run_interruptibly([&] { do_chunks(0, points, threads, task, write, stop); }, [&] { stop = true; }, tick);
    tick();
    return as_dict(*system, table, std::move(columns));
}

}  // namespace

void bind_sweeps(py::module_& module) {
    using Text = std::optional<std::string>;
    module.def("sweep", [](const std::shared_ptr<const PythonSystem>& system, std::vector<std::string> over,
                           std::vector<std::string> prints, const Text& at, const Text& after, const Text& random,
                           const Text& seed, std::vector<std::string> settings,
                           std::map<std::string, std::string> options, int threads, const py::object& progress) {
        return swept(system, {std::move(over), std::move(prints), at, after, random, seed, {}},
                     {std::move(settings), std::move(options)}, threads, progress);
    });
}

}  // namespace achilles::python
