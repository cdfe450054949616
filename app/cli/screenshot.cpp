// The explorer as an off-screen picture, independent of the clock.
#include <algorithm>
#include <vector>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/explore.hpp"
#include "image/notes.hpp"
#include "journal/journal.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/picture_job.hpp"
#include "session/replay_script.hpp"
#include "surface/offscreen.hpp"

namespace achilles {

int screenshot(const ScreenshotOptions& given, PictureJob& job) {
    ScreenshotOptions options = given;
    static_cast<ExploreOptions&>(options) = with_link(given);
    job.check_size(options.width, options.height);
    format_for(options.out, "png", "; for the plots alone as SVG or PDF: achilles figure");
    job.add(options.out);
    if (!options.record.empty() && !job.reproduces()) {
        refuse_record(options.record);
        job.add(options.record);
    }
    Inputs& inputs = job.inputs();
    std::vector<Command> journal;
    inputs.trust(
        trust_of(options.allow_files, {options.system.value_or(""), options.journal}, work_options(options.overrides)));
    if (!options.journal.empty()) journal = inputs.journal(options.journal);
    const std::string name = options.system     ? *options.system
                             : job.reproduces() ? inputs.first_system()
                                                : first_system();
    Session session = open_session(name, inputs.system(name), options.settings, options.overrides, source_of(job), {});
    std::vector<Command> record = opening(session, options);
    const std::vector<Command> more = inputs.steps(options.steps);
    journal.insert(journal.end(), more.begin(), more.end());
    record.insert(record.end(), journal.begin(), journal.end());
    apply_all(session, journal);
    session.settle();
    if (!options.record.empty()) job.put_text(options.record, journal_text(record));
    PanelState state = panel_state(false);
    job.put(options.out, "", {{session.system(), &session.trajectory()}}, [&](const Notes& notes) {
        SurfaceOptions enlarged = surface_options(options);
        enlarged.scale = std::min(
            enlarged.scale * session.scene().text_scale(options.width / options.scale, options.height / options.scale),
            largest_scale);
        Offscreen surface(enlarged);
        const Image image = surface.frame([&] { explorer(session, state); }, 3);
        return with_notes(png_bytes(image), notes);
    });
    job.commit();
    return session.trajectory().outcome.kind == Outcome::Kind::end_time ? reached_end : stopped_early;
}

}  // namespace achilles
