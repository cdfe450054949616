#include "pictures/player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "cli/assets.hpp"
#include "figure/animation.hpp"
#include "figure/publication.hpp"
#include "image/notes.hpp"
#include "output/event_descriptions.hpp"
#include "output/output.hpp"
#include "paint/svg.hpp"
#include "pictures/origin.hpp"
#include "pictures/player_drawings.hpp"
#include "pictures/player_text.hpp"
#include "session/replay_script.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// Size of a plot, pixels. It is that of a small screen, where a plot is as wide as the page.
constexpr SvgSize plot_size{480, 320, 1.0};

std::string css_variables(const Theme& theme) {
    std::string text = ":root {";
    for (const auto& [name, color] : {std::pair{"page", theme.page},
                                      {"card", theme.background},
                                      {"ink", theme.ink},
                                      {"faint", theme.faint},
                                      {"accent", theme.accent},
                                      {"border", theme.border},
                                      {"selected", theme.selected}})
        text += fmt::format(" --{}: #{:02x}{:02x}{:02x};", name, color.r, color.g, color.b);
    return text + " }\n";
}

// The expression of a content security policy for the player's script: its SHA-256 in base64.
std::string script_hash() {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < player_hash.size(); i += 2)
        bytes += static_cast<char>(std::stoi(std::string(player_hash.substr(i, 2)), nullptr, 16));
    return "sha256-" + base64(bytes);
}

// One view as a plot in both themes. `names` begins the names in its files, which must be unique on the page.
class PlayerPlot {
 public:
    PlayerPlot(const Trajectory& trajectory, const ViewDescription& view, std::optional<double> horizon,
               const std::string& names) {
        const std::filesystem::path fonts = assets() / "fonts";
        PublicationStyle style;
        style.columns = 1;
        style.size = {2.0 * plot_size.width, 2.0 * plot_size.height};
        for (const bool is_dark : {false, true}) {
            style.dark = is_dark;
            figure_ = publication(trajectory, {&view, 1}, style, nullptr, horizon);
            figure_.panels[0].title = title_of(view);
            SvgSize size = plot_size;
            size.prefix = names + (is_dark ? "d" : "l");
            const std::string file = svg(figure_, size, fonts, {});
            html_ +=
                fmt::format("<div class=\"{}\">{}</div>", is_dark ? "dark" : "light", file.substr(file.find("<svg")));
        }
        inner_ = plot_areas(figure_, plot_size, fonts).at(0).inner;
    }
    const Panel& panel() const { return figure_.panels[0]; }
    const Rectangle& inner() const { return inner_; }
    const std::string& html() const { return html_; }

 private:
    Figure figure_;
    Rectangle inner_;
    std::string html_;
};

// The list of events. Impacts that change no contact are folded.
class EventList {
 public:
    EventList(const Trajectory& trajectory, const ErrorEstimate& estimate)
        : trajectory_(trajectory), sentences_(trajectory, &estimate) {}

    std::string html() const {
        const auto& events = trajectory_.events;
        constexpr std::size_t most = 400;  // rows
        std::string text = row(trajectory_.run.options.start_time, 0.0, "start", sentences_.state_at_start());
        std::size_t rows = 0;
        for (std::size_t i = 0; i < events.size(); ++rows) {
            if (rows == most) {
                text += more(events.size() - i);
                break;
            }
            std::size_t end = i;
            while (end < events.size() && is_folded(events[end])) ++end;
            text += end > i + 1 ? fold(i, end) : row(i);
            i = std::max(end, i + 1);
        }
        const bool is_whole = trajectory_.outcome.kind == Outcome::Kind::end_time;
        return text + row(trajectory_.end_time, 0.0, is_whole ? "end" : "stop",
                          sentences_.state_at_end() + (is_whole ? "" : ": " + trajectory_.outcome.message));
    }

 private:
    static bool is_folded(const Event& event) { return event.is_impact() && !event.changes_held(); }

    static std::string row(double t, double error, std::string_view name, const std::string& sentence) {
        return fmt::format("<li><button data-t=\"{}\"><time>{} s</time><span><b>{}</b> {}</span></button></li>\n", t,
                           known_digits(t, error, 9), name, html_escaped(sentence));
    }
    std::string row(std::size_t i) const {
        const Event& event = trajectory_.events[i];
        return row(event.t, error_of(i), names_of(event).label, sentences_.of(i));
    }
    std::string fold(std::size_t first, std::size_t end) const {
        constexpr std::size_t most = 200;
        const auto time = [&](std::size_t i) { return known_digits(trajectory_.events[i].t, error_of(i), 6); };
        std::string text = fmt::format("<li><details><summary><time>{} s</time>{} impacts until {} s</summary><ol>\n",
                                       time(first), end - first, time(end - 1));
        for (std::size_t i = first; i < std::min(end, first + most); ++i) text += row(i);
        return text + (end > first + most ? more(end - first - most) : "") + "</ol></details></li>\n";
    }
    static std::string more(std::size_t count) {
        return fmt::format("<li><span>... {} more events: achilles simulate --verbose lists all</span></li>\n", count);
    }
    double error_of(std::size_t i) const {
        return std::max(proved_time(trajectory_.events[i]).value_or(0.0), sentences_.precision().of_event(i));
    }

