#include "output/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "expression/parse.hpp"
#include "expression/read_number.hpp"
#include "system/description.hpp"

namespace achilles {

std::vector<double> equidistant(int count, double start, double end) {
    std::vector<double> times;
    for (int i = 0; i < count; ++i) times.push_back(start + (end - start) * i / (count - 1));
    times.back() = end;
    return times;
}

std::vector<double> read_instants(std::string_view text, const std::string& name, double start, double end) {
    constexpr std::string_view spaces = " \t\r";
    std::vector<double> times;
    int number = 0;
    while (!text.empty()) {
        const std::size_t size = std::min(text.find('\n'), text.size());
        const std::string line(text.substr(0, size));
        text.remove_prefix(std::min(size + 1, text.size()));
        ++number;
        const std::string_view words = std::string_view(line).substr(0, line.find('#'));
        const std::size_t first = words.find_first_not_of(spaces);
        if (first == words.npos) continue;
        const auto refuse = [&](const std::string& why) {
            return InputError(name, {number, static_cast<int>(first) + 1}, why, {}, line);
        };
        double t = 0.0;
        try {
            t = read_number(words).value;
        } catch (const ParseError& problem) {
            throw refuse(problem.what());
        }
        if (!(t >= start && t <= end)) throw refuse(fmt::format("{} is outside the run, {} to {}", t, start, end));
        times.push_back(t);
    }
    if (times.empty()) throw InputError(name, {}, "the file contains no time", "write one time per line");
    return times;
}

std::vector<Sample> samples_of_curve(const Trajectory& trajectory) {
    constexpr std::size_t wanted = 1000;
    return Sampler(trajectory).all(static_cast<int>(wanted / std::max<std::size_t>(1, trajectory.pieces.size())));
}

std::vector<Sample> samples_at(const Trajectory& trajectory, const std::vector<double>& times) {
    Sampler sampler(trajectory);
    std::vector<Sample> samples;
    for (const double t : times)
        if (t <= trajectory.end_time) samples.push_back(sampler.at(t));
    return samples;
}

}  // namespace achilles
