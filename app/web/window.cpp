// The window of a page: a canvas with WebGL 2, and the input of the browser.
#include "surface/window.hpp"

#include <emscripten.h>
#include <emscripten/html5.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "surface/draw_data.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"

// clang-format off
EM_JS(void, show_cursor_named, (const char* name), { Module.canvas.style.cursor = UTF8ToString(name); })
EM_JS(void, write_clipboard, (const char* text), {
    const words = UTF8ToString(text);
    const ask = () => window.prompt('Copy this text:', words);
    if (navigator.clipboard) navigator.clipboard.writeText(words).catch(ask); else ask();
})
// Text that the browser pastes goes to achilles_paste() below.
EM_JS(void, listen_to_paste, (), {
    window.addEventListener('paste', (event) => {
        ccall('achilles_paste', null, ['string'], [event.clipboardData.getData('text')]);
        event.preventDefault();
    });
})
// Files that are dropped on the page are copied to its files, which are in memory; see achilles_drop() below.
EM_JS(void, listen_to_drops, (), {
    globalThis.takeFiles = async (files) => {
        for (const file of files) {
            FS.writeFile(file.name, new Uint8Array(await file.arrayBuffer()));
            ccall('achilles_drop', null, ['string'], [file.name]);
        }
    };
    window.addEventListener('dragover', (event) => event.preventDefault());
    window.addEventListener('drop', (event) => {
        event.preventDefault();
        takeFiles(event.dataTransfer.files);
    });
})
EM_JS(void, show_failure, (const char* text), { showFailure(UTF8ToString(text)); })
// clang-format on

namespace achilles {

namespace {

constexpr const char* canvas_name = "#canvas";
// ImGui needs a few frames after an event to settle.
constexpr int settling_frames = 4;
// A turn of the wheel by one click, in the units of the browser.
constexpr double click_pixels = 100.0, click_lines = 3.0;

constexpr std::pair<std::string_view, int> named_keys[] = {{"Escape", key::escape},
                                                           {"Enter", key::enter},
                                                           {"Tab", key::tab},
                                                           {"Backspace", key::backspace},
                                                           {"Insert", key::insert},
                                                           {"Delete", key::remove},
                                                           {"ArrowRight", key::right},
                                                           {"ArrowLeft", key::left},
                                                           {"ArrowDown", key::down},
                                                           {"ArrowUp", key::up},
                                                           {"PageUp", key::page_up},
                                                           {"PageDown", key::page_down},
                                                           {"Home", key::home},
                                                           {"End", key::end},
                                                           {"F1", key::f1},
                                                           {"F11", key::f11},
                                                           {"Shift", key::left_shift},
                                                           {"Control", key::left_control},
                                                           {"Alt", key::left_alt},
                                                           {"Meta", key::left_super}};

// Code of a key; 0 for one that the explorer does not know. Letters, plus and minus are known by what
// the keyboard layout prints, as in a desktop window; digits by the place of their key, since Shift changes what it
// prints.
int code_of(const EmscriptenKeyboardEvent& event) {
    const std::string_view name = event.key, place = event.code;
    if (place == "NumpadEnter") return key::keypad_enter;
    for (const auto& [known, code] : named_keys)
        if (known == name) return code;
    if (name == "+" || name == "=") return '=';
    if (name == "-") return '-';
    if (name.size() == 1 && std::isalpha(static_cast<unsigned char>(name[0])) != 0)
        return std::toupper(static_cast<unsigned char>(name[0]));
    if (place.size() == 6 && place.starts_with("Digit")) return place[5];
    if (place.size() == 4 && place.starts_with("Key")) return place[3];  // a letter of another alphabet
    return name == " " ? ' ' : 0;
}

// The character that a key types; 0 for other keys, whose names are words.
unsigned character_of(std::string_view name) {
    const auto first = static_cast<unsigned char>(name.empty() ? 0 : name[0]);
    const std::size_t bytes = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (first == 0 || name.size() != bytes) return 0;
    unsigned code = bytes == 1 ? first : first & (0x7FU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) code = code << 6 | (static_cast<unsigned char>(name[i]) & 0x3FU);
    return code;
}

// Receives what the browser pastes.
std::function<void(const char*)> paste;
// Dropped files that the explorer has not taken yet.
std::vector<std::string> drops;
// Set by a finished job, on its thread: the next frames must show its result.
std::atomic<bool> was_woken = false;

}  // namespace

struct Window::Implementation {
    explicit Implementation(const SurfaceOptions& surface) : interface(with_scale(surface)) {
        scale = surface.scale;
        const Interface::Active active(interface);
        EmscriptenWebGLContextAttributes wanted;
        emscripten_webgl_init_context_attributes(&wanted);
        wanted.alpha = wanted.depth = wanted.antialias = EM_FALSE;  // frames are copied to the canvas as they are
        wanted.preserveDrawingBuffer = EM_TRUE;                     // between frames nothing is drawn
        wanted.majorVersion = 2;
        context = emscripten_webgl_create_context(canvas_name, &wanted);
        if (context <= 0) throw std::runtime_error("this browser has no WebGL 2");
        emscripten_webgl_make_context_current(context);
        canvas.emplace([](const char* name) { return emscripten_webgl_get_proc_address(name); },
                       surface.curve_fineness);
        canvas->load_fonts();
        clipboard = {this, [](void* self) { return static_cast<Implementation*>(self)->pasted.c_str(); },
                     [](void*, const char* text) { write_clipboard(text); }};
        use_clipboard(clipboard);
        ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_HasMouseCursors;
        listen();
    }

