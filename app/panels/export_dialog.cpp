// Exports and tours: the export dialog, the menu of the tours, and the caption of a tour.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "panels/widgets.hpp"
#include "pictures/export.hpp"
#include "pictures/film.hpp"
#include "pictures/picture_format.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

namespace achilles {

// ---- export dialog: content, size, resulting file; progress of an animation ----

namespace {

using ExportSubject = ExportForm::ExportSubject;

constexpr float names_width = 92.0F;

void row(const char* name) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(name);
    ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + units(names_width));
}

// One of several choices side by side; the selected one is pressed.
bool word(const std::string& name, bool is_down, PanelState& state, const std::string& about = {}) {
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(is_down ? ImGuiCol_ButtonActive : ImGuiCol_FrameBg));
    const bool pressed = ImGui::Button(name.c_str());
    ImGui::PopStyleColor();
    remember(state, "take " + name);
    tooltip(about);
    ImGui::SameLine(0.0F, ImGui::GetStyle().ItemInnerSpacing.x);
    return pressed;
}

// Returns true if another number was typed.
bool number_field(const char* name, double& value, const char* unit, PanelState& state) {
    ImGui::SetNextItemWidth(units(58.0F));
    const bool typed = ImGui::InputDouble((std::string("##") + name).c_str(), &value, 0.0, 0.0, "%.4g");
    remember(state, std::string("take field ") + name);
    ImGui::SameLine(0.0F, units(5.0F));
    ImGui::TextUnformatted(unit);
    ImGui::SameLine(0.0F, units(14.0F));
    return typed;
}

// A second label in a row, aligned between rows.
void column(const char* name) {
    ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + units(names_width + 120.0F));
    ImGui::TextUnformatted(name);
    ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + units(names_width + 206.0F));
}

std::string name_of(const Session& session, int plot) {
    return fmt::format("plot {}: {}", plot, session.plotted().list()[static_cast<std::size_t>(plot - 1)].view.name);
}

bool is_data(const std::string& ending) { return ending == "json" || ending == "csv" || ending == "journal"; }

// Whether the selected content can be written with this extension.
bool fits(const ExportForm& form, const std::string& ending) {
    const std::string name = "a." + ending;
    if (form.what == ExportSubject::film) return is_film(name);
    return !ending_of_picture(name).empty() || (form.what == ExportSubject::plots && form.plot == 0 && is_data(ending));
}

// Replaces the extension of the path if it does not fit the selected content.
void end_in(PanelState& state, const std::string& ending) {
    std::filesystem::path path(state.editor.path);
    const std::string before = ending_of(state.editor.path), name = "a." + before;
    if (is_film(name) || !ending_of_picture(name).empty() || is_data(before)) path.replace_extension();
    use_path(state, path.string() + "." + ending);
    state.export_form.ending = ending;
}

void choose_what(const Session& session, PanelState& state) {
    ExportForm& form = state.export_form;
    const int count = static_cast<int>(session.plotted().list().size());
    form.plot = std::min(form.plot, count);
    row("content");
    ImGui::SetNextItemWidth(-1.0F);
    const std::string now = form.what == ExportSubject::film        ? "a film: the mechanism in motion beside the plots"
                            : form.what == ExportSubject::mechanism ? "the mechanism as it is now"
                            : form.plot > 0                         ? name_of(session, form.plot)
                            : count == 1                            ? "the plot"
                                                                    : "all plots";
    const bool open = ImGui::BeginCombo("##what", fitted(now, remaining().width - units(40.0F)).c_str());
    remember(state, "take what");
    if (!open) return;
    const auto take = [&](const std::string& name, ExportSubject what, int plot) {
        const bool chosen = ImGui::Selectable(name.c_str(), form.what == what && form.plot == plot);
        remember(state, "take " + name);
        if (!chosen) return;
        form.what = what;
        form.plot = plot;
        if (!fits(form, form.ending)) end_in(state, what == ExportSubject::film ? "mp4" : "svg");
    };
    take("all plots", ExportSubject::plots, 0);
    for (int plot = 1; count > 1 && plot <= count; ++plot) take(name_of(session, plot), ExportSubject::plots, plot);
    if (!session.mechanism().is_empty()) take("the mechanism as it is now", ExportSubject::mechanism, 0);
    if (!state.on_page) take("a film: the mechanism in motion beside the plots", ExportSubject::film, 0);
    close_by_escape(state);
    ImGui::EndCombo();
}

