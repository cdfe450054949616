#include "surface/offscreen.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "surface/draw_data.hpp"
#include "surface/interface.hpp"
#include "surface/memory_context.hpp"

namespace achilles {

namespace {

// Address space (bytes) that Mesa and its compiler need for pictures of this size. Measured without a limit on two
// cores: 460 MB and 9 bytes per pixel; each further core has a thread with its stack.
std::size_t room_for(int width, int height) {
    constexpr std::size_t fixed = std::size_t{512} << 20, per_core = std::size_t{8} << 20, per_pixel = 16;
    const std::size_t cores = std::clamp(std::thread::hardware_concurrency(), 2U, 16U);  // Mesa uses at most 16
    return fixed + (cores - 2) * per_core +
           per_pixel * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

// OSMesa, or EGL where Debian no longer has OSMesa; both produce the same bytes. ACHILLES_OFFSCREEN=osmesa or egl
// forces one.
MemoryContext memory_context() {
    choose_renderer();
    const char* const given = std::getenv("ACHILLES_OFFSCREEN");
    const std::string wanted = given == nullptr ? "" : given;
    if (wanted == "osmesa") return os_mesa_context();
    if (wanted == "egl") return egl_context();
    if (!wanted.empty()) throw std::runtime_error("ACHILLES_OFFSCREEN must be osmesa or egl, not '" + wanted + "'");
    std::string missing;
    try {
        return os_mesa_context();
    } catch (const std::runtime_error& error) {
        missing = error.what();
    }
    try {
        return egl_context();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error("drawing without a window needs OSMesa or EGL, but " + missing + ", and " +
                                 error.what() + "\ninstall the package libosmesa6, or libegl1 and libgl1-mesa-dri");
    }
}

// Fixed duration of a frame, so that pictures do not depend on a clock.
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
        check_room("drawing", room_for(surface.width, surface.height));
        context = memory_context();
        const Interface::Active active(interface);
        const CurrentContext current(*this);
        canvas.emplace(context.address, surface.curve_fineness);
        canvas->load_fonts();
    }
    ~Implementation() {
        const CurrentContext current(*this);
        canvas.reset();
    }

    // Mesa's drivers and a window share one current context, so this one is current only while it is used.
    struct CurrentContext {
        explicit CurrentContext(Implementation& owner) : context(owner.context) { context.make_current(); }
        ~CurrentContext() { context.release(); }
        CurrentContext(const CurrentContext&) = delete;
        CurrentContext& operator=(const CurrentContext&) = delete;
        MemoryContext& context;
    };

    const ImDrawData& advance(const FrameFunction& draw, const Input& input) {
        apply(input);
        return interface.frame(draw, options.width, options.height, frame_seconds);
    }

    SurfaceOptions options;
    Interface interface;
    MemoryContext context;
    std::optional<Canvas> canvas;
};

Offscreen::Offscreen(const SurfaceOptions& options) : implementation_(std::make_unique<Implementation>(options)) {}
Offscreen::~Offscreen() = default;

Image Offscreen::frame(const FrameFunction& draw, int passes) { return frame(draw, passes, Input{}); }

Image Offscreen::frame(const FrameFunction& draw, int passes, const Input& input) {
    Input held = input;
    for (int pass = 1; pass < passes; ++pass) {
        step(draw, held);
        held.wheel = held.wheel_sideways = 0.0;  // one-time input must not repeat
        held.text.clear();
    }
    const Interface::Active active(implementation_->interface);
    const ImDrawData& data = implementation_->advance(draw, held);
    const Implementation::CurrentContext current(*implementation_);
    Canvas& canvas = *implementation_->canvas;
    const bool transparent = implementation_->options.transparent;
    if (transparent)
        canvas.draw_over_nothing(data);
    else
        canvas.draw(data, implementation_->interface.background());
    return canvas.read(transparent);
}

void Offscreen::step(const FrameFunction& draw, const Input& input) {
    const Interface::Active active(implementation_->interface);
    implementation_->advance(draw, input);
}

void Offscreen::restyle(double scale, bool dark) {
    const Interface::Active active(implementation_->interface);
    implementation_->interface.restyle(scale, dark);
    const Implementation::CurrentContext current(*implementation_);
    implementation_->canvas->load_fonts();
}

void check_room(const std::string& purpose, std::size_t bytes) {
    void* const room =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED)
        throw NotEnoughMemory("there is not enough memory for " + purpose + ", which may take " +
                              std::to_string(bytes >> 20) + " MB; ulimit -v prints the limit for this process");
    ::munmap(room, bytes);
}

}  // namespace achilles
