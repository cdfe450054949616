// The rows of a sweep as HDF5. The C library is loaded on first use: this saves time at program start, and the library
// may be missing.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "output/contacts.hpp"
#include "output/sweep_files.hpp"

#ifdef ACHILLES_HDF5_LIBRARY
#include <dlfcn.h>
#include <hdf5.h>
#endif

namespace achilles {

// A print with '/' is a path: /values/y/2 is read as typed, and /values/y cannot be an array then.
std::string hdf5_name_error(const SweepTable& table) {
    std::vector<std::string> names;  // of /values
    if (table.is_section()) names = {"t", "contact"};
    for (const auto& column : table.measures().columns())
        if (column.kind != RunMeasures::Column::Kind::outcome) names.push_back(column.name);
    names.emplace_back("outcome");
    for (std::size_t i = 0; i < names.size(); ++i)
        for (std::size_t k = 0; k < names.size(); ++k)
            if (i != k && (names[i] == names[k] || names[k].starts_with(names[i] + "/")))
                return fmt::format(
                    "'{}' and '{}' cannot both be names in an HDF5 file, where '/' divides a path: "
                    "write one of them in parentheses",
                    names[i], names[k]);
    return "";
}

#ifndef ACHILLES_HDF5_LIBRARY

std::string hdf5_unavailable_reason() { return "this build of Achilles has no HDF5 support: libhdf5-dev was missing"; }

void write_hdf5(const std::string&, const SweepTable&, const SweepOrigin&, const RowReader&) {
    throw std::runtime_error(hdf5_unavailable_reason());
}

#else

namespace {

using Column = RunMeasures::Column;

// The functions of the HDF5 library in use, loaded with dlopen.
class Library {
    void* library_ = nullptr;  // declared before the functions, which are read from it
    std::string fault_;

 public:
    static const Library& get() {
        static const Library library;
        return library;
    }
    const std::string& fault() const { return fault_; }

// NOLINTNEXTLINE(bugprone-macro-parentheses): a declared name takes no parentheses
#define ACHILLES_HDF5_FUNCTION(name) decltype(&::name) name = address<decltype(&::name)>(#name)
    ACHILLES_HDF5_FUNCTION(H5dont_atexit);
    ACHILLES_HDF5_FUNCTION(H5open);
    ACHILLES_HDF5_FUNCTION(H5Eset_auto2);
    ACHILLES_HDF5_FUNCTION(H5Fcreate);
    ACHILLES_HDF5_FUNCTION(H5Fclose);
    ACHILLES_HDF5_FUNCTION(H5Gcreate2);
    ACHILLES_HDF5_FUNCTION(H5Gclose);
    ACHILLES_HDF5_FUNCTION(H5Screate);
    ACHILLES_HDF5_FUNCTION(H5Screate_simple);
    ACHILLES_HDF5_FUNCTION(H5Sselect_hyperslab);
    ACHILLES_HDF5_FUNCTION(H5Sclose);
    ACHILLES_HDF5_FUNCTION(H5Dcreate2);
    ACHILLES_HDF5_FUNCTION(H5Dwrite);
    ACHILLES_HDF5_FUNCTION(H5Dclose);
    ACHILLES_HDF5_FUNCTION(H5Acreate2);
    ACHILLES_HDF5_FUNCTION(H5Awrite);
    ACHILLES_HDF5_FUNCTION(H5Aclose);
    ACHILLES_HDF5_FUNCTION(H5Tcopy);
    ACHILLES_HDF5_FUNCTION(H5Tset_size);
    ACHILLES_HDF5_FUNCTION(H5Tset_strpad);
    ACHILLES_HDF5_FUNCTION(H5Tset_cset);
    ACHILLES_HDF5_FUNCTION(H5Tclose);
    ACHILLES_HDF5_FUNCTION(H5Pcreate);
    ACHILLES_HDF5_FUNCTION(H5Pset_obj_track_times);
    ACHILLES_HDF5_FUNCTION(H5Pset_create_intermediate_group);
    ACHILLES_HDF5_FUNCTION(H5Pclose);
#undef ACHILLES_HDF5_FUNCTION

    // A variable that HDF5 macros read; it is set once the library is open.
    hid_t constant(const char* name) const {
        const auto* value = static_cast<const hid_t*>(dlsym(library_, name));
        if (value == nullptr) throw std::runtime_error(fmt::format("{} lacks {}", ACHILLES_HDF5_LIBRARY, name));
        return *value;
    }