void choose_kind(PanelState& state) {
    const std::string& ending = state.export_form.ending;
    row("format");
    if (is_data(ending)) {
        for (const auto& [kind, about] :
             {std::pair{"csv", "a table: one row per instant"}, std::pair{"json", "phases, events and certificates"}})
            if (word(kind, ending == kind, state, about)) end_in(state, kind);
        return ImGui::NewLine();
    }
    if (state.export_form.what == ExportSubject::film) {
        const std::string by = find_program("ffmpeg").empty() ? "ffmpeg is not installed" : "made with ffmpeg";
        for (const char* kind : {"mp4", "gif"})
            if (word(kind, ending == kind, state, by)) end_in(state, kind);
    } else {
        for (const auto& [kind, about] :
             {std::pair{"svg", "lines and text, for papers and for editing"},
              std::pair{"pdf", "lines and text for LaTeX (needs rsvg-convert from librsvg)"},
              std::pair{"png", "pixels"}})
            if ((kind != std::string_view("pdf") || !state.on_page) && word(kind, ending == kind, state, about))
                end_in(state, kind);
    }
    ImGui::SameLine(0.0F, units(14.0F));
    ImGui::Checkbox("dark", &state.export_form.dark);
    remember(state, "take dark");
    tooltip("light on dark, for a screen; paper is white");
}

// Width over height of the selected content.
double chosen_shape(const Session& session, const ExportForm& form) {
    const Plots& plots = session.plotted();
    return form.what == ExportSubject::mechanism ? shape_of(session.limits())
           : form.plot > 0                       ? shape_of(1, 1)
                                                 : shape_of(static_cast<int>(plots.list().size()), plots.columns());
}

void choose_size(const Session& session, PanelState& state) {
    ExportForm& form = state.export_form;
    row("width");
    number_field("width", form.width, "mm", state);
    column("height");
    // The automatic height until the user types one.
    double height =
        form.height == 0.0 ? height_of({form.width, 0.0, 0.0, 0.0}, chosen_shape(session, form)) : form.height;
    if (number_field("height", height, "mm", state)) form.height = height;
    if (word("fits", form.height == 0.0, state, "best height for the plots")) form.height = 0.0;
    ImGui::NewLine();
    row("text");
    number_field("font", form.font, "pt", state);
    if (form.ending == "png") {
        column("resolution");
        number_field("dpi", form.dpi, "dpi", state);
    }
    ImGui::NewLine();
}

void choose_page(const Session& session, PanelState& state) {
    ExportForm& form = state.export_form;
    row("for");
    const auto widths = column_widths();
    const auto chosen =
        std::find_if(widths.begin(), widths.end(), [&](const ColumnWidth& one) { return one.width == form.width; });
    const bool is_other = form.on_paper && chosen == widths.end();
    const std::string pixels = "a screen (1200 \u00d7 800 pixels)";
    const std::string now = !form.on_paper ? pixels : is_other ? "another width" : std::string(chosen->name);
    ImGui::SetNextItemWidth(-1.0F);
    const bool open = ImGui::BeginCombo("##page", now.c_str());
    remember(state, "take page");
    if (open) {
        if (ImGui::Selectable(pixels.c_str(), !form.on_paper)) form.on_paper = false;
        remember(state, "take screen");
        for (const ColumnWidth& one : widths) {
            const std::string name(one.name);
            if (ImGui::Selectable(name.c_str(), form.on_paper && form.width == one.width))
                form.on_paper = true, form.width = one.width, form.height = 0.0, form.font = one.font;
            remember(state, "take " + name);
        }
        if (ImGui::Selectable("another width", is_other)) form.on_paper = true, form.width = 100.0;
        remember(state, "take another width");
        close_by_escape(state);
        ImGui::EndCombo();
    }
    if (form.on_paper) choose_size(session, state);
}

void choose_film(const Session& session, PanelState& state) {
    ExportForm& form = state.export_form;
    row("width");
    for (const int pixels : {640, 1280, 1920, 2560})
        if (word(fmt::format("{}", pixels), form.pixels == pixels, state)) form.pixels = pixels;
    ImGui::TextUnformatted("pixels");
    row("time");
    double speed = form.speed > 0.0 ? form.speed : session.scene().speed();
    const double before = speed;
    number_field("speed", speed, "\u00d7 its speed", state);
    if (speed != before) form.speed = std::max(speed, 0.0);
    number_field("fps", form.fps, "frames per second", state);
    ImGui::NewLine();
}

}  // namespace

void use_path(PanelState& state, const std::string& path) {
    state.editor.path = path;
    state.browser.line = path;
    state.browser.rewrites = true;
}

