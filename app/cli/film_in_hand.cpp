#include "cli/film_in_hand.hpp"

#include <filesystem>
#include <utility>

namespace achilles {

void FilmInHand::begin(std::unique_ptr<FilmJob> begun) {
    if (film_) throw InputError(begun->film(), {}, "another film is still being drawn", "wait for it, or stop it");
    film_ = std::move(begun);
}

bool FilmInHand::follow(Session& session, std::optional<FilmProgress>& progress) {
    if (!film_) {
        progress.reset();
        return false;
    }
    const bool is_given_up = progress && progress->is_given_up;
    if (is_given_up) film_->cancel();
    const bool has_ended = film_->update();
    progress = FilmProgress{film_->film(), film_->progress(), film_->share(), false};
    if (!has_ended) return false;
    const std::unique_ptr<FilmJob> film = std::move(film_);
    progress.reset();
    if (is_given_up)
        session.tell("stopped the film " + film->film());
    else if (film->is_made())
        session.tell("wrote " + std::filesystem::absolute(film->film()).lexically_normal().string());
    else if (film->has_frames())
        session.tell(film->said());
    else
        session.refuse(InputError(film->film(), {}, film->said()));
    return true;
}

}  // namespace achilles