 private:
    Library() {
        if (!fault_.empty()) return;
        // At exit the library would close files again, and crash if one could not be written.
        H5dont_atexit();
        H5open();
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // we report errors ourselves
    }

    template <class Function>
    Function address(const char* name) {
        if (library_ == nullptr && fault_.empty()) {
            library_ = dlopen(ACHILLES_HDF5_LIBRARY, RTLD_NOW | RTLD_LOCAL);
            if (library_ == nullptr) fault_ = fmt::format("{} is missing on this machine", ACHILLES_HDF5_LIBRARY);
        }
        void* const found = library_ == nullptr ? nullptr : dlsym(library_, name);
        if (found == nullptr && fault_.empty()) fault_ = fmt::format("{} lacks {}", ACHILLES_HDF5_LIBRARY, name);
        return reinterpret_cast<Function>(found);
    }
};

constexpr unsigned overwrite = 0x0002u;  // H5F_ACC_TRUNC is a macro that calls the library

[[noreturn]] void fail() { throw std::runtime_error("the HDF5 file cannot be written"); }

void check(herr_t status) {
    if (status < 0) fail();
}

// An HDF5 object, closed in the destructor.
class Handle {
 public:
    Handle(hid_t id, herr_t (*how_to_close)(hid_t)) : id_(id), close_(how_to_close) {
        if (id < 0) fail();
    }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    operator hid_t() const { return id_; }
    // Closes the object. Throws if its pending writes fail.
    void close() { check(close_(std::exchange(id_, -1))); }

 private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

// A string type of this size in bytes.
Handle text_type(std::size_t size) {
    const Library& h5 = Library::get();
    Handle type(h5.H5Tcopy(h5.constant("H5T_C_S1_g")), h5.H5Tclose);
    check(h5.H5Tset_size(type, std::max<std::size_t>(1, size)));
    check(h5.H5Tset_strpad(type, H5T_STR_NULLPAD));
    check(h5.H5Tset_cset(type, H5T_CSET_UTF8));
    return type;
}

void put_attribute(hid_t of, const char* name, const std::string& text) {
    const Library& h5 = Library::get();
    const Handle type = text_type(text.size()), space(h5.H5Screate(H5S_SCALAR), h5.H5Sclose),
                 attribute(h5.H5Acreate2(of, name, type, space, H5P_DEFAULT, H5P_DEFAULT), h5.H5Aclose);
    check(h5.H5Awrite(attribute, type, text.c_str()));
}

// An array that is written in the order of its elements.
class Array {
 public:
    Array(hid_t file, const std::string& path, const std::vector<hsize_t>& shape, Handle type, const std::string& units)
        : h5_(Library::get()), shape_(shape), type_(std::move(type)), array_(create(file, path)) {
        if (!units.empty()) put_attribute(array_, "units", units);
    }

    // Writes elements `at_`, ... from contiguous memory, split into boxes of the array's shape.
    void append(const void* elements, hsize_t count, std::size_t size) {
        const char* from = static_cast<const char*>(elements);
        while (count > 0) {
            std::vector<hsize_t> start(shape_.size()), box(shape_.size(), 1);
            hsize_t rest = at_, block = 1;
            for (std::size_t i = shape_.size(); i-- > 0; rest /= shape_[i]) start[i] = rest % shape_[i];
            std::size_t along = shape_.size() - 1;
            for (; along > 0 && start[along] == 0 && block * shape_[along] <= count; --along) {
                box[along] = shape_[along];
                block *= shape_[along];
            }
            box[along] = std::min(count / block, shape_[along] - start[along]);
            const hsize_t written = box[along] * block;
            write(start, box, written, from);
            from += written * size;
            at_ += written;
            count -= written;
        }
    }
    void close() { array_.close(); }

 private:
    Handle create(hid_t file, const std::string& path) {
        const Handle space(h5_.H5Screate_simple(static_cast<int>(shape_.size()), shape_.data(), nullptr), h5_.H5Sclose),
            links(h5_.H5Pcreate(h5_.constant("H5P_CLS_LINK_CREATE_ID_g")), h5_.H5Pclose),
            how(h5_.H5Pcreate(h5_.constant("H5P_CLS_DATASET_CREATE_ID_g")), h5_.H5Pclose);
        check(h5_.H5Pset_create_intermediate_group(links, 1));
        check(h5_.H5Pset_obj_track_times(how, false));  // equal sweeps give equal bytes
        return {h5_.H5Dcreate2(file, path.c_str(), type_, space, links, how, H5P_DEFAULT), h5_.H5Dclose};
    }

