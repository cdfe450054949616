// Export of a session: its plots as a figure, its run as data, the session as a journal, and the command lines that
// produce the same.
#pragma once

#include <memory>
#include <string>

#include "figure/publication.hpp"
#include "pictures/film.hpp"
#include "pictures/picture_format.hpp"
#include "session/session.hpp"

namespace achilles {

// The plots of a session (all, or those in `plots`) for print, with the visible pinned runs behind them.
Figure figure_of(const Session& session, const PublicationStyle& style);
Figure figure_of(const Session& session, const Plots& plots, const PublicationStyle& style);

// The mechanism at the current time in the current view, with its trail if that is shown. Throws InputError if the
// system has no drawing.
Drawing mechanism_of(const Session& session, const Theme& theme);

// The size of a picture on the page or, if the page has no width, `in_pixels` with its scale times publication_scale.
PictureSize size_of(const PaperSize& page, PictureSize in_pixels, const Figure& figure, const std::string& format);
PictureSize size_of(const PaperSize& page, PictureSize in_pixels, const Drawing& world, const std::string& format);

// The figure size in pixels for which curves are sampled: PublicationStyle::size. A page without a height counts as the
// tallest one, since the height depends on plots that do not exist yet. Vector formats are sampled more finely than
// their units, since printers resolve more.
Resolution resolution_of(const PaperSize& page, const PictureSize& in_pixels, const std::string& format);

// Exports what the file extension selects: .svg, .png or .pdf the plots, one plot or the mechanism; .json or .csv the
// run; .journal the session. The write is atomic; it replaces an existing file only with `overwrite`. Throws
// InputError.
void write_export(const Session& session, const command::Export& what);
// The bytes that it would write.
std::string exported(const Session& session, const command::Export& what);

// Starts an export to .mp4 or .gif in another process: the mechanism in motion beside the plots, at most
// `max_film_frames` frames. Throws InputError before drawing if it is not possible.
std::unique_ptr<FilmJob> begin_film(const Session& session, const command::Export& what);
constexpr double max_film_frames = 20000.0;
// Number and size of the frames of an animation.
struct FilmExtent {
    double frames = 0.0;
    int width = 0, height = 0;  // pixels
};
FilmExtent extent_of(const Session& session, const command::Export& what);

// The shell command that reproduces `what`: "figure" the plots, "run" the data, "explorer" the session as shown.
std::string command_for(const Session& session, const std::string& what);

}  // namespace achilles
