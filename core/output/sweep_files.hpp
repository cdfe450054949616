// The files of a sweep: its rows as CSV and HDF5, and the log that stores them until it is complete.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "analysis/chunks.hpp"
#include "analysis/table.hpp"

namespace achilles {

// Heading of a column, and its unit; "" if unknown.
struct SweepHeading {
    std::string name, unit;
};
// The headings of all columns: the axes, for a section t and contact, the prints, outcome.
std::vector<SweepHeading> sweep_headings(const SweepTable& table);

// The first line; with `units`, also a second line with the unit of each column.
std::string sweep_csv_heading(const SweepTable& table, bool units);
// One line per row. Values that do not exist are empty.
std::string sweep_csv(const SweepTable& table, const Rows& rows);

// Rows as bytes, and the inverse. Throws std::runtime_error if the bytes are not rows of the table.
std::string to_bytes(const Rows& rows);
Rows rows_from(std::string_view bytes, const SweepTable& table);

// The origin of a sweep, stored as attributes in HDF5.
struct SweepOrigin {
    std::string software;  // "Achilles 0.1.0"
    std::string command;   // in shell syntax, without file names and --resume
    std::string system;    // the text of the system file
};

// The reason why this build or machine cannot write HDF5; "" if it can.
std::string hdf5_unavailable_reason();
// The reason why the prints of a table cannot be names in a file: the path of one leads through another. Else "".
std::string hdf5_name_error(const SweepTable& table);
// Calls take(rows) for each chunk, from the first one on. May be called repeatedly.
using RowReader = std::function<void(const std::function<void(const Rows&)>& take)>;
// Writes /axes/NAME, the values along each axis of a grid, or of every row without a grid. Writes /values/TEXT, in the
// shape of the grid or by rows, with the outcome and, for a section, t and contact, and /signature in the same shape.
// Units are attributes of these arrays, origin and options attributes of the file. The bytes do not depend on when and
// how the rows were computed. Throws std::runtime_error.
void write_hdf5(const std::string& path, const SweepTable& table, const SweepOrigin& origin,
                const RowReader& each_rows);

// The text at the start of a log: the properties that must be equal for a sweep to be resumed.
struct SweepKey {
    std::string software, sweep, files, system;
};

// The difference between the sweep of a log and the requested one, as a sentence; "" if they are the same.
std::string difference(const SweepKey& log, const SweepKey& current);

// Stores the results of an incomplete sweep so that they survive any end of the program. It has the key, then for each
// chunk a header with its length and a checksum, and its bytes. The final files cannot serve: CSV has no room for the
// key, and an HDF5 file whose writing was interrupted cannot be opened. Both are made from the log at the end, chunk by
// chunk, at the cost of copying and disk space. A record that was not written completely fails its checksum, and the
// log is cut before it.
class SweepLog {
 public:
    // Opens or creates a log. `points` is the number of points of the sweep. Throws InputError if the file is something
    // else, or in use by another process. Without `resume` it also throws if the log has points, unless they are all
    // points of the same sweep: then only its files remain to be made.
    SweepLog(std::string path, const SweepKey& key, bool resume, std::uint64_t points);
    ~SweepLog();
    SweepLog(const SweepLog&) = delete;
    SweepLog& operator=(const SweepLog&) = delete;

    std::uint64_t done() const { return done_; }
    // Appends a chunk. Throws std::system_error; earlier chunks are not affected.
    void append(Chunk chunk, const std::string& bytes);
    // Calls take(chunk, bytes) for all stored chunks, in the order in which they were appended.
    void each(const std::function<void(Chunk, std::string_view)>& take) const;
    // Deletes the log.
    void remove();

 private:
    struct Header;
    void go_on(const SweepKey& key, bool resume, std::uint64_t points);
    bool read_key(SweepKey& key);
    void begin(const SweepKey& key);
    void find_end();
    std::string path_;
    int file_ = -1;
    std::uint64_t done_ = 0;              // number of points
    std::uint64_t first_ = 0, size_ = 0;  // byte offsets of the start and the end of the chunks
};

}  // namespace achilles