    void write(const std::vector<hsize_t>& start, const std::vector<hsize_t>& box, hsize_t count, const void* from) {
        const Handle in_file(h5_.H5Screate_simple(static_cast<int>(shape_.size()), shape_.data(), nullptr),
                             h5_.H5Sclose),
            in_memory(h5_.H5Screate_simple(1, &count, nullptr), h5_.H5Sclose);
        check(h5_.H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start.data(), nullptr, box.data(), nullptr));
        check(h5_.H5Dwrite(array_, type_, in_memory, in_file, H5P_DEFAULT, from));
    }

    const Library& h5_;
    std::vector<hsize_t> shape_;
    Handle type_, array_;
    hsize_t at_ = 0;
};

constexpr const char *f64 = "H5T_IEEE_F64LE_g", *u64 = "H5T_STD_U64LE_g";

Handle type_named(const char* name) {
    const Library& h5 = Library::get();
    return {h5.H5Tcopy(h5.constant(name)), h5.H5Tclose};
}

// A column of the table, by rows.
class ColumnArray {
 public:
    using Numbers = std::function<double(const Rows&, std::size_t row)>;
    using Texts = std::function<std::string(const Rows&, std::size_t row)>;
    ColumnArray(hid_t file, const std::string& path, const std::vector<hsize_t>& shape, const std::string& units,
                Numbers numbers)
        : array_(file, path, shape, type_named(f64), units), numbers_(std::move(numbers)) {}
    ColumnArray(hid_t file, const std::string& path, const std::vector<hsize_t>& shape, std::size_t width, Texts texts)
        : array_(file, path, shape, text_type(width), ""),
          width_(std::max<std::size_t>(1, width)),
          texts_(std::move(texts)) {}

    // The column of signatures.
    ColumnArray(hid_t file, const std::string& path, const std::vector<hsize_t>& shape)
        : array_(file, path, shape, type_named(u64), "") {}

    void append(const Rows& rows) {
        if (!numbers_ && !texts_) return array_.append(rows.signatures.data(), rows.count(), sizeof(std::uint64_t));
        if (numbers_) {
            std::vector<double> column(rows.count());
            for (std::size_t i = 0; i < column.size(); ++i) column[i] = numbers_(rows, i);
            return array_.append(column.data(), column.size(), sizeof(double));
        }
        std::string column(rows.count() * width_, '\0');
        for (std::size_t i = 0; i < rows.count(); ++i) {
            const std::string text = texts_(rows, i);
            std::copy_n(text.begin(), std::min(text.size(), width_),
                        column.begin() + static_cast<std::ptrdiff_t>(i * width_));
        }
        array_.append(column.data(), rows.count(), width_);
    }
    void close() { array_.close(); }

 private:
    Array array_;
    std::size_t width_ = 0;
    Numbers numbers_;
    Texts texts_;
};

// The number of rows, and the maximum lengths of their texts.
struct TableExtent {
    hsize_t rows = 0;
    std::size_t held = 0, contacts = 0, ends = 0, modes = 0;
};

TableExtent extent_of(const SweepTable& table, const RowReader& each_rows) {
    TableExtent extent;
    each_rows([&](const Rows& rows) {
        extent.rows += rows.count();
        const auto widen = [&](std::size_t& width, ContactSet set) {
            if (!set.empty()) width = std::max(width, joined_names(table.model(), set, "+").size());
        };
        for (const ContactSet set : rows.held) widen(extent.held, set);
        for (const ContactSet set : rows.contacts) widen(extent.contacts, set);
        for (const Mode mode : rows.modes)
            extent.modes = std::max(extent.modes, modes_text(table.model(), mode).size());
        for (const RunEnd end : rows.ends) extent.ends = std::max(extent.ends, end.text().size());
    });
    return extent;
}

std::string options_text(const Options& options) {
    std::string text;
    for (const Option& option : all_options())
        if (!is_left_out(option, options))
            text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", option.key, to_text(option.get(options)));
    return text;
}

class SweepHdf5Writer {
 public:
    SweepHdf5Writer(hid_t file, const SweepTable& table, const TableExtent& extent)
        : file_(file), table_(table), extent_(extent) {
        is_grid_ = !table.is_section() && !table.sweep().random;
        for (const SweepAxis& axis : table.sweep().axes) shape_.push_back(axis.count);
        if (!is_grid_) shape_ = {extent.rows};
    }

