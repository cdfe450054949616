// Figures for Python: their appearance and the notes stored in them.
#include "module.hpp"
#include "output/output.hpp"
#include "pictures/export.hpp"
#include "pictures/picture_format.hpp"

namespace py = pybind11;

namespace achilles::python {

FigureStyle figure_style(const FigureStyleTuple& tuple, const std::string& format) {
    const auto& [views, size, scale, page, columns, dark, transparent] = tuple;
    FigureStyle look;
    look.views = views;
    look.size = {size[0], size[1], scale};
    look.page = {page[0], page[1], page[2], page[3]};
    look.style.columns = columns;
    look.style.dark = dark;
    look.style.transparent = transparent;
    look.style.ordered = !look.views.empty();
    look.style.size = resolution_of(look.page, look.size, format);
    look.style.shape = double{1} * look.size.width / look.size.height;
    check(look.page, "figure");
    look.page = page_for(look.page, format);
    if (format == "pdf") need_pdf_writer("save");
    return look;
}

void add(std::vector<std::string>& words, const FigureStyle& look) {
    const auto add = [&](const char* flag, const std::string& value) { words.insert(words.end(), {flag, value}); };
    for (const std::string& view : look.views) add("--view", view);
    // On a page, too, the shape of the size arranges the panels.
    add("--size", std::to_string(look.size.width) + "x" + std::to_string(look.size.height));
    if (look.page.width > 0.0) {
        add("--width-mm", to_text(OptionValue{look.page.width}));
        if (look.page.height > 0.0) add("--height-mm", to_text(OptionValue{look.page.height}));
        if (look.page.font > 0.0) add("--font-pt", to_text(OptionValue{look.page.font}));
        if (look.page.dpi > 0.0) add("--dpi", to_text(OptionValue{look.page.dpi}));
    } else {
        add("--scale", to_text(OptionValue{look.size.scale}));
    }
    if (look.style.columns > 0) add("--columns", std::to_string(look.style.columns));
    if (look.style.dark) words.emplace_back("--dark");
    if (look.style.transparent) words.emplace_back("--transparent");
}

std::string picture_of(const Figure& figure, const FigureStyle& look, const std::string& format,
                       const std::string& command, const std::vector<InputSource>& sources, const Trajectory& shown) {
    const Origin origin{"Achilles " + version(), command, "", sources};
    return achilles::picture_of(figure, size_of(look.page, look.size, figure, format),
                                notes(origin, {{sources[0].name, &shown}}), format);
}

py::bytes without_gil(const std::function<std::string()>& make) {
    std::string bytes;
    {
        const py::gil_scoped_release released;
        bytes = make();
    }
    return bytes;
}

}  // namespace achilles::python
