// What a session gives away, and the journals that it replays.
#include <fmt/format.h>

#include "pictures/film.hpp"
#include "pictures/take_away.hpp"
#include "session/refusal.hpp"
#include "session/session.hpp"

namespace achilles {

namespace {

// The text that a command line finds under a system's name; nothing where there is no such file.
std::optional<std::string> held_by_file(const SystemSource& library, const std::string& system) {
    try {
        return (library.open ? library.open(system) : open_document(system, library.find(system))).text;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

constexpr int deepest = 8;  // journals in journals: one that names itself comes to an end

}  // namespace

void Session::perform(const command::Export& command) {
    // Until then the result on the screen is of another run than the sliders say, or of none.
    if (under_way() != nullptr || trajectory().outcome.kind == Outcome::Kind::cancelled)
        throw refusal("the run is still under way", "export again when it has finished");
    if (library_.before_writing) library_.before_writing(command.file);
    const std::filesystem::path file(command.file);
    const std::string path = (file.is_absolute() ? file : library_.folder / file).lexically_normal().string();
    notice_ = "wrote " + path;
    if (!library_.exports) return;
    if (!is_film(command.file)) return take_away(*this, command);
    std::unique_ptr<FilmJob> film = begin_film(*this, command);
    if (library_.film) {
        notice_.clear();
        return library_.film(std::move(film));
    }
    film->wait();
    if (film->is_made()) return;
    if (film->has_frames()) return warn(film->said());  // ffmpeg failed
    throw InputError(command.file, {}, film->said());
}

void Session::perform(const command::Copy& command) {
    // The line names a file: it must hold what runs here.
    if (held_by_file(library_, system()) != description().source_text || !document_.problems.empty())
        throw refusal("this text is not saved in a file, and a command line needs a file", "save it first, then copy");
    copied_ = command_for(*this, command.what);
    ++copies_;
    notice_ = "copied: " + copied_;
}

void Session::perform(const command::Wait& command) { play_on(*this, command.seconds); }

void Session::perform(const command::Replay& command) {
    if (!library_.journal) throw refusal("there are no journals here");
    if (replaying_ >= deepest) throw refusal("too many journals replay each other");
    const std::vector<Command> journal = library_.journal(command.journal);
    ++replaying_;
    std::string first_error;
    std::vector<std::string> told;
    for (const Command& step : journal) {
        apply(step);
        if (first_error.empty()) first_error = error_;
        told.insert(told.end(), warnings_.begin(), warnings_.end());
    }
    warnings_ = std::move(told);
    --replaying_;
    if (!first_error.empty()) throw refusal(first_error);
}

}  // namespace achilles
