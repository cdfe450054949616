#include "surface/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <utility>

#include "surface/draw_data.hpp"
#include "surface/frame.hpp"
#include "surface/imgui_version.hpp"
#include "surface/interface.hpp"
#include "surface/memory_context.hpp"

namespace achilles {

namespace {

static_assert(key::escape == GLFW_KEY_ESCAPE && key::remove == GLFW_KEY_DELETE && key::end == GLFW_KEY_END &&
              key::right == GLFW_KEY_RIGHT && key::f1 == GLFW_KEY_F1 && key::f11 == GLFW_KEY_F11 &&
              key::keypad_enter == GLFW_KEY_KP_ENTER && key::left_shift == GLFW_KEY_LEFT_SHIFT &&
              key::right_super == GLFW_KEY_RIGHT_SUPER && ' ' == GLFW_KEY_SPACE && 'A' == GLFW_KEY_A);

// A minimized window checks for events at this interval.
constexpr double sleep_seconds = 0.5;
// ImGui needs a few frames after an event to settle: at most four, and fewer if they draw the same.
constexpr int settling_frames = 4, least_frames = 2;
// Moving content is drawn this often, also by a display that does not set the pace.
constexpr double moving_seconds = 1.0 / 60.0;
// ImGui rejects a time step of zero, s.
constexpr double least_step = 1e-4;

// Set by another thread: the next frames must show its results.
std::atomic<bool> was_woken = false;

std::string& last_glfw_error() {
    static std::string text;
    return text;
}

bool display_is_named() {
    const char* display = std::getenv("DISPLAY");
    return display != nullptr && *display != '\0';
}

// Starts GLFW once. It is never terminated: that would unload the graphics driver, which some drivers do not survive,
// and the end of the process has the same effect.
bool glfw_works() {
    choose_renderer();
    glfwSetErrorCallback([](int, const char* text) { last_glfw_error() = text; });
    return display_is_named() && glfwInit() == GLFW_TRUE;
}

// The requested size, limited to the monitor. GLFW multiplies it by the monitor's scale.
std::pair<int, int> fitting_size(const SurfaceOptions& surface) {
    GLFWmonitor* monitor = glfwGetPrimaryMonitor();
    if (monitor == nullptr) return {surface.width, surface.height};
    int x = 0, y = 0, width = 0, height = 0;
    float across = 1.0F, down = 1.0F;
    glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    glfwGetMonitorContentScale(monitor, &across, &down);
    const auto fit = [](int wanted, int room, float scale) {
        return std::max(room > 0 ? std::min(wanted, static_cast<int>(static_cast<float>(room) / scale)) : wanted, 1);
    };
    return {fit(surface.width, width, across), fit(surface.height, height, down)};
}

// Code of a key. Letters, plus and minus follow the keyboard layout instead of the position: Ctrl+Q is Ctrl+Q on every
// keyboard. Plus has the code of '=', with which it shares a key on layouts where it needs Shift.
int code_of(int code, int scancode) {
    const char* name = glfwGetKeyName(code, scancode);
    const bool one_letter = name != nullptr && name[0] != '\0' && name[1] == '\0';
    const auto letter = one_letter ? static_cast<unsigned char>(name[0]) : 0;
    if (letter == '+' || letter == '-') return letter == '+' ? '=' : '-';
    if (code < GLFW_KEY_A || code > GLFW_KEY_Z) return code;
    return letter < 128 && std::isalpha(letter) != 0 ? std::toupper(letter) : code;
}

}  // namespace

struct Window::Implementation {
    Implementation(const SurfaceOptions& surface, const std::string& title)
        : owned(open(surface, title), glfwDestroyWindow), window(owned.get()), interface(with_scale(surface, window)) {
        float across = 1.0F, down = 1.0F;
        glfwGetWindowContentScale(window, &across, &down);
        monitor_scale = across;
        scale = surface.scale;
        dark = surface.dark;
        const Interface::Active active(interface);
        const CurrentWindowContext current(window);
        glfwSwapInterval(1);
        canvas.emplace([](const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); },
                       surface.curve_fineness);
        canvas->load_fonts();
        set_clipboard();
        make_cursors();
        listen();
    }
    ~Implementation() {
        {
            const CurrentWindowContext current(window);
            canvas.reset();
        }
        for (GLFWcursor* cursor : cursors)
            if (cursor != nullptr) glfwDestroyCursor(cursor);
    }

    // OSMesa and the window's driver share one current context, so this one is current only while it is used.
    struct CurrentWindowContext {
        explicit CurrentWindowContext(GLFWwindow* window) { glfwMakeContextCurrent(window); }
        ~CurrentWindowContext() { glfwMakeContextCurrent(nullptr); }
        CurrentWindowContext(const CurrentWindowContext&) = delete;
        CurrentWindowContext& operator=(const CurrentWindowContext&) = delete;
    };

