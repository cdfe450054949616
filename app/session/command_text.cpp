// Commands as lines of a journal.
#include <fmt/format.h>

#include "journal/words.hpp"
#include "session/command.hpp"

namespace achilles {

namespace {

const char* on_off(bool on) { return on ? "on" : "off"; }

struct Print {
    std::string operator()(const command::Open& c) const { return "open " + quoted_where_needed(c.system); }
    std::string operator()(const command::Set& c) const {
        return fmt::format("set {} {}", quoted_where_needed(c.name), c.value);
    }
    std::string operator()(const command::UseOption& c) const {
        std::string text = c.name;
        for (std::size_t i = 0; i < (c.is_of_one_value() ? 1 : c.values.size()); ++i)
            text += " " + to_text(c.values[i]);
        return text;
    }
    std::string operator()(const command::Seek& c) const { return fmt::format("seek {}", c.time); }
    std::string operator()(const command::Play&) const { return "play"; }
    std::string operator()(const command::Pause&) const { return "pause"; }
    std::string operator()(const command::Select& c) const { return fmt::format("select {}", c.event); }
    std::string operator()(const command::New&) const { return "new"; }
    std::string operator()(const command::Text& c) const { return "text " + quoted(c.text); }
    std::string operator()(const command::Save& c) const {
        return fmt::format("save {}{}", quoted_where_needed(c.file), c.overwrite ? " overwrite" : "");
    }
    std::string operator()(const command::Show& c) const {
        return fmt::format("{} {}", c.on ? "show" : "hide", quoted_where_needed(c.what));
    }
    std::string operator()(const command::Start& c) const {
        std::string text = "start";
        for (const auto& [name, value] : c.values) text += fmt::format(" {} {}", quoted_where_needed(name), value);
        return text;
    }
    std::string operator()(const command::Look& c) const { return fmt::format("look {} {} {}", c.x, c.y, c.width); }
    std::string operator()(const command::LookAll&) const { return "look all"; }
    std::string operator()(const command::Speed& c) const { return fmt::format("speed {}", c.value); }
    std::string operator()(const command::Loop& c) const { return fmt::format("loop {}", on_off(c.on)); }
    std::string operator()(const command::Step& c) const { return fmt::format("step {}", c.events); }
    std::string operator()(const command::Undo&) const { return "undo"; }
    std::string operator()(const command::Redo&) const { return "redo"; }
    std::string operator()(const command::Pin& c) const { return c.on ? "pin" : "unpin"; }
    std::string operator()(const command::Lens& c) const { return fmt::format("lens {}", c.from); }
    std::string operator()(const command::Grid& c) const { return fmt::format("grid {} {}", c.columns, c.rows); }
    std::string operator()(const command::PlotView& c) const {
        std::string text = fmt::format("plot {} {}", c.plot, quoted_where_needed(c.x));
        for (const std::string& y : c.y) text += " " + quoted_where_needed(y);
        return text;
    }
    std::string operator()(const command::Zoom& c) const {
        return fmt::format("zoom {} {} {} {} {}", c.plot, c.x_low, c.x_high, c.y_low, c.y_high);
    }
    std::string operator()(const command::Range& c) const {
        return fmt::format("range {} {} {} {}", c.plot, c.is_x ? "x" : "y", c.low, c.high);
    }
    std::string operator()(const command::Fit& c) const { return fmt::format("fit {}", c.plot); }
    std::string operator()(const command::AxisScale& c) const {
        return fmt::format("log {} {} {}", c.plot, c.is_x ? "x" : "y", on_off(c.logarithmic));
    }
    std::string operator()(const command::ShowCurve& c) const {
        return fmt::format("curve {} {} {}", c.plot, c.curve, on_off(c.shown));
    }
    std::string operator()(const command::Export& c) const {
        return fmt::format("export {}{}", quoted_where_needed(c.file), c.overwrite ? " overwrite" : "");
    }
    std::string operator()(const command::Copy& c) const { return "copy " + quoted_where_needed(c.what); }
    std::string operator()(const command::Wait& c) const { return fmt::format("wait {}", c.seconds); }
    std::string operator()(const command::Say& c) const { return "say " + quoted(c.text); }
    std::string operator()(const command::Replay& c) const { return "replay " + quoted_where_needed(c.journal); }
    std::string operator()(const command::UseTheme& c) const { return c.dark ? "theme dark" : "theme light"; }
    std::string operator()(const command::Size& c) const {
        return c.share > 0.0 ? fmt::format("size {} {}", c.panel, c.share) : fmt::format("size {} auto", c.panel);
    }
    std::string operator()(const command::Reset&) const { return "reset"; }
    std::string operator()(const command::Done&) const { return "done"; }
    std::string operator()(const command::Link& c) const { return fmt::format("link {}", on_off(c.on)); }
};

}  // namespace

std::string to_text(const Command& command) { return std::visit(Print{}, command); }

}  // namespace achilles
