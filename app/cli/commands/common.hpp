// Options that several commands share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/overrides.hpp"
#include "pictures/picture_format.hpp"

namespace CLI {
class App;
}

namespace achilles {

struct Enclosure;
struct ErrorEstimate;
struct Trajectory;

// SYSTEM, which must be given.
void add_system_argument(CLI::App& command, std::string& system);

// --format png|svg|pdf.
void add_format_option(CLI::App& command, std::string& format, const std::string& about);

// --view NAME, as often as wished for.
void add_view_option(CLI::App& command, std::vector<std::string>& views, const std::string& about);

// --set and everything that goes over a system's options.
void add_run_options(CLI::App& command, std::vector<std::string>& settings, OptionOverrides& overrides);

// --width W of a proof; what is said of it besides.
void add_width_option(CLI::App& command, double& width, const std::string& about);

// --do COMMAND, a line of a journal; may be given again. --allow-files.
void add_step_option(CLI::App& command, std::vector<std::string>& steps, bool& allow_files);
// --scale S.
void add_scale_option(CLI::App& command, double& scale, const std::string& about = "factor for text and strokes (default 1)");

// --size WxH and --scale S. `about` replaces what they say of themselves.
void add_size_options(CLI::App& command, int& width, int& height, double& scale, const std::string& about = {});

// --width-mm and what belongs to it, in the place of --size and --scale.
void add_page_options(CLI::App& command, PaperSize& page);

// Prints on standard error what a person may not expect of a finished run: why it stopped early and its remarks; where these stand
// elsewhere only that it did. With an estimate also the time after which the run is not trusted. The exit status.
int told_of(const Trajectory& trajectory, bool with_reasons = true, const ErrorEstimate* estimate = nullptr);
// The same of a proof: where it ends undecided, and why, unless that stands elsewhere.
int told_of(const Enclosure& proof, bool with_reason = true);

}  // namespace achilles