    void write(const RowReader& each_rows) {
        const Library& h5 = Library::get();
        for (const char* group : {"/axes", "/values"})
            Handle(h5.H5Gcreate2(file_, group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), h5.H5Gclose).close();
        for (std::size_t axis = 0; axis < table_.sweep().axes.size(); ++axis) add_axis(axis);
        add_values();
        each_rows([&](const Rows& rows) {
            for (ColumnArray& column : columns_) column.append(rows);
        });
        for (ColumnArray& column : columns_) column.close();
    }

 private:
    void add_axis(std::size_t index) {
        const SweepAxis& axis = table_.sweep().axes[index];
        const std::string path = "/axes/" + axis.name, unit = unit_of_axis(table_.model().description(), axis.name);
        if (!is_grid_) {
            const auto value = [this, index](const Rows& rows, std::size_t row) {
                return table_.sweep().value(index, rows.points[row]);
            };
            columns_.emplace_back(file_, path, shape_, unit, value);
            return;
        }
        Array array(file_, path, {axis.count}, type_named(f64), unit);
        constexpr std::uint64_t at_once = 1 << 16;
        for (std::uint64_t first = 0; first < axis.count; first += at_once) {
            std::vector<double> values;
            for (std::uint64_t i = first; i < std::min(first + at_once, axis.count); ++i)
                values.push_back(axis.value(i));
            array.append(values.data(), values.size(), sizeof(double));
        }
        array.close();
    }

    void add_values() {
        const auto add_sets = [&](const std::string& path, std::size_t width, std::vector<ContactSet> Rows::*sets) {
            columns_.emplace_back(file_, path, shape_, width, [this, sets](const Rows& rows, std::size_t row) {
                const ContactSet set = (rows.*sets)[row];
                return set.empty() ? std::string() : joined_names(table_.model(), set, "+");
            });
        };
        if (table_.is_section()) {
            columns_.emplace_back(file_, "/values/t", shape_, "s",
                                  [](const Rows& rows, std::size_t row) { return rows.times[row]; });
            add_sets("/values/contact", extent_.contacts, &Rows::contacts);
        }
        const std::size_t numbers = table_.measures().numbers();
        std::size_t number = 0;
        for (const Column& column : table_.measures().columns()) {
            const std::string path = "/values/" + column.name;
            if (column.kind == Column::Kind::number) {
                const std::size_t place = number++;
                columns_.emplace_back(file_, path, shape_, column.unit, [=](const Rows& rows, std::size_t row) {
                    return rows.numbers[row * numbers + place];
                });
            } else if (column.kind == Column::Kind::held) {
                add_sets(path, extent_.held, &Rows::held);
            } else if (column.kind == Column::Kind::modes) {
                columns_.emplace_back(file_, path, shape_, extent_.modes, [this](const Rows& rows, std::size_t row) {
                    return modes_text(table_.model(), rows.modes[row]);
                });
            }
        }
        columns_.emplace_back(file_, "/values/outcome", shape_, extent_.ends,
                              [](const Rows& rows, std::size_t row) { return std::string(rows.ends[row].text()); });
        columns_.emplace_back(file_, "/signature", shape_);
    }

    hid_t file_;
    const SweepTable& table_;
    TableExtent extent_;
    bool is_grid_ = false;
    std::vector<hsize_t> shape_;
    std::vector<ColumnArray> columns_;
};

}  // namespace

std::string hdf5_unavailable_reason() { return Library::get().fault(); }

void write_hdf5(const std::string& path, const SweepTable& table, const SweepOrigin& origin,
                const RowReader& each_rows) {
    const Library& h5 = Library::get();
    if (!h5.fault().empty()) throw std::runtime_error(h5.fault());
    Handle file(h5.H5Fcreate(path.c_str(), overwrite, H5P_DEFAULT, H5P_DEFAULT), h5.H5Fclose);
    put_attribute(file, "software", origin.software);
    put_attribute(file, "origin", origin.command);
    put_attribute(file, "options", options_text(table.sweep().base.options));
    {
        // The text is an array, because an attribute holds at most 64 kB.
        Array system(file, "/system", {1}, text_type(origin.system.size()), "");
        system.append(origin.system.c_str(), 1, origin.system.size());
        system.close();
    }
    SweepHdf5Writer(file, table, extent_of(table, each_rows)).write(each_rows);
    file.close();
}

#endif

}  // namespace achilles
