#include "surface/offscreen.hpp"

#include <optional>
#include <stdexcept>
#include <string>

#include "surface/draw_data.hpp"
#include "surface/interface.hpp"
#include "surface/memory_context.hpp"

namespace achilles {

namespace {

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
        context = memory_context(surface.width, surface.height);
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

}  // namespace achilles
