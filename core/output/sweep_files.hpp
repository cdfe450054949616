// The files of a sweep: its rows as CSV and HDF5, and the log that it is kept in until it is done.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "study/chunks.hpp"
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

// What a sweep has come to so far, in a file that survives whatever ends the program.

// The text that a log begins with: what a sweep must have in common with one that it goes on with, key by key.
struct SweepKey {
    std::string software, sweep, files, system;
};

// Why one of a log is not that of the same sweep: what differs, in a sentence; "" where nothing does.
std::string difference(const SweepKey& log, const SweepKey& asked);

// A log: the key, and the bytes of one chunk after the other, each behind its length and a checksum. The finished file could be
// neither: a CSV has no room for the key, and an HDF5 file that is cut off in the middle of a write cannot be opened again.
// So both are made of the log at the end, chunk by chunk; what that costs is copying, and room for both on the disk. A record that
// was not written whole, whatever ended it, is one that does not check, and what follows it is cut off.
class SweepLog {
 public:
    // A log as it is found: the end of the points that it has, from 0 on; the sweep has so many. Throws InputError where the file
    // is another one's, or is being written by another process; where `resume` is false, also where it has points that would be
    // lost. One with all points of the same sweep serves without `resume`: only its files are still to be made.
    SweepLog(std::string path, const SweepKey& key, bool resume, std::uint64_t points);
    ~SweepLog();
    SweepLog(const SweepLog&) = delete;
    SweepLog& operator=(const SweepLog&) = delete;

    std::uint64_t done() const { return done_; }
    // Appends a chunk. Throws std::system_error; what was written before stays.
    void append(Chunk chunk, const std::string& bytes);
    // All chunks from the first on.
    void each(const std::function<void(Chunk, std::string_view)>& take) const;
    // It has served.
    void remove();

 private:
    struct Header;
    void go_on(const SweepKey& key, bool resume, std::uint64_t points);
    bool read_key(SweepKey& key);
    void begin(const SweepKey& key);
    void find_end();
    std::string path_;
    int file_ = -1;
    std::uint64_t done_ = 0;              // points
    std::uint64_t first_ = 0, size_ = 0;  // bytes: where the chunks begin and end
};

}  // namespace achilles