    static Implementation& of(void* self) { return *static_cast<Implementation*>(self); }
    static SurfaceOptions with_scale(SurfaceOptions surface) {
        surface.scale *= emscripten_get_device_pixel_ratio();
        return surface;
    }
    void listen();
    void listen_to_keyboard();
    bool press(const EmscriptenKeyboardEvent& event);
    void release(const EmscriptenKeyboardEvent& event);
    void fit_to_page();
    void restyle();
    void frame();
    void show_cursor();

    Interface interface;
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context = 0;
    Clipboard clipboard{};
    std::string pasted;
    std::optional<Canvas> canvas;
    Events events;
    std::map<std::string, int> pressed;  // codes of the keys that are down, by their place
    FrameFunction draw;
    double scale = 1.0, pixel_ratio = 1.0;
    int width = 0, height = 0;  // pixels
    bool dark = false, stale = false, moving = true;
    int unsettled = settling_frames;
    double last_frame = -1.0;
};

extern "C" EMSCRIPTEN_KEEPALIVE void achilles_paste(const char* text) { paste(text); }
extern "C" EMSCRIPTEN_KEEPALIVE void achilles_drop(const char* file) {
    drops.emplace_back(file);
    Window::wake();
}

void Window::Implementation::listen() {
    paste = [this](const char* text) {
        pasted = text;
        events.key('V', true);
        events.key('V', false);
    };
    const auto move = [](int, const EmscriptenMouseEvent* event, void* self) -> EM_BOOL {
        of(self).events.mouse_at(event->clientX * of(self).pixel_ratio, event->clientY * of(self).pixel_ratio);
        return EM_TRUE;
    };
    const auto press = [](int type, const EmscriptenMouseEvent* event, void* self) -> EM_BOOL {
        constexpr std::array numbers{0, 2, 1};  // the browser's second button is the middle one
        if (event->button < 3) of(self).events.button(numbers[event->button], type == EMSCRIPTEN_EVENT_MOUSEDOWN);
        return EM_FALSE;
    };
    emscripten_set_mousemove_callback(EMSCRIPTEN_EVENT_TARGET_WINDOW, this, EM_TRUE, move);
    emscripten_set_mousedown_callback(canvas_name, this, EM_TRUE, press);
    emscripten_set_mouseup_callback(EMSCRIPTEN_EVENT_TARGET_WINDOW, this, EM_TRUE, press);
    emscripten_set_mouseleave_callback(canvas_name, this, EM_TRUE,
                                       [](int, const EmscriptenMouseEvent*, void* self) -> EM_BOOL {
                                           of(self).events.mouse_left();
                                           return EM_TRUE;
                                       });
    emscripten_set_wheel_callback(
        canvas_name, this, EM_TRUE, [](int, const EmscriptenWheelEvent* event, void* self) -> EM_BOOL {
            const double click = event->deltaMode == DOM_DELTA_PIXEL ? click_pixels : click_lines;
            of(self).events.wheel(-event->deltaX / click, -event->deltaY / click);
            return EM_TRUE;
        });
    emscripten_set_blur_callback(EMSCRIPTEN_EVENT_TARGET_WINDOW, this, EM_TRUE,
                                 [](int, const EmscriptenFocusEvent*, void* self) -> EM_BOOL {
                                     of(self).events.release_all();
                                     of(self).pressed.clear();
                                     return EM_FALSE;
                                 });
    listen_to_keyboard();
    listen_to_paste();
    listen_to_drops();
}

void Window::Implementation::listen_to_keyboard() {
    emscripten_set_keydown_callback(EMSCRIPTEN_EVENT_TARGET_WINDOW, this, EM_TRUE,
                                    [](int, const EmscriptenKeyboardEvent* event, void* self) -> EM_BOOL {
                                        return of(self).press(*event) ? EM_TRUE : EM_FALSE;
                                    });
    emscripten_set_keyup_callback(EMSCRIPTEN_EVENT_TARGET_WINDOW, this, EM_TRUE,
                                  [](int, const EmscriptenKeyboardEvent* event, void* self) -> EM_BOOL {
                                      of(self).release(*event);
                                      return EM_FALSE;
                                  });
}

// Returns false for keys that the browser needs: pasting, reloading, its tabs and its tools.
bool Window::Implementation::press(const EmscriptenKeyboardEvent& event) {
    const int code = code_of(event);
    const bool is_command = event.ctrlKey != 0 || event.metaKey != 0;
    if (is_command && code == 'V') return false;
    if (is_command && (code == 'R' || code == 'T' || code == 'W' || code == 'L' || code == 'I' || code == 'J'))
        return false;
    if (code != 0 && event.repeat == 0) {  // ImGui repeats keys itself
        events.key(code, true);
        pressed[event.code] = code;
    }
    const unsigned letter = is_command ? 0 : character_of(event.key);
    if (letter != 0) events.character(letter);
    return code != 0 || letter != 0;
}

// The code at the press, since Shift may have changed meanwhile.
void Window::Implementation::release(const EmscriptenKeyboardEvent& event) {
    const auto held = pressed.find(event.code);
    if (held == pressed.end()) return;
    events.key(held->second, false);
    pressed.erase(held);
}

// The canvas has the pixels of the screen, also after a change of the page or of its zoom.
void Window::Implementation::fit_to_page() {
    double across = 0.0, down = 0.0;
    emscripten_get_element_css_size(canvas_name, &across, &down);
    const double ratio = emscripten_get_device_pixel_ratio();
    const int wide = std::max(static_cast<int>(across * ratio), 1), high = std::max(static_cast<int>(down * ratio), 1);
    if (ratio != pixel_ratio) stale = true;
    if (wide == width && high == height && ratio == pixel_ratio) return;
    width = wide, height = high, pixel_ratio = ratio;
    emscripten_set_canvas_element_size(canvas_name, width, height);
    unsettled = settling_frames;
}

void Window::Implementation::restyle() {
    interface.restyle(scale * pixel_ratio, dark);
    canvas->load_fonts();
    stale = false;
}

void Window::Implementation::show_cursor() {
    const ImGuiMouseCursor wanted = ImGui::GetMouseCursor();
    show_cursor_named(wanted == ImGuiMouseCursor_TextInput  ? "text"
                      : wanted == ImGuiMouseCursor_ResizeNS ? "ns-resize"
                      : wanted == ImGuiMouseCursor_ResizeEW ? "ew-resize"
                      : wanted == ImGuiMouseCursor_Hand     ? "pointer"
                                                            : "default");
}

void Window::Implementation::frame() {
    fit_to_page();
    if (was_woken.exchange(false) || !events.empty()) unsettled = settling_frames;
    if (!moving && unsettled == 0) return;
    const double now = emscripten_get_now() / 1e3;
    // ImGui rejects a time step of zero. After a sleep nothing must jump.
    const double step = last_frame < 0.0 ? 1.0 / 60.0 : std::clamp(now - last_frame, 1e-4, 0.1);
    last_frame = now;
    unsettled = std::max(unsettled - 1, 0);
    const Interface::Active active(interface);
    if (stale) restyle();
    apply(events.next(ImGui::GetIO().WantTextInput));
    const ImDrawData& data = interface.frame(draw, width, height, step);
    show_cursor();
    canvas->draw(data, interface.background());
    canvas->show();
}

Window::Window(const SurfaceOptions& options, const std::string&)
    : implementation_(std::make_unique<Implementation>(options)) {}
Window::~Window() = default;

// Returns at once. The browser then calls for frames until the page is closed.
void Window::run(const FrameFunction& draw) {
    implementation_->draw = draw;
    const auto frame = [](void* self) {
        try {
            Implementation::of(self).frame();
        } catch (const std::exception& problem) {
            emscripten_cancel_main_loop();
            show_failure(problem.what());
        }
    };
    emscripten_set_main_loop_arg(frame, implementation_.get(), 0, 0);
}

// The browser closes a page without asking the explorer.
void Window::on_close(std::function<bool()>) {}
void Window::close() {}

// A sleep is not worth its while: a page that needs no frame draws none.
void Window::keep_drawing(bool moving, double pause) { implementation_->moving = moving || pause > 0.0; }

void Window::draw_again() { implementation_->unsettled = settling_frames; }

void Window::wake() { was_woken = true; }

void Window::restyle(double scale, bool dark) {
    implementation_->scale = scale;
    implementation_->dark = dark;
    implementation_->stale = true;
    implementation_->unsettled = settling_frames;
}

void Window::set_title(const std::string& title) { emscripten_set_window_title(title.c_str()); }

Image Window::picture() { return implementation_->canvas->read(); }

std::vector<std::string> Window::dropped() { return std::exchange(drops, {}); }

// The browser has its own key for that (F11 in its menu), and shows an icon of the page.
void Window::fill_screen(bool) {}
void Window::set_icons(const std::vector<Image>&) {}

bool Window::display_available() { return true; }

}  // namespace achilles