    const Trajectory& trajectory_;
    EventDescriptions sentences_;
};

// The parts of what `simulate` prints: the title, the result, warnings, and the rest.
struct AnswerParts {
    explicit AnswerParts(const std::string& answer, const std::string& title) {
        const std::size_t end = answer.find("\n\n");
        std::string head = answer.substr(0, end);
        rest = end == std::string::npos ? "" : answer.substr(end + 2);
        if (head.starts_with(title + ": ")) head.erase(0, title.size() + 2);
        for (std::size_t at = 0; at < head.size();) {
            const std::size_t line_end = std::min(head.find('\n', at), head.size());
            std::string line = head.substr(at, line_end - at);
            line.erase(0, std::min(line.find_first_not_of(' '), line.size()));
            (at == 0 ? result : notes.emplace_back()) = line;
            at = line_end + 1;
        }
    }
    std::string result, rest;
    std::vector<std::string> notes;
};

std::string head_of(const std::string& title, const std::string& css) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
        "img-src data:; script-src '{}'\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n<meta name=\"generator\" content=\"Achilles {}\">\n"
        "<title>{}</title>\n<style>\n{}@media screen and (prefers-color-scheme: dark) {{ {}}}\n{}{}</style>\n</head>\n",
        script_hash(), version(), html_escaped(title), css_variables(light_theme()), css_variables(dark_theme()),
        player_css, css);
}

std::string moving_picture(double width, double height, const char* label) {
    return fmt::format("<svg class=\"moving\" viewBox=\"0 0 {:.0f} {:.0f}\"{}></svg>", PlayerDrawings::fineness * width,
                       PlayerDrawings::fineness * height, label);
}

constexpr const char* controls = R"html(<div id="controls" class="card">
<button id="play" type="button" aria-label="Play">&#9654;&#xFE0E;</button>
<input id="slider" type="range" min="0" max="1000000" value="0" aria-label="Time">
<output id="clock"></output>
<select id="speed" aria-label="Seconds of the run per second"></select>
<span id="phase"></span>
</div>
)html";
constexpr const char* help =
    R"html(<p class="keys">Space plays. Left and right arrow: a step. Comma and period: the event before and
after. Home and End: the start and the end. A click on an event goes there.</p>
)html";

}  // namespace

std::string html_escaped(std::string_view text) {
    std::string result;
    for (const char c : printable(text)) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string player_command(const Trajectory& trajectory, const std::string& system,
                           const std::vector<std::string>& views) {
    std::vector<std::string> words{"html", system};
    for (const std::string& view : views) words.insert(words.end(), {"--view", view});
    const Model& model = *trajectory.model;
    const std::vector<std::string> options = run_options(model.description(), model.default_run(), trajectory.run);
    words.insert(words.end(), options.begin(), options.end());
    return shell_line(words);
}

std::string player_page(const Trajectory& trajectory, const ErrorEstimate& estimate,
                        std::span<const ViewDescription> views, const PlayerTexts& texts) {
    const SystemDescription& description = trajectory.model->description();
    PlayerDrawings drawings(trajectory);
    std::vector<ViewDescription> shown(views.begin(), views.end());
    if (!drawings.has_mechanism()) shown.insert(shown.begin(), plane_of(description));
    std::string plots;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const PlayerPlot plot(trajectory, shown[i], horizon_before_end(trajectory, estimate), fmt::format("v{}", i));
        drawings.add_plot(shown[i], plot.panel(), plot.inner());
        plots += fmt::format("<figure class=\"plot card\">{}{}</figure>\n", plot.html(),
                             moving_picture(plot_size.width, plot_size.height, " aria-hidden=\"true\""));
    }
    const PlayerDrawings::Written written = drawings.write();
    const AnswerParts answer(texts.answer, description.title);
    std::string page = head_of(description.title, written.css);
    page +=
        fmt::format("<body>\n<h1>{}</h1>\n<p>{}</p>\n", html_escaped(description.title), html_escaped(answer.result));
    for (const std::string& note : answer.notes) page += "<p class=\"warning\">" + html_escaped(note) + "</p>\n";
    if (drawings.has_mechanism())
        page += "<div id=\"world\" class=\"card\">" +
                moving_picture(drawings.width(), drawings.height(), " role=\"img\" aria-label=\"The mechanism\"") +
                "</div>\n";
    page += controls;
    page += fmt::format(
        "<div class=\"plots\">\n{}</div>\n<h2>Events</h2>\n<div id=\"events\" class=\"card\"><ol>\n{}</ol></div>\n",
        plots, EventList(trajectory, estimate).html());
    page += help;
    page += fmt::format("<details class=\"card\"><summary>Table and accuracy</summary><pre>{}</pre></details>\n",
                        html_escaped(answer.rest));
    page += fmt::format(
        "<footer>Achilles {}. On a picture of {:.0f} pixels, what moves is within about {:.2g} pixels of the run. "
        "Made by: <code>{}</code></footer>\n",
        version(), drawings.width(), written.tolerance, html_escaped(texts.command));
    page +=
        fmt::format("<script type=\"application/json\" id=\"run\">{}</script>\n<script>{}</script>\n</body>\n</html>\n",
                    written.json, player_js);
    return page;
}

}  // namespace achilles