void show_export_form(const Session& session, PanelState& state) {
    ExportForm& form = state.export_form;
    if (const std::string typed = ending_of(state.editor.path); fits(form, typed)) form.ending = typed;
    if (form.ending == "journal") return;
    if (is_data(form.ending)) return choose_kind(state);
    choose_what(session, state);
    choose_kind(state);
    if (form.what == ExportSubject::film)
        choose_film(session, state);
    else
        choose_page(session, state);
    const ExportNote note = export_note(session, form);
    row("result");
    paragraph(note.text, remaining().width, note.is_wrong ? error_color() : text_color());
    ImGui::Dummy({0.0F, units(4.0F)});
}

std::string export_file(const ExportForm& form, const std::string& path) {
    const std::filesystem::path file(path);
    return file.has_filename() && file.extension().empty() ? path + "." + form.ending : path;
}

command::Export export_command(const ExportForm& form, const std::string& file, bool overwrite) {
    command::Export what{file, overwrite, 0};
    if (form.what == ExportSubject::film) {
        what.fps = form.fps == 30.0 ? 0.0 : form.fps;
        what.speed = form.speed;
        what.pixels = form.pixels == 1280 ? 0 : form.pixels;
        what.dark = form.dark;
        return what;
    }
    if (ending_of_picture(file).empty()) return what;
    what.plot = form.plot;
    what.mechanism = form.what == ExportSubject::mechanism;
    what.dark = form.dark;
    if (!form.on_paper) return what;
    what.width = form.width;
    what.height = form.height;
    what.font = form.font == default_font ? 0.0 : form.font;
    if (ending_of(file) == "png") what.dpi = form.dpi == default_dpi ? 0.0 : form.dpi;
    return what;
}

namespace {

ExportNote note_on_film(const Session& session, const ExportForm& form) {
    if (!(form.fps > 0.0)) return {fmt::format("the frames per second must be above 0, not {:g}", form.fps), true};
    const FilmExtent extent = extent_of(session, export_command(form, "a.mp4", false));
    if (!(extent.frames <= max_film_frames))
        return {fmt::format("more than {:.0f} frames: raise the speed, or use fewer per second", max_film_frames),
                true};
    if (extent.width < 320 || extent.width > 3840)
        return {fmt::format("a film must be 320 to 3840 pixels wide, not {}", extent.width), true};
    if (find_program("ffmpeg").empty()) return {"a film needs ffmpeg, which is not installed", true};
    return {fmt::format("{} \u00d7 {} px, {:.0f} frames, {:.3g} s", extent.width, extent.height, extent.frames,
                        extent.frames / form.fps)};
}

ExportNote note_on_page(const Session& session, const ExportForm& form) {
    const bool has_dots = form.ending == "png";
    const PaperSize page{form.width, form.height, form.font, has_dots ? form.dpi : default_dpi};
    // A page treats 0 as default; in this form only the height does.
    for (const auto& [name, value] :
         {std::pair{"width", page.width}, std::pair{"text", page.font}, std::pair{"resolution", page.dpi}})
        if (!(value > 0.0)) return {fmt::format("{} must be above 0, not {:g}", name, value), true};
    try {
        check(page, "");
        const double shape = chosen_shape(session, form);
        on_page(page, form.ending, 1.0, shape);
        return {fmt::format("{}, text of {:.3g} pt", size_text(page, form.ending, shape), page.font)};
    } catch (const InputError& problem) {
        return {problem.message + (problem.hint.empty() ? "" : ": " + problem.hint), true};
    }
}

}  // namespace

ExportNote export_note(const Session& session, const ExportForm& form) {
    if (form.what == ExportSubject::film) return note_on_film(session, form);
    if (form.on_paper) return note_on_page(session, form);
    return {form.ending == "pdf" ? fmt::format("170 \u00d7 113.3 mm, text of {:.2g} pt", default_font)
                                 : "1200 \u00d7 800 px"};
}

void show_film(PanelState& state) {
    if (!state.film) return;
    const ImVec2 all = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5F * all.x, all.y - units(44.0F)}, ImGuiCond_Always, {0.5F, 1.0F});
    constexpr ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                                       ImGuiWindowFlags_NoNav;
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetColorU32(ImGuiCol_PopupBg));
    ImGui::Begin("film", nullptr, flags);
    const std::string name = std::filesystem::path(state.film->film).filename().string();
    ImGui::TextUnformatted(fitted(name + "   " + state.film->line, units(420.0F)).c_str());
    ImGui::ProgressBar(static_cast<float>(state.film->share), {units(330.0F), ImGui::GetFrameHeight()}, "");
    ImGui::SameLine();
    if (ImGui::Button("Stop", {units(80.0F), 0.0F})) state.film->is_given_up = true;
    remember(state, "film Stop");
    ImGui::End();
    ImGui::PopStyleColor();
}

