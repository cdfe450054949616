#include "cli/sweep_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "cli/assets.hpp"
#include "output/output.hpp"
#include "pictures/origin.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, int problem) {
    throw std::system_error(problem, std::generic_category(), path);
}

// To a file that is open.
void put(int file, std::string_view bytes, const std::string& path) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(path, errno);
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

// Opens the file, or standard output, and closes it. Messages call it `name`, as the user did.
void write_file(const std::string& path, const std::string& name, const std::function<void(int file)>& write) {
    const bool is_standard = path == "-";
    const int file = is_standard ? STDOUT_FILENO : ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) fail(name, errno);
    try {
        write(file);
    } catch (...) {
        if (!is_standard) ::close(file);
        throw;
    }
    if (!is_standard && ::close(file) != 0) fail(name, errno);
}

// Standard output, or a device.
bool is_stream(const std::string& path) {
    std::error_code ignored;
    const fs::file_status there = fs::status(path, ignored);
    return path == "-" || (fs::exists(there) && !fs::is_regular_file(there));
}

// The two parts of what is kept of a chunk: the text of its rows, behind its length, and the rows.
std::string_view text_in(std::string_view bytes) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data(), sizeof size);
    return bytes.substr(sizeof size, size);
}

std::string_view rows_in(std::string_view bytes) { return bytes.substr(sizeof(std::uint64_t) + text_in(bytes).size()); }

}  // namespace

SweepOutput::SweepOutput(const SweepTable& table, const SweepOutputAsked& asked, const SweepPictures& pictures,
                         const fs::path& system_file, const std::string& system_name)
    : table_(table), pictures_(pictures), csv_(asked.csv), hdf5_(asked.hdf5), units_(asked.units) {
    if (csv_.empty() && !keeps_rows()) csv_ = "-";
    if (units_ && csv_.empty()) throw InputError("--units", {}, "this needs --csv F");
    if (hdf5_ == "-") throw InputError("--hdf5 -", {}, "HDF5 output needs a file", "write --hdf5 F");
    if (!hdf5_.empty()) {
        if (const std::string why = why_no_hdf5(); !why.empty()) throw InputError("--hdf5", {}, why, "write --csv F");
        if (const std::string fault = fault_of_hdf5(table); !fault.empty()) throw InputError("--hdf5", {}, fault);
    }
    const SystemDescription& description = table.model().description();
    const std::string name = is_system_path(system_name) ? system_file.filename().string() : system_name;
    origin_ = {"Achilles " + version(),
               "achilles sweep " + shell_word(name) + " " + to_text(table.sweep(), description),
               description.source_text};
    files_.spare(system_file);
    for (const std::string& file : {csv_, hdf5_})
        if (!file.empty()) files_.add(file);
    for (const std::string& file : pictures_.files()) files_.add(file);
    if (is_stream(hdf5_)) throw InputError("--hdf5 " + hdf5_, {}, "HDF5 output needs a file");
    log_path_ = csv_.empty() || is_stream(csv_) ? hdf5_ : csv_;
    if (log_path_.empty() && !pictures_.files().empty()) log_path_ = pictures_.files().front();
    if (log_path_.empty()) {
        if (asked.resume) throw InputError("--resume", {}, "this needs a file: --csv F, --hdf5 F or --out F");
        stream_ = csv_ == "-" ? STDOUT_FILENO : open_in_place(csv_);
        if (stream_ < 0)
            throw InputError(csv_, {}, fmt::format("the file cannot be written: {}", std::strerror(errno)));
        put(stream_, sweep_csv_heading(table_, units_), name_of_csv());
        return;
    }
    log_path_ += ".part";
    files_.refuse_output(log_path_);
    files_.add(log_path_);
    log_ = std::make_unique<SweepLog>(log_path_, key(), asked.resume, table.sweep().count());
}

SweepOutput::~SweepOutput() {
    if (stream_ > STDOUT_FILENO) ::close(stream_);
}

std::string SweepOutput::name_of_csv() const { return csv_ == "-" ? "standard output" : csv_; }

