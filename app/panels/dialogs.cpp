// The dialogs: open a file, save, unsaved changes, file access, recovery.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "journal/link.hpp"
#include "panels/widgets.hpp"
#include "pictures/film.hpp"
#include "pictures/picture_format.hpp"
#include "surface/imgui_version.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

constexpr float dialog_width = 560.0F;

// Adds the extension of a system file: "mine" becomes mine.toml.
std::string as_system(const std::string& path) {
    const fs::path file(path);
    return file.has_filename() && file.extension().empty() ? path + ".toml" : path;
}

// Result of checking a path: a note, whether it can be used, and whether to ask first.
struct PathCheck {
    std::string note;
    bool is_good = false, asks = false;
};

PathCheck to_open(const std::string& path) {
    std::error_code problem;
    const fs::file_status status = fs::status(path, problem);
    if (path.empty()) return {"enter the path of a system file", false, false};
    if (!fs::exists(status)) return {"there is no such file", false, false};
    if (fs::is_directory(status)) return {"this is a folder", false, false};
    return {"", true, false};
}

PathCheck to_save(const Document& document, const std::string& path) {
    std::error_code problem;
    const fs::path target(path);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    if (path.empty() || !target.has_filename()) return {"enter the path of the file to write", false, false};
    if (!fs::is_directory(folder, problem)) return {"there is no such folder", false, false};
    if (fs::is_directory(target, problem)) return {"this is a folder", false, false};
    if (!fs::exists(target, problem))
        return {"writes to " + fs::absolute(target, problem).lexically_normal().string(), true, false};
    if (!document.file.empty() && fs::equivalent(target, document.file, problem)) return {"", true, false};
    return {"A file of this name exists. Overwrite it?", true, true};
}

PathCheck check_export_path(const Session& session, const PanelState& state, const std::string& typed) {
    const ExportForm& form = state.export_form;
    const std::string path = export_file(form, typed), ending = ending_of(path);
    const bool is_picture = !ending_of_picture(path).empty(),
               is_data = ending == "json" || ending == "csv" || ending == "journal";
    const auto refuse = [](const std::string& why) { return PathCheck{why, false, false}; };
    if (!path.empty() && form.what == ExportForm::ExportSubject::film && !is_film(path))
        return refuse("end the name in .mp4 or .gif");
    if (!path.empty() && form.what != ExportForm::ExportSubject::film && is_film(path))
        return refuse("this name is for a film: choose the film above");
    if (!path.empty() && (form.plot > 0 || form.what == ExportForm::ExportSubject::mechanism) && !is_picture)
        return refuse("end the name in .svg, .png or .pdf");
    if (!path.empty() && !is_picture && !is_film(path) && !is_data)
        return refuse("end the name in .svg, .png, .pdf, .json, .csv or .journal");
    if (ending == "pdf" && state.on_page) return refuse("a page makes no PDF: choose .svg, or use achilles figure");
    if (ending == "pdf" && find_program("rsvg-convert").empty())
        return refuse("a PDF needs rsvg-convert (librsvg2-bin), which is not installed");
    const ExportNote note = is_data ? ExportNote() : export_note(session, form);
    if (note.is_wrong) return refuse(note.text);
    // A picture of the dialog must not depend on existing files.
    return state.reads_folders ? to_save(Document(), path) : PathCheck{"writes to " + path, true, false};
}

// "contact force" as part of a file name.
std::string as_name(const std::string& title) {
    std::string name;
    for (const char c : title) {
        const bool stays = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (stays || (!name.empty() && name.back() != '_')) name += stays ? c : '_';
    }
    while (!name.empty() && name.back() == '_') name.pop_back();
    return name;
}

// An unused file name, numbered if necessary, so that Enter alone does not overwrite a file.
std::string free_name(const std::string& stem, const std::string& ending) {
    std::error_code problem;
    std::string name = stem + ending;
    for (int i = 2; fs::exists(name, problem) && i < 1000; ++i) name = fmt::format("{}-{}{}", stem, i, ending);
    return name;
}