// ---- menu of the tours; caption of a tour ----

namespace {

constexpr float tour_padding = 12.0F, accent_width = 4.0F, buttons_width = 76.0F, close_width = 26.0F;

// Width of the caption text, which is slightly larger than the interface text.
float text_width(const PanelState& state, float width) {
    return width - 2.0F * units(tour_padding) - units(accent_width) -
           units(state.on_tour ? buttons_width : close_width);
}

// A text button in the corner of the caption.
bool word_button(const char* word, const char* about, PanelState& state, bool enabled = true) {
    const ImVec2 at = ImGui::GetCursorScreenPos(), size = ImGui::CalcTextSize(word);
    const bool pressed = ImGui::InvisibleButton(word, size);
    remember(state, std::string("tour ") + word);
    const bool lit = enabled && ImGui::IsItemHovered();
    ImGui::GetWindowDrawList()->AddText(at, packed(lit ? text_color() : faint_color(), enabled ? 1.0F : 0.4F), word);
    tooltip(about);
    return pressed && enabled;
}

}  // namespace

void show_tour_items(const Session& session, PanelState& state, Commands& commands) {
    if (state.tours.empty()) ImGui::TextDisabled("no tours are installed");
    for (const SystemEntry& tour : state.tours) {
        if (ImGui::MenuItem((tour.title + "##" + tour.name).c_str()))
            request(session, state, command::Replay{tour.name}, commands);
        remember(state, "tour " + tour.name);
    }
}

float caption_height(const Session& session, const PanelState& state, float width) {
    const std::string& caption = session.scene().caption();
    if (caption.empty()) return 0.0F;
    const float room = text_width(state, width);
    const float text = ImGui::CalcTextSize(caption.c_str(), nullptr, false, room).y;
    // At least four lines high, so that the layout does not jump between captions.
    return std::max(text, 4.0F * ImGui::GetTextLineHeight()) + 2.0F * units(tour_padding) - units(4.0F);
}

void show_caption(const Session& session, PanelState& state, Commands& commands) {
    const Rectangle area = remaining();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 low{area.x, area.y}, high{area.x + area.width, area.y + area.height};
    list->AddRectFilled(low, high, packed(session.theme().background), units(4.0F));
    list->AddRectFilled(low, {low.x + units(accent_width), high.y}, ImGui::GetColorU32(ImGuiCol_SliderGrab),
                        units(2.0F));
    const float left = area.x + units(accent_width + tour_padding), top = area.y + units(tour_padding - 2.0F);
    ImGui::SetCursorScreenPos({left, top});
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + text_width(state, area.width));
    ImGui::TextUnformatted(session.scene().caption().c_str());
    ImGui::PopTextWrapPos();
    if (!state.on_tour) {
        ImGui::SetCursorScreenPos({high.x - units(close_width), top});
        if (word_button("\u00d7", "close", state)) commands.emplace_back(command::Say{""});
        return;
    }
    ImGui::SetCursorScreenPos({high.x - units(buttons_width), top});
    const bool keys = !ImGui::GetIO().WantTextInput, has_before = state.tour_captions_shown > 1;
    if (word_button("next", "go on now (Enter)", state) ||
        (keys && !has_keys(state) && takes_key(state, key::enter, false)))
        state.tour_action = PanelState::TourAction::next;
    ImGui::SameLine(0.0F, units(10.0F));
    if (word_button("stop", "end the tour here (Escape); any other action also ends it", state) || take_escape(state))
        state.tour_action = PanelState::TourAction::stop;
    // Below the other buttons, to leave the text more width.
    ImGui::SetCursorScreenPos({high.x - units(buttons_width), top + ImGui::GetTextLineHeight()});
    if (word_button("back", "previous step (Backspace)", state, has_before) ||
        (keys && has_before && !has_keys(state) && takes_key(state, key::backspace, false)))
        state.tour_action = PanelState::TourAction::back;
    if (state.tour_captions_shown == 0) return;
    const std::string how_far = fmt::format("{}/{}", state.tour_captions_shown, state.tour_captions);
    list->AddText({std::floor(high.x - units(tour_padding) - ImGui::CalcTextSize(how_far.c_str()).x),
                   std::floor(high.y - units(tour_padding - 2.0F) - ImGui::GetTextLineHeight())},
                  packed(faint_color()), how_far.c_str());
}

}  // namespace achilles
