// The film that is drawn beside a window: one at a time.
#pragma once

#include <memory>
#include <optional>

#include "panels/panels.hpp"
#include "pictures/film.hpp"
#include "session/session.hpp"

namespace achilles {

class FilmInHand {
 public:
    // Throws InputError while another one is drawn.
    void begin(std::unique_ptr<FilmJob> begun);
    bool is_busy() const { return film_ != nullptr; }
    // Tells how far it is, takes from there whether it is given up, and tells the session what became of it: then true.
    bool follow(Session& session, std::optional<FilmProgress>& progress);

 private:
    std::unique_ptr<FilmJob> film_;
};

}  // namespace achilles