    static GLFWwindow* open(const SurfaceOptions& surface, const std::string& title);
    static SurfaceOptions with_scale(SurfaceOptions surface, GLFWwindow* window);
    static Implementation& of(GLFWwindow* window) {
        return *static_cast<Implementation*>(glfwGetWindowUserPointer(window));
    }
    void listen();
    void listen_to_keyboard();
    void set_clipboard();
    void make_cursors();
    void show_cursor();
    void wait();
    void unsettle() { unsettled = settling_frames, drawn = calm = 0; }
    void show_again() { unsettle(), must_show = true; }
    void settle_early();
    bool is_closing();
    void restyle();
    void frame(const FrameFunction& draw);

    std::unique_ptr<GLFWwindow, decltype(&glfwDestroyWindow)> owned;
    GLFWwindow* window;
    Clipboard clipboard{};
    Interface interface;
    std::optional<Canvas> canvas;
    Events events;
    std::vector<std::string> files;
    std::function<bool()> may_close;
    std::array<GLFWcursor*, ImGuiMouseCursor_COUNT> cursors{};
    double monitor_scale = 1.0, scale = 1.0;
    bool dark = false, stale = false, moving = true;
    int unsettled = settling_frames;  // frames to draw until the window may sleep
    int drawn = 0, calm = 0;          // frames since the last event; the last of them that drew nothing new
    bool only_moves = false;          // the last events are moves of the pointer
    bool must_show = true;            // the window system needs the picture again
    bool is_outdated = false;         // the content has changed since it was drawn
    double last_frame = -1.0, pause = 0.0;
    std::array<int, 4> before_full_screen{};  // x, y, width, height
};

GLFWwindow* Window::Implementation::open(const SurfaceOptions& surface, const std::string& title) {
    if (!glfw_works())
        throw std::runtime_error("no window can be opened: " +
                                 (display_is_named() ? last_glfw_error() : "the variable DISPLAY is not set"));
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "achilles");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "achilles");
    const auto [width, height] = fitting_size(surface);
    GLFWwindow* made = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (made == nullptr) throw std::runtime_error("no OpenGL 3.3 window can be opened: " + last_glfw_error());
    return made;
}

SurfaceOptions Window::Implementation::with_scale(SurfaceOptions surface, GLFWwindow* window) {
    float across = 1.0F, down = 1.0F;
    glfwGetWindowContentScale(window, &across, &down);
    surface.scale *= double{across};
    return surface;
}

void Window::Implementation::listen() {
    glfwSetWindowUserPointer(window, this);
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        // The window system may use units larger than a pixel; convert to pixels.
        int width = 1, height = 1, pixels_across = 1, pixels_down = 1;
        glfwGetWindowSize(w, &width, &height);
        glfwGetFramebufferSize(w, &pixels_across, &pixels_down);
        of(w).events.mouse_at(x * pixels_across / std::max(width, 1), y * pixels_down / std::max(height, 1));
    });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
        if (entered == GLFW_FALSE) of(w).events.mouse_left();
    });
    glfwSetMouseButtonCallback(
        window, [](GLFWwindow* w, int button, int action, int) { of(w).events.button(button, action == GLFW_PRESS); });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) { of(w).events.wheel(x, y); });
    glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
        if (focused == GLFW_FALSE) of(w).events.release_all();
        of(w).show_again();
    });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).show_again(); });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).show_again(); });
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float across, float) {
        of(w).monitor_scale = double{across};
        of(w).stale = true;
    });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        of(w).files.insert(of(w).files.end(), paths, paths + count);
        of(w).unsettle();
    });
    listen_to_keyboard();
}

void Window::Implementation::listen_to_keyboard() {
    glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int scancode, int action, int modifiers) {
        if (action == GLFW_REPEAT || code == GLFW_KEY_UNKNOWN) return;  // ImGui repeats keys itself
        const int letter = code_of(code, scancode);
        if (action == GLFW_PRESS && letter == 'Q' && (modifiers & GLFW_MOD_CONTROL) != 0)
            glfwSetWindowShouldClose(w, GLFW_TRUE);
        of(w).events.key(letter, action == GLFW_PRESS);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code_point) { of(w).events.character(code_point); });
}

void Window::Implementation::set_clipboard() {
    clipboard = {window, [](void* w) { return glfwGetClipboardString(static_cast<GLFWwindow*>(w)); },
                 [](void* w, const char* text) { glfwSetClipboardString(static_cast<GLFWwindow*>(w), text); }};
    use_clipboard(clipboard);
}

void Window::Implementation::make_cursors() {
    for (const auto& [ours, theirs] : {std::pair{ImGuiMouseCursor_Arrow, GLFW_ARROW_CURSOR},
                                       std::pair{ImGuiMouseCursor_TextInput, GLFW_IBEAM_CURSOR},
                                       std::pair{ImGuiMouseCursor_ResizeNS, GLFW_VRESIZE_CURSOR},
                                       std::pair{ImGuiMouseCursor_ResizeEW, GLFW_HRESIZE_CURSOR},
                                       std::pair{ImGuiMouseCursor_Hand, GLFW_HAND_CURSOR}})
        cursors[static_cast<std::size_t>(ours)] = glfwCreateStandardCursor(theirs);
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_HasMouseCursors;
}

void Window::Implementation::show_cursor() {
    const ImGuiMouseCursor wanted = ImGui::GetMouseCursor();
    if (wanted < 0) return;
    glfwSetCursor(window, cursors[static_cast<std::size_t>(wanted)]);  // null: the arrow
}

