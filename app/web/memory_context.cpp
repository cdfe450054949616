// Pictures on a page: WebGL in a canvas that is not shown.
#include "surface/memory_context.hpp"

#include <emscripten.h>
#include <emscripten/html5.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "surface/offscreen.hpp"

// clang-format off
EM_JS(void, add_hidden_canvas, (int number), {
    const canvas = document.createElement('canvas');
    canvas.id = 'hidden' + number;
    canvas.hidden = true;
    canvas.width = canvas.height = 1;
    document.body.append(canvas);
})
EM_JS(void, remove_hidden_canvas, (int number), { document.getElementById('hidden' + number).remove(); })
// clang-format on

namespace achilles {

namespace {

class HiddenContext {
 public:
    HiddenContext() {
        static int canvases = 0;
        number_ = ++canvases;
        add_hidden_canvas(number_);
        EmscriptenWebGLContextAttributes wanted;
        emscripten_webgl_init_context_attributes(&wanted);
        wanted.majorVersion = 2;
        context_ = emscripten_webgl_create_context(("#hidden" + std::to_string(number_)).c_str(), &wanted);
        if (context_ > 0) return;
        remove_hidden_canvas(number_);
        throw std::runtime_error("this browser has no WebGL 2");
    }
    ~HiddenContext() {
        emscripten_webgl_destroy_context(context_);
        remove_hidden_canvas(number_);
    }
    HiddenContext(const HiddenContext&) = delete;
    HiddenContext& operator=(const HiddenContext&) = delete;

    void make_current() {
        before_ = emscripten_webgl_get_current_context();
        emscripten_webgl_make_context_current(context_);
    }
    void release() const { emscripten_webgl_make_context_current(before_); }

 private:
    int number_ = 0;
    EMSCRIPTEN_WEBGL_CONTEXT_HANDLE context_ = 0, before_ = 0;
};

}  // namespace

MemoryContext memory_context(int, int) {
    const auto hidden = std::make_shared<HiddenContext>();
    MemoryContext context;
    context.owned = hidden;
    context.make_current = [self = hidden.get()] { self->make_current(); };
    context.release = [self = hidden.get()] { self->release(); };
    context.address = [](const char* name) { return emscripten_webgl_get_proc_address(name); };
    return context;
}

// The browser draws with memory of its own.
void check_room(const std::string&, std::size_t) {}

}  // namespace achilles
