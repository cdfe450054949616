#include "journal/recovery.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "cli/write_files.hpp"
#include "journal/journal.hpp"
#include "session/replay_script.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

constexpr const char* name_format = "unsaved-{}-{}.journal";  // process id, sequence number

// $XDG_STATE_HOME/achilles, else ~/.local/state/achilles; empty without a home folder.
fs::path state_folder() {
    const char* const given = std::getenv("XDG_STATE_HOME");
    if (given != nullptr && fs::path(given).is_absolute()) return fs::path(given) / "achilles";
    const char* const home = std::getenv("HOME");
    return home == nullptr || *home == '\0' ? fs::path() : fs::path(home) / ".local/state/achilles";
}

// An unused file name: a process id may be reused after its process has ended.
fs::path new_file() {
    const fs::path folder = state_folder();
    if (folder.empty()) return {};
    std::error_code problem;
    if (fs::create_directories(folder, problem)) fs::permissions(folder, fs::perms::owner_all, problem);
    for (int i = 1;; ++i) {
        fs::path file = folder / fmt::format(name_format, ::getpid(), i);
        if (!fs::exists(file, problem)) return file;
    }
}

// Whether the window that writes this file is still open.
bool is_in_use(long process) {
    if (process == ::getpid()) return false;
    std::error_code problem;
    const fs::path there = fs::read_symlink(fmt::format("/proc/{}/exe", process), problem);
    return !problem && there.filename().string().rfind("achilles", 0) == 0;
}

std::string local_time(const fs::path& file) {
    struct stat status {};
    std::tm parts{};
    char text[32] = "";
    if (::stat(file.c_str(), &status) == 0 && ::localtime_r(&status.st_mtime, &parts) != nullptr)
        std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &parts);
    return text;
}

// The commands in the file; empty if it is not a recovery file.
std::vector<Command> steps_in(const fs::path& file) {
    try {
        const std::vector<Command> steps = parse_journal(read_text(file, 4 * largest_file), file.string());
        const bool is_ours =
            steps.size() == 2 && std::holds_alternative<command::SetText>(steps[1]) &&
            (std::holds_alternative<command::New>(steps[0]) || std::holds_alternative<command::Open>(steps[0]));
        return is_ours ? steps : std::vector<Command>();
    } catch (const InputError&) {
        return {};
    }
}

}  // namespace

void Recovery::keep(const Document& document, const std::string& text) {
    if (!text_.empty() && text == text_) return;
    text_ = text;
    if (file_.empty()) file_ = new_file();
    if (file_.empty()) return;
    const bool is_new = document.name == new_document().name;
    const std::vector<Command> steps{
        is_new ? Command(command::New{}) : Command(command::Open{name_anywhere(document.name)}),
        command::SetText{text}};
    try {
        OutputFiles files;
        files.add(file_);
        files.put(file_, journal_text(steps));
        files.commit(OutputFiles::Durability::fast);
    } catch (const InputError&) {
        file_.clear();  // disk full or read-only folder: try again at the next edit
    }
}

void Recovery::forget() {
    std::error_code ignored;
    if (!file_.empty()) fs::remove(file_, ignored);
    file_.clear();
    text_.clear();
}

std::vector<RecoveredText> left_unsaved() {
    std::vector<RecoveredText> all;
    std::error_code problem;
    const fs::path folder = state_folder();
    if (folder.empty()) return all;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem)) {
        long process = 0;
        int number = 0, end = 0;
        const std::string name = entry.path().filename().string();
        const int found = std::sscanf(name.c_str(), "unsaved-%ld-%d.journal%n", &process, &number, &end);
        if (found != 2 || static_cast<std::size_t>(end) != name.size() || is_in_use(process)) continue;
        const std::vector<Command> steps = steps_in(entry.path());
        if (steps.empty()) continue;
        const auto* open = std::get_if<command::Open>(&steps[0]);
        all.push_back(
            {entry.path(), open != nullptr ? open->system : new_document().name, local_time(entry.path()), steps});
    }
    std::sort(all.begin(), all.end(), [](const RecoveredText& a, const RecoveredText& b) { return a.when > b.when; });
    return all;
}

}  // namespace achilles
