// Sessions on systems of the assets, and surfaces for the explorer.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "journal/journal.hpp"
#include "model/read_system.hpp"
#include "panels/panels.hpp"
#include "surface/offscreen.hpp"

namespace achilles::test {

inline SystemDescription system(const std::string& name) {
    return read_system(ACHILLES_SOURCE_DIR "/assets/systems/" + name + ".toml");
}

// The name of a mechanism typed as bodies, for the functions below.
inline std::string mechanism(const std::string& name) { return "../../tests/reference/mechanisms/" + name; }

inline SystemSource library() {
    return {[](const std::string& name) -> std::filesystem::path {
                if (name.find('/') != std::string::npos && !name.starts_with("../")) return name;
                return ACHILLES_SOURCE_DIR "/assets/systems/" + name + ".toml";
            },
            {}};
}

inline Session session(const std::string& name, Timeout patience = {}) {
    return {name, system(name), library(), patience};
}

// Applies the commands of a journal, each without an error.
inline void apply(Session& session, const std::string& journal) {
    for (const Command& command : parse_journal(journal)) {
        session.apply(command);
        EXPECT_EQ(session.error(), "") << to_text(command);
    }
}

// Elastic impacts up to max_impacts: takes seconds.
inline void ask_for_a_long_run(Session& session) {
    session.apply(command::SetEndTime{1e6});  // first, so that no short run can finish in between
    session.apply(command::Set{"e", 1.0});
}

// A surface with the explorer's options.
inline SurfaceOptions surface(int width = 1280, int height = 800, double scale = 1.0) {
    SurfaceOptions result;
    result.width = width;
    result.height = height;
    result.scale = scale;
    result.figure_text_size = 13.0;
    result.fonts = ACHILLES_BINARY_DIR "/assets/fonts";
    return result;
}

inline PanelState panels() {
    PanelState state;
    state.systems = {{"ball_on_sine", "Ball bouncing on a sinusoidal surface"},
                     {"double_pendulum", "Double pendulum with a mechanical stop"}};
    return state;
}

}  // namespace achilles::test
