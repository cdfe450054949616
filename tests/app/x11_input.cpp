// Window actions that xdotool lacks: a close request by a window manager, and a file drop by a file manager (XDND
// protocol).
//     x11_input close WINDOW
//     x11_input drop WINDOW FILE
#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

void send(Display* display, Window to, const char* type, long a, long b = 0, long c = 0, long d = 0, long e = 0) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = to;
    event.xclient.message_type = XInternAtom(display, type, False);
    event.xclient.format = 32;
    const long data[] = {a, b, c, d, e};
    for (int i = 0; i < 5; ++i) event.xclient.data.l[i] = data[i];
    XSendEvent(display, to, False, NoEventMask, &event);
    XFlush(display);
}

long atom(Display* display, const char* name) { return static_cast<long>(XInternAtom(display, name, False)); }

// Sends the file's name to the requesting window.
void answer(Display* display, const XSelectionRequestEvent& request, const std::string& text) {
    XChangeProperty(display, request.requestor, request.property, request.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
    XEvent event{};
    event.xselection.type = SelectionNotify;
    event.xselection.requestor = request.requestor;
    event.xselection.selection = request.selection;
    event.xselection.target = request.target;
    event.xselection.property = request.property;
    event.xselection.time = request.time;
    XSendEvent(display, request.requestor, False, NoEventMask, &event);
    XFlush(display);
}

void drop(Display* display, Window target, const std::string& file) {
    const Window source = XCreateSimpleWindow(display, DefaultRootWindow(display), 0, 0, 1, 1, 0, 0, 0);
    const auto from = static_cast<long>(source);
    XSetSelectionOwner(display, XInternAtom(display, "XdndSelection", False), source, CurrentTime);
    const long list = atom(display, "text/uri-list");
    send(display, target, "XdndEnter", from, 5L << 24, list);
    send(display, target, "XdndPosition", from, 0, (300L << 16) | 300, CurrentTime, atom(display, "XdndActionCopy"));
    send(display, target, "XdndDrop", from, 0, CurrentTime);
    for (;;) {
        XEvent event;
        XNextEvent(display, &event);
        if (event.type == SelectionRequest) answer(display, event.xselectionrequest, "file://" + file + "\r\n");
        const auto finished = static_cast<Atom>(atom(display, "XdndFinished"));
        if (event.type == ClientMessage && event.xclient.message_type == finished) return;
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    Display* const display = XOpenDisplay(nullptr);
    if (display == nullptr || argc < 3 || (what == "drop" && argc < 4)) {
        std::fputs("usage, on a display: x11_input close WINDOW, or: x11_input drop WINDOW FILE\n", stderr);
        return 2;
    }
    const Window target = std::strtoul(argv[2], nullptr, 0);
    if (what == "close")
        send(display, target, "WM_PROTOCOLS", atom(display, "WM_DELETE_WINDOW"), CurrentTime);
    else
        drop(display, target, argv[3]);
    XCloseDisplay(display);
    return 0;
}
