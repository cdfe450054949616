// Fuzz target: any bytes as a system file. It is rejected with InputError. Otherwise it is derived, simulated for a
// short time and written. Every state must be finite and every output valid.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "model/model.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "require.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"
#include "system/description.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

using namespace achilles;
using fuzz::require;

// A run of at most 20 impacts and 200 steps, so that it is short for any motion.
Run short_run(const Model& model) {
    Run run = model.default_run();
    run.options.tolerance = std::max(run.options.tolerance, 1e-8);
    run.options.max_impacts = std::min(run.options.max_impacts, 20);
    run.options.max_steps = std::min(run.options.max_steps, 200);
    return run;
}

bool finite(const State& state) { return state.q.allFinite() && state.v.allFinite(); }

void require_sound(const Trajectory& trajectory) {
    require(!trajectory.phases.empty(), "a run has a phase");
    require(std::isfinite(trajectory.end_time) && finite(trajectory.end), "the end is finite");
    require(trajectory.end_time <= trajectory.run.options.end_time, "a run ends in time");
    const bool reached = trajectory.outcome.kind == Outcome::Kind::end_time;
    require(!reached || trajectory.end_time == trajectory.run.options.end_time, "the end time is reached");
    require(reached || !trajectory.outcome.message.empty(), "a run that stops early says why");
    double last = 0.0;
    for (const Event& event : trajectory.events) {
        require(event.t >= last && event.t <= trajectory.end_time, "events stand in time");
        require(finite({event.q, event.v_before}) && finite({event.q, event.v_after}), "events are finite");
        last = event.t;
    }
    for (const Sample& sample : Sampler(trajectory).all(1)) require(finite(sample.state), "samples are finite");

    const auto json = nlohmann::json::parse(to_json(trajectory), nullptr, false);
    require(!json.is_discarded(), "JSON is JSON");
    for (const auto& x : json.at("end").at("q")) require(x.is_number(), "the end is written in numbers");
    const std::string csv = to_csv(trajectory);
    const std::string_view rows = std::string_view(csv).substr(csv.find('\n'));
    require(rows.find("nan") == rows.npos && rows.find("inf") == rows.npos, "CSV has numbers only");
    require(!summary(trajectory).empty(), "there is a summary");
}

// Ranges [begin, end) of the texts between quotes on one line: expressions and names.
std::vector<std::pair<std::size_t, std::size_t>> strings_of(std::string_view text) {
    std::vector<std::pair<std::size_t, std::size_t>> strings;
    std::size_t open = text.npos;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\n') open = text.npos;
        if (text[i] != '"') continue;
        if (open != text.npos) strings.emplace_back(open, i);
        open = open == text.npos ? i + 1 : text.npos;
    }
    return strings;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const auto model =
            std::make_shared<const Model>(parse_system(std::string(reinterpret_cast<const char*>(data), size)));
        const Run asked = model->default_run();
        model->check(asked);
        require_sound(simulate(model, short_run(*model)));
    } catch (const InputError& error) {
        require(error.what()[0] != '\0' && !error.message.empty(), "an error says what is wrong");
    }
    return 0;
}

// Changes at arbitrary places mostly give invalid TOML. So every other change is made inside one string.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
    std::minstd_rand random(seed);
    const auto strings = strings_of({reinterpret_cast<const char*>(data), size});
    if (strings.empty() || random() % 2 == 0) return LLVMFuzzerMutate(data, size, most);
    const auto [begin, end] = strings[random() % strings.size()];
    std::vector<std::uint8_t> inner(data + begin, data + end);
    inner.resize(inner.size() + (most - size));
    if (inner.empty()) return LLVMFuzzerMutate(data, size, most);  // an empty string without room to grow
    inner.resize(LLVMFuzzerMutate(inner.data(), end - begin, inner.size()));
    constexpr std::string_view words = "+-*/^()'. 0123456789";
    for (std::uint8_t& byte : inner)
        if (byte < 0x20 || byte > 0x7e || byte == '"' || byte == '\\')
            byte = static_cast<std::uint8_t>(words[byte % words.size()]);
    std::memmove(data + begin + inner.size(), data + end, size - end);
    std::copy(inner.begin(), inner.end(), data + begin);
    return size - (end - begin) + inner.size();
}