void Window::Implementation::wait() {
    if (moving && unsettled == 0 && events.empty()) {
        glfwWaitEventsTimeout(std::max(moving_seconds - (glfwGetTime() - last_frame), 1e-6));
    } else if (unsettled > 0 || !events.empty()) {
        glfwPollEvents();
    } else {
        if (pause > 0.0)
            glfwWaitEventsTimeout(pause);
        else
            glfwWaitEvents();
        unsettled = std::max(unsettled, 1);
    }
    const bool is_woken = was_woken.exchange(false);
    if (!is_woken && events.empty()) return;
    unsettle();
    only_moves = !is_woken && events.are_moves();
}

// Ends the settling if nothing changes any more. A move of the pointer changes less than a click or a key.
void Window::Implementation::settle_early() {
    ++drawn;
    calm = canvas->has_changed() ? 0 : calm + 1;
    if (drawn >= least_frames && calm >= (only_moves ? 1 : 2) && !awaits_frame()) unsettled = 0;
}

bool Window::Implementation::is_closing() {
    if (glfwWindowShouldClose(window) == GLFW_FALSE) return false;
    if (!may_close || may_close()) return true;
    glfwSetWindowShouldClose(window, GLFW_FALSE);
    unsettle();
    return false;
}

void Window::Implementation::restyle() {
    interface.restyle(scale * monitor_scale, dark);
    const CurrentWindowContext current(window);
    canvas->load_fonts();
    stale = false;
}

void Window::Implementation::frame(const FrameFunction& draw) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    if (width < 1 || height < 1) return glfwWaitEventsTimeout(sleep_seconds);  // minimized
    const double now = glfwGetTime();
    // After a sleep nothing must jump.
    const double step = last_frame < 0.0 ? 1.0 / 60.0 : std::clamp(now - last_frame, least_step, 0.1);
    last_frame = now;
    unsettled = std::max(unsettled - 1, 0);
    const Interface::Active active(interface);
    if (stale) restyle();
    apply(events.next(ImGui::GetIO().WantTextInput));
    is_outdated = false;
    const ImDrawData* data = &interface.frame(draw, width, height, step);
    // Once: the second call may change the content, too, and its frame must not wait for ever.
    if (is_outdated) data = &interface.frame(draw, width, height, least_step);
    show_cursor();
    const CurrentWindowContext current(window);
    canvas->draw(*data, interface.background());
    settle_early();
    if (!std::exchange(must_show, false) && !canvas->has_changed()) return;
    canvas->show();
    glfwSwapBuffers(window);
}

Window::Window(const SurfaceOptions& options, const std::string& title)
    : implementation_(std::make_unique<Implementation>(options, title)) {}
Window::~Window() = default;

void Window::run(const FrameFunction& draw) {
    Implementation& self = *implementation_;
    glfwSetWindowShouldClose(self.window, GLFW_FALSE);
    while (!self.is_closing()) {
        self.wait();
        if (!self.is_closing()) self.frame(draw);
    }
}

void Window::on_close(std::function<bool()> may_close) { implementation_->may_close = std::move(may_close); }

void Window::close() { glfwSetWindowShouldClose(implementation_->window, GLFW_TRUE); }

void Window::keep_drawing(bool moving, double pause) {
    implementation_->moving = moving;
    implementation_->pause = pause;
}

void Window::draw_again() {
    implementation_->is_outdated = true;
    implementation_->unsettle();
    implementation_->only_moves = false;
}

void Window::wake() {
    was_woken = true;
    glfwPostEmptyEvent();
}

void Window::restyle(double scale, bool dark) {
    implementation_->scale = scale;
    implementation_->dark = dark;
    implementation_->stale = true;
    implementation_->show_again();
}

void Window::fill_screen(bool full) {
    GLFWwindow* const window = implementation_->window;
    if (full == (glfwGetWindowMonitor(window) != nullptr)) return;
    auto& [x, y, width, height] = implementation_->before_full_screen;
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* const mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    if (full && mode != nullptr) {
        glfwGetWindowPos(window, &x, &y);
        glfwGetWindowSize(window, &width, &height);
        glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    } else if (!full) {
        glfwSetWindowMonitor(window, nullptr, x, y, width, height, GLFW_DONT_CARE);
    }
    draw_again();
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(implementation_->window, title.c_str()); }

void Window::set_icons(const std::vector<Image>& icons) {
    std::vector<std::vector<unsigned char>> pixels;
    std::vector<GLFWimage> images;
    for (const Image& icon : icons) {
        pixels.push_back(rgba(icon));
        images.push_back({icon.width, icon.height, pixels.back().data()});
    }
    glfwSetWindowIcon(implementation_->window, static_cast<int>(images.size()), images.data());
}

Image Window::picture() {
    const Implementation::CurrentWindowContext current(implementation_->window);
    return implementation_->canvas->read();
}

std::vector<std::string> Window::dropped() { return std::exchange(implementation_->files, {}); }

bool Window::display_available() { return glfw_works(); }

}  // namespace achilles
