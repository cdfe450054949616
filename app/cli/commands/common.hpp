// Options shared by several commands.
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

// Required argument SYSTEM.
void add_system_argument(CLI::App& command, std::string& system);

// --format png|svg|pdf.
void add_format_option(CLI::App& command, std::string& format, const std::string& about);

// --view NAME, repeatable.
void add_view_option(CLI::App& command, std::vector<std::string>& views, const std::string& about);

// --set and all options of a run.
void add_run_options(CLI::App& command, std::vector<std::string>& settings, OptionOverrides& overrides);

// --width W of a proof; `about` completes its help text.
void add_width_option(CLI::App& command, double& width, const std::string& about);

// --do COMMAND, a line of a journal, repeatable; and --allow-files.
void add_step_option(CLI::App& command, std::vector<std::string>& steps, bool& allow_files);
// --scale S.
void add_scale_option(CLI::App& command, double& scale,
                      const std::string& about = "factor for text and strokes (default 1)");

// --size WxH and --scale S. `about` replaces their help texts.
void add_size_options(CLI::App& command, int& width, int& height, double& scale, const std::string& about = {});

// --width-mm and the related options, as an alternative to --size and --scale.
void add_page_options(CLI::App& command, PaperSize& page);

// Prints notes about a finished run to standard error: why it stopped early, and its remarks. Without `with_reasons`:
// only that it stopped, for callers that print the reasons elsewhere. With an estimate: also the time after which the
// run is inaccurate. Returns the exit status.
int print_notes(const Trajectory& trajectory, bool with_reasons = true, const ErrorEstimate* estimate = nullptr);
// The same for a proof: where it ends undecided and, unless printed elsewhere, why.
int print_notes(const Enclosure& proof, bool with_reason = true);

}  // namespace achilles
