// The files of a sweep: its rows as CSV and HDF5, and the log that it is kept in until it is done.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "study/table.hpp"

namespace achilles {

// What stands above a column, and its unit, empty where it is not known.
struct SweepHeading {
    std::string name, unit;
};
// Of all columns: the axes, of a section t and contact, the prints, outcome.
std::vector<SweepHeading> sweep_headings(const SweepTable& table);

// The first line, and with `units` a second one with the unit of every column.
std::string sweep_csv_heading(const SweepTable& table, bool units);
// A line for each row. What does not exist is empty.
std::string sweep_csv(const SweepTable& table, const Rows& rows);

// Rows as bytes, and back. Throws std::runtime_error where they are none of the table's.
std::string to_bytes(const Rows& rows);
Rows rows_from(std::string_view bytes, const SweepTable& table);

// Where a sweep comes from: what HDF5 carries as attributes.
struct SweepOrigin {
    std::string software;  // "Achilles 0.1.0"
    std::string command;   // as a shell reads it, without files and --resume
    std::string system;    // the text of its file
};

// Whether this build and machine write HDF5; why not, else "".
std::string why_no_hdf5();
// What keeps the prints of a table from being names in a file: the path of one leads through another; else "".
std::string fault_of_hdf5(const SweepTable& table);
// Reads all rows, a chunk after the other, from the first on: take(rows). Asked more than once.
using EachRows = std::function<void(const std::function<void(const Rows&)>& take)>;
// Writes /axes/NAME, the values along each axis of a grid, else those of every row; /values/TEXT, in the shape of the grid or
// by rows, with the outcome and, of a section, t and contact; /signature in the same shape; units as attributes of each, the origin and the options as
// those of the file. Nothing depends on when and how the rows were made. Throws std::runtime_error.
void write_hdf5(const std::string& path, const SweepTable& table, const SweepOrigin& origin, const EachRows& each_rows);

}  // namespace achilles
