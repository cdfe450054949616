#include "surface/offscreen.hpp"

// OSMesa's header includes the old <GL/gl.h>, which would hide half of the new one if it came first.
#include "surface/gl.hpp"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>

#include "surface/draw_data.hpp"
#include "surface/interface.hpp"

namespace achilles {

namespace {

// libOSMesa exports the whole of OpenGL; linked, it would take the place of the window's. So it is loaded by hand, and
// a machine without it gets a sentence.
struct OsMesa {
    decltype(&OSMesaCreateContextAttribs) create;
    decltype(&OSMesaDestroyContext) destroy;
    decltype(&OSMesaMakeCurrent) make_current;
    decltype(&OSMesaGetProcAddress) address;
};

template <class Function>
void find(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    if (function == nullptr) throw std::runtime_error(std::string("libOSMesa.so.8 lacks ") + name);
}

const OsMesa& os_mesa() {
    static const OsMesa loaded = [] {
        // Never closed: its compiler keeps threads and exit handlers.
        void* library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr)
            throw std::runtime_error("drawing without a window needs libOSMesa.so.8; the package libosmesa6 has it");
        OsMesa mesa{};
        find(library, "OSMesaCreateContextAttribs", mesa.create);
        find(library, "OSMesaDestroyContext", mesa.destroy);
        find(library, "OSMesaMakeCurrent", mesa.make_current);
        find(library, "OSMesaGetProcAddress", mesa.address);
        return mesa;
    }();
    return loaded;
}

// Letters in the middle of a frame would depend on a clock; every frame takes this long.
constexpr double frame_seconds = 1.0 / 60.0;

void check_size(int width, int height) {
    if (width < 1 || height < 1 || width > largest_texture || height > largest_texture)
        throw std::runtime_error("cannot draw " + std::to_string(width) + " x " + std::to_string(height) +
                                 " pixels; each side must be 1 to " + std::to_string(largest_texture));
}

}  // namespace

struct Offscreen::Implementation {
    explicit Implementation(const SurfaceOptions& surface) : options(surface), interface(surface) {
        check_size(surface.width, surface.height);
        constexpr std::array attributes{OSMESA_FORMAT,
                                        static_cast<int>(OSMESA_RGBA),
                                        OSMESA_PROFILE,
                                        OSMESA_CORE_PROFILE,
                                        OSMESA_CONTEXT_MAJOR_VERSION,
                                        3,
                                        OSMESA_CONTEXT_MINOR_VERSION,
                                        3,
                                        0};
        context = os_mesa().create(attributes.data(), nullptr);
        if (context == nullptr) throw std::runtime_error("libOSMesa.so.8 cannot make an OpenGL 3.3 context");
        const Current current(*this);
        canvas.emplace([](const char* name) { return reinterpret_cast<void*>(os_mesa().address(name)); },
                       surface.curve_fineness);
        interface.activate();
        canvas->load_fonts();
    }
    ~Implementation() {
        {
            const Current current(*this);
            canvas.reset();
        }
        os_mesa().destroy(context);
    }

    // OSMesa and a window's driver share one notion of a current context, so ours is current only while we use it.
    struct Current {
        explicit Current(Implementation& owner) {
            if (os_mesa().make_current(owner.context, owner.buffer.data(), GL_UNSIGNED_BYTE, 1, 1) == GL_FALSE)
                throw std::runtime_error("libOSMesa.so.8 cannot use its context");
        }
        ~Current() { os_mesa().make_current(nullptr, nullptr, 0, 0, 0); }
        Current(const Current&) = delete;
        Current& operator=(const Current&) = delete;
    };

    const ImDrawData& advance(const FrameFunction& draw, const Input& input) {
        interface.activate();
        apply(input);
        return interface.frame(draw, options.width, options.height, frame_seconds);
    }

    SurfaceOptions options;
    Interface interface;
    OSMesaContext context = nullptr;
    std::array<unsigned char, 4> buffer{};  // OSMesa wants one; we draw into a texture
    std::optional<Canvas> canvas;
};

Offscreen::Offscreen(const SurfaceOptions& options) : implementation_(std::make_unique<Implementation>(options)) {}
Offscreen::~Offscreen() = default;

Image Offscreen::frame(const FrameFunction& draw, int passes) { return frame(draw, passes, Input{}); }

Image Offscreen::frame(const FrameFunction& draw, int passes, const Input& input) {
    Input held = input;
    for (int pass = 1; pass < passes; ++pass) {
        step(draw, held);
        held.wheel = held.wheel_sideways = 0.0;  // what happened once must not happen again
        held.text.clear();
    }
    const Implementation::Current current(*implementation_);
    const ImDrawData& data = implementation_->advance(draw, held);
    implementation_->canvas->draw(data, implementation_->interface.background());
    return implementation_->canvas->read();
}

void Offscreen::step(const FrameFunction& draw, const Input& input) { implementation_->advance(draw, input); }

void Offscreen::restyle(double scale, bool dark) {
    implementation_->interface.restyle(scale, dark);
    const Implementation::Current current(*implementation_);
    implementation_->canvas->load_fonts();
}

}  // namespace achilles