SweepKey SweepOutput::key() const {
    std::string files;
    if (!csv_.empty()) files += units_ ? "csv with units " : "csv ";
    if (!hdf5_.empty()) files += "hdf5 ";
    if (!pictures_.files().empty()) files += "pictures ";
    return {origin_.software, to_text(table_.sweep(), table_.model().description()), files, origin_.system};
}

std::string kept_bytes(const SweepTable& table, SweepKept kept, const Rows& rows) {
    const std::string text = kept.text ? sweep_csv(table, rows) : "";
    if (!kept.in_log) return text;
    const std::uint64_t size = text.size();
    std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
    bytes += text;
    if (kept.rows) bytes += to_bytes(rows);
    return bytes;
}

void SweepOutput::append(Chunk chunk, const std::string& bytes) {
    if (log_) return log_->append(chunk, bytes);
    put(stream_, bytes, name_of_csv());
    printed_ += chunk.count;
}

void SweepOutput::write_csv(const std::string& path) const {
    const std::string name = name_of_csv();
    write_file(path, name, [&](int file) {
        put(file, sweep_csv_heading(table_, units_), name);
        log_->each([&](Chunk, std::string_view bytes) { put(file, text_in(bytes), name); });
    });
}

// Under another name first, which is always the same: one that was left behind is overwritten. On disk before it has its own,
// with the mode of what it replaces.
void SweepOutput::make(const std::string& path, const std::function<void(const std::string&)>& write) const {
    if (is_stream(path)) return write(path);
    const fs::path target = fs::weakly_canonical(path);
    const std::string file = target.string() + ".part.new";
    try {
        write(file);
        const int written = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
        const int problem = written < 0 || ::fsync(written) != 0 ? errno : 0;
        if (written >= 0) ::close(written);
        if (problem != 0 && problem != EINVAL) fail(path, problem);
        std::error_code ignored;
        const fs::file_status there = fs::status(target, ignored);
        if (fs::exists(there)) fs::permissions(file, there.permissions(), ignored);
        fs::rename(file, target);
    } catch (const std::system_error&) {
        ::unlink(file.c_str());
        throw;
    }
}

bool SweepOutput::draw(const EachRows& each_rows) {
    if (pictures_.files().empty()) return true;
    const std::optional<Figure> figure = pictures_.figure(each_rows);
    if (!figure) return false;
    for (const std::string& picture : pictures_.files()) {
        const std::string bytes = pictures_.bytes(*figure, picture);
        make(picture,
             [&](const std::string& path) { write_file(path, picture, [&](int file) { put(file, bytes, picture); }); });
        made_.push_back(picture);
    }
    return true;
}

bool SweepOutput::finish() {
    if (!log_) return true;
    if (!csv_.empty()) make(csv_, [&](const std::string& file) { write_csv(file); });
    if (!csv_.empty() && csv_ != "-") made_.push_back(csv_);
    const EachRows each_rows = [&](const std::function<void(const Rows&)>& take) {
        log_->each([&](Chunk, std::string_view bytes) { take(rows_from(rows_in(bytes), table_)); });
    };
    if (!hdf5_.empty())
        make(hdf5_, [&](const std::string& file) {
            errno = 0;
            try {
                write_hdf5(file, table_, origin_, each_rows);
            } catch (const std::runtime_error&) {
                fail(hdf5_, errno == 0 ? EIO : errno);
            }
        });
    if (!hdf5_.empty()) made_.push_back(hdf5_);
    const bool is_drawn = draw(each_rows);
    log_->remove();
    return is_drawn;
}

std::string SweepOutput::how_to_continue() {
    if (!log_) return "";
    if (log_->done() == table_.sweep().count())
        return fmt::format("; the runs are kept in {}: the same command writes the files", log_path_);
    if (log_->done() > 0) return fmt::format(": the same command with --resume continues from {}", log_path_);
    log_->remove();  // there is nothing in it
    return "";
}

}  // namespace achilles
