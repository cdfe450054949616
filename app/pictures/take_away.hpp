// What a session gives away: its plots as a figure, its run as data, itself as a journal, and the command lines that
// make the same.
#pragma once

#include <memory>
#include <string>

#include "figure/publication.hpp"
#include "pictures/film.hpp"
#include "pictures/picture_format.hpp"
#include "session/session.hpp"

namespace achilles {

// Plots of a session (all, or those of them that `plots` has) for print, the pinned runs that are shown behind them.
Figure figure_of(const Session& session, const PublicationStyle& style);
Figure figure_of(const Session& session, const Plots& plots, const PublicationStyle& style);

// The mechanism at the present time, as much of the world as is looked at, with its trail where that is shown. Throws
// InputError where the system draws none.
Drawing mechanism_of(const Session& session, const Theme& theme);

// As large as the page says; without a width there as many pixels as `in_pixels`, its scale times publication_scale.
PictureSize size_of(const PaperSize& page, PictureSize in_pixels, const Figure& figure, const std::string& format);
PictureSize size_of(const PaperSize& page, PictureSize in_pixels, const Drawing& world, const std::string& format);

// The size of a figure, pixels, by which its curves are sampled: PublicationStyle::size. A page without a
// height counts as the highest one, since the plots that set the height are not made yet. A printer resolves more than the
// points that a page in a vector format is measured in.
Resolution resolution_of(const PaperSize& page, const PictureSize& in_pixels, const std::string& format);

// Writes what the file's ending asks for: .svg, .png or .pdf the plots, one of them or the mechanism; .json or .csv the run; .journal the
// session. Whole or not at all; over another file only with `overwrite`. Throws InputError.
void take_away(const Session& session, const command::Export& what);

// Begins what an export to .mp4 or .gif asks for, in a process of its own: the mechanism in motion beside the plots, at most
// `most_film_frames`. Throws InputError before anything is drawn where it cannot be made.
std::unique_ptr<FilmJob> begin_film(const Session& session, const command::Export& what);
constexpr double most_film_frames = 20000.0;
// How many pictures that are, and how large.
struct FilmExtent {
    double frames = 0.0;
    int width = 0, height = 0;  // pixels
};
FilmExtent extent_of(const Session& session, const command::Export& what);

// The line for a shell that makes it: "figure" the plots, "run" the data, "explorer" all that is seen.
std::string command_for(const Session& session, const std::string& what);

}  // namespace achilles