// A modal window. Its upper edge stays where it is when notes and fields make it higher.
template <class Content>
void dialog(const char* title, Content content) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(
        {std::floor(0.5F * (size.x - std::min(units(dialog_width), size.x))), std::floor(0.12F * size.y)});
    ImGui::SetNextWindowSize({std::min(units(dialog_width), size.x), 0.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {units(16.0F), units(14.0F)});
    if (ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) {
        content();
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar();
}

bool button(const char* name, PanelState& state, bool enabled = true) {
    ImGui::BeginDisabled(!enabled);
    const bool pressed = ImGui::Button(name, {units(96.0F), 0.0F});
    remember(state, std::string("dialog ") + name);
    ImGui::EndDisabled();
    return pressed;
}

void close(EditorState& editor) {
    editor.asking = EditorState::OpenDialog::nothing;
    ImGui::CloseCurrentPopup();
}

// Cancels the pending action.
void give_up(EditorState& editor) {
    editor.waiting.reset();
    editor.is_closing = false;
    close(editor);
}

bool is_escape(const PanelState& state) { return takes_key(state, key::escape, false); }

const std::vector<std::string> systems_and_sessions{".toml", ".journal", ".svg", ".png", ".pdf"};
const std::vector<std::string> taken_away{".svg", ".png", ".pdf", ".mp4", ".gif", ".json", ".csv", ".journal"};

// The path field, the folder, a note and two buttons. Returns true if a path was chosen.
template <class Judge>
bool path_chosen(const char* action, const std::vector<std::string>& endings, PanelState& state, const Judge& judge) {
    EditorState& editor = state.editor;
    const bool entered = path_line(state, ImGui::IsWindowAppearing() || editor.keeps_path);
    const bool can_choose = std::string_view(action) == "Open";
    const BrowseResult browsed = state.on_page ? BrowseResult() : browse(state, endings, entered);
    PathCheck verdict = judge(expanded(editor.path));
    if (state.on_page && verdict.is_good && !verdict.asks)
        verdict.note = "downloads " + fs::path(editor.path).filename().string();
    ImGui::PushStyleColor(ImGuiCol_Text, packed(verdict.asks ? error_color() : faint_color()));
    ImGui::TextUnformatted(verdict.note.empty() ? " " : fitted(verdict.note, remaining().width).c_str());
    ImGui::PopStyleColor();
    const bool pressed = button(verdict.asks ? "Overwrite" : action, state, verdict.is_good);
    ImGui::SameLine();
    if (button("Cancel", state) || is_escape(state)) give_up(editor);
    // Enter alone does not overwrite a file, and Enter on a folder or row only opens it.
    const bool goes = entered && !verdict.asks && !browsed.has_taken;
    const bool chosen = verdict.is_good && (pressed || goes || (can_choose && browsed.is_chosen));
    editor.keeps_path = entered && !chosen;  // Enter releases the field: keep it while the path is wrong
    return chosen;
}

void open_dialog(PanelState& state, const Session& session, Commands& commands) {
    if (!path_chosen("Open", systems_and_sessions, state, to_open)) return;
    close(state.editor);
    const std::string path = expanded(state.editor.path);
    // Journals and pictures are replayed, as when they are dropped on the window.
    const bool replays = ending_of(path) == "journal" || !ending_of_picture(path).empty();
    request(session, state, replays ? Command(command::Replay{path}) : Command(command::Open{path}), commands);
}

void save_dialog(PanelState& state, const Session& session, Commands& commands) {
    EditorState& editor = state.editor;
    const auto judge = [&](const std::string& path) { return to_save(session.document(), as_system(path)); };
    if (!path_chosen("Save", {".toml"}, state, judge)) return;
    const std::string file = as_system(expanded(editor.path));
    close(editor);
    hand_over_text(editor, commands);
    commands.emplace_back(command::Save{file, judge(file).asks});
    editor.has_saved = editor.waiting.has_value() || editor.is_closing;
}

void export_dialog(PanelState& state, const Session& session, Commands& commands) {
    if (session.under_way() != nullptr) {
        ImGui::TextDisabled("the run is still under way");
        if (button("Cancel", state) || is_escape(state)) give_up(state.editor);
        return;
    }
    show_export_form(session, state);
    const auto judge = [&](const std::string& path) { return check_export_path(session, state, path); };
    if (!path_chosen("Export", taken_away, state, judge)) return;
    const std::string file = export_file(state.export_form, expanded(state.editor.path));
    close(state.editor);
    commands.emplace_back(export_command(state.export_form, file, judge(file).asks));
}

// Performs the pending action.
void go_on(EditorState& editor, Commands& commands) {
    editor.may_close = std::exchange(editor.is_closing, false);
    if (editor.waiting) commands.push_back(*std::exchange(editor.waiting, std::nullopt));
}

void unsaved_dialog(PanelState& state, const Session& session, Commands& commands) {
    EditorState& editor = state.editor;
    const std::string name = session.document().name;
    ImGui::PushTextWrapPos(0.0F);
    const char* before = editor.is_closing ? "closing the window" : "replacing it";
    ImGui::TextUnformatted(fmt::format("Save the text of {} before {}?", name, before).c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (button("Save", state)) {
        close(editor);
        save_or_ask(session, state, commands);
        editor.has_saved = editor.asking == EditorState::OpenDialog::nothing;
    }
    ImGui::SameLine();
    if (button("Discard", state)) {
        close(editor);
        go_on(editor, commands);
        editor.known = editor.text;  // discard also what was typed last
    }
    ImGui::SameLine();
    if (button("Cancel", state) || is_escape(state)) give_up(editor);
}

// Asks for file access by a journal or a picture, which may be untrusted: Enter does not grant it.
void file_dialog(PanelState& state) {
    FileQuestion& question = *state.file_question;
    const std::string more = question.more == 0   ? ""
                             : question.more == 1 ? ", and one more file"
                                                  : fmt::format(", and {} more files", question.more);
    const std::string asker = is_link(question.asker) ? "This link" : question.asker;
    ImGui::PushTextWrapPos(0.0F);
    for (const std::string& line : {asker + " wants to", "    " + question.request + more + ".",
                                    std::string("Allow it only if you trust its source. It never overwrites files.")})
        ImGui::TextUnformatted(line.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (button("Allow", state)) question.answer = true;
    ImGui::SameLine();
    if (button("Refuse", state) || is_escape(state)) question.answer = false;
    if (question.answer) ImGui::CloseCurrentPopup();
}

void recovery_dialog(PanelState& state) {
    using RecoveryChoice = RecoveryQuestion::RecoveryChoice;
    RecoveryQuestion& question = *state.recovery_question;
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(
        fmt::format("The text of {} was not saved when its window closed ({}).", question.name, question.when).c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    const bool entered = takes_key(state, key::enter, false);
    if (button("Recover", state) || entered) question.answer = RecoveryChoice::recover;
    ImGui::SameLine();
    if (button("Discard", state)) question.answer = RecoveryChoice::discard;
    ImGui::SameLine();
    if (button("Later", state) || is_escape(state)) question.answer = RecoveryChoice::later;
    if (question.answer != RecoveryChoice::none) ImGui::CloseCurrentPopup();
}

// A question that does not concern the edited text; shown only if no other dialog is open.
template <class Question, class Content>
void question_dialog(const char* title, const std::optional<Question>& question, bool is_free, const Content& content) {
    if (question && is_free && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    dialog(title, [&] {
        if (question)
            content();
        else
            ImGui::CloseCurrentPopup();
    });
}

// After saving: performs the pending action if the save succeeded.
void go_on_if_saved(const Session& session, EditorState& editor, Commands& commands) {
    if (!std::exchange(editor.has_saved, false)) return;
    if (!session.document().is_changed()) go_on(editor, commands);
    editor.waiting.reset();
    editor.is_closing = false;
}

}  // namespace

void ask_to_open(PanelState& state) {
    if (state.choose_file) return state.choose_file();
    state.editor.path.clear();
    state.editor.asking = EditorState::OpenDialog::open;
}

void ask_to_save(const Session& session, PanelState& state) {
    const Document& document = session.document();
    // Propose a copy in the working directory for an asset, which must not be overwritten.
    state.editor.path = document.file.empty() ? fs::path(document.name).stem().string() + ".toml" : document.file;
    state.editor.asking = EditorState::OpenDialog::save;
}

void ask_to_export(const Session& session, PanelState& state, const std::string& ending, int plot) {
    std::string stem = fs::path(session.system()).stem().string();
    if (plot > 0) {
        const std::string title = as_name(session.plotted().list()[static_cast<std::size_t>(plot - 1)].view.name);
        stem += "-" + (title.empty() ? fmt::format("plot_{}", plot) : title);
    }
    const std::string dotted = "." + ending, name = stem + dotted;
    state.export_form.plot = plot;
    state.export_form.what = is_film(name) ? ExportForm::ExportSubject::film : ExportForm::ExportSubject::plots;
    state.export_form.ending = ending;
    state.editor.path = state.reads_folders ? free_name(stem, dotted) : name;
    state.editor.asking = EditorState::OpenDialog::export_run;
}

void save_or_ask(const Session& session, PanelState& state, Commands& commands) {
    if (session.document().file.empty()) return ask_to_save(session, state);
    hand_over_text(state.editor, commands);
    commands.emplace_back(command::Save{session.document().file, false});
}

void request(const Session& session, PanelState& state, const Command& command, Commands& commands) {
    if (!session.document().is_changed() && !is_typing(state)) return commands.push_back(command);
    state.editor.waiting = command;
    state.editor.is_closing = false;
    state.editor.asking = EditorState::OpenDialog::unsaved;
}

bool request_close(const Session& session, PanelState& state) {
    if (state.editor.may_close || (!session.document().is_changed() && !is_typing(state))) return true;
    state.editor.waiting.reset();
    state.editor.is_closing = true;
    state.editor.asking = EditorState::OpenDialog::unsaved;
    return false;
}

void show_dialogs(const Session& session, PanelState& state, Commands& commands) {
    EditorState& editor = state.editor;
    go_on_if_saved(session, editor, commands);
    using OpenDialog = EditorState::OpenDialog;
    const bool wants_export = session.scene().shows("export");
    if (wants_export && editor.asking == OpenDialog::nothing) ask_to_export(session, state, "svg");
    const bool was_open = editor.asking == OpenDialog::export_run;
    constexpr std::pair<OpenDialog, const char*> titles[] = {{OpenDialog::open, "Open a system"},
                                                             {OpenDialog::save, "Save the system"},
                                                             {OpenDialog::unsaved, "Unsaved changes"},
                                                             {OpenDialog::export_run, "Export"}};
    for (const auto& [asking, title] : titles)
        if (editor.asking == asking && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
    const bool is_free = editor.asking == OpenDialog::nothing;
    question_dialog("File access", state.file_question, is_free, [&] { file_dialog(state); });
    question_dialog("Recover unsaved text", state.recovery_question, is_free && !state.file_question,
                    [&] { recovery_dialog(state); });
    dialog(titles[0].second, [&] { open_dialog(state, session, commands); });
    dialog(titles[1].second, [&] { save_dialog(state, session, commands); });
    dialog(titles[3].second, [&] { export_dialog(state, session, commands); });
    dialog(titles[2].second, [&] { unsaved_dialog(state, session, commands); });
    if (wants_export && was_open && editor.asking != OpenDialog::export_run)
        commands.emplace_back(command::Show{"export", false});
}

}  // namespace achilles
