// Writes figures as SVG. The only file that includes FreeType.
#include "paint/svg.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>

#include "figure/label.hpp"
#include "figure/layout.hpp"
#include "image/image.hpp"
#include "image/notes.hpp"
#include "paint/paint.hpp"
#include "surface/curves.hpp"

namespace achilles {

// Metrics of the font from its file, for drawings whose text another program renders.

// All lengths except those of width() are fractions of the em.
class FontFile {
 public:
    // `fonts`: the folder of DejaVuSans.ttf. Throws std::runtime_error if it cannot be read.
    explicit FontFile(const std::filesystem::path& fonts);
    ~FontFile();
    FontFile(const FontFile&) = delete;
    FontFile& operator=(const FontFile&) = delete;

    struct Glyph {
        double advance = 0.0, left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;  // box of the ink, upward from the
                                                                                 // baseline
    };
    const Glyph& glyph(char32_t code) const;
    // Width of a line of text of height `size`, as a painter with this font would place it.
    float width(const std::string& label, float size) const;
    // Fractions of the line height: the em, and the distance of the baseline from the top.
    double em() const { return em_; }
    double base() const { return base_; }

 private:
    struct Face;
    std::unique_ptr<Face> face_;
    mutable std::map<char32_t, Glyph> glyphs_;
    double em_ = 1.0, base_ = 1.0;
};

struct FontFile::Face {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    ~Face() {
        if (face != nullptr) FT_Done_Face(face);
        if (library != nullptr) FT_Done_FreeType(library);
    }
};

FontFile::FontFile(const std::filesystem::path& fonts) : face_(std::make_unique<Face>()) {
    const std::string file = (fonts / "DejaVuSans.ttf").string();
    if (FT_Init_FreeType(&face_->library) != 0 || FT_New_Face(face_->library, file.c_str(), 0, &face_->face) != 0)
        throw std::runtime_error(file + ": the font cannot be read; install the package fonts-dejavu-core");
    // The height of a line is the font's ascent plus descent, as in ImGui.
    const FT_Face face = face_->face;
    const double height = face->ascender - face->descender;
    em_ = face->units_per_EM / height;
    base_ = face->ascender / height;
}

FontFile::~FontFile() = default;

const FontFile::Glyph& FontFile::glyph(char32_t code) const {
    const auto [entry, is_new] = glyphs_.try_emplace(code);
    Glyph& glyph = entry->second;
    const FT_Face face = face_->face;
    if (!is_new || FT_Load_Char(face, code, FT_LOAD_NO_SCALE) != 0) return glyph;
    const FT_Glyph_Metrics& m = face->glyph->metrics;
    const double em = face->units_per_EM;
    glyph = {static_cast<double>(m.horiAdvance) / em, static_cast<double>(m.horiBearingX) / em,
             static_cast<double>(m.horiBearingX + m.width) / em, static_cast<double>(m.horiBearingY - m.height) / em,
             static_cast<double>(m.horiBearingY) / em};
    return glyph;
}

float FontFile::width(const std::string& label, float size) const {
    double width = 0.0;
    for (const Letter& letter : letters(label))
        width += glyph(letter.code).advance * (letter.script == 0 ? 1.0 : double{script_size});
    return static_cast<float>(width * em_) * size;
}

namespace {

// Maximum error of thinned curves, in pixels: finer than any print.
constexpr double thinning_tolerance = 0.01;

// Two decimals, no trailing zeros, no "-0".
std::string number(double x) {
    std::string text = fmt::format("{:.2f}", x);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

std::string color(const char* attribute, Color c) {
    std::string text = fmt::format(" {}=\"#{:02x}{:02x}{:02x}\"", attribute, c.r, c.g, c.b);
    if (c.a < 255) text += fmt::format(" {}-opacity=\"{}\"", attribute, number(c.a / 255.0));
    return text;
}

// Consecutive letters of one kind.
struct Span {
    std::string text;
    bool italic = false;
    int script = 0;
    double dx = 0.0;  // horizontal offset from the end of the previous span
    double up = 0.0;  // height of its baseline
    bool same_kind(const Letter& letter) const { return italic == letter.italic && script == letter.script; }
};

// Each cell becomes several pixels, because some programs interpolate enlarged images in any case.
Image image_of(const Cells& cells) {
    constexpr int most = 8, side = 2048;
    const int times = std::clamp(side / std::max({cells.columns, cells.rows, 1}), 1, most);
    Image image{cells.columns * times, cells.rows * times, {}, {}};
    const bool is_clear = std::any_of(cells.colors.begin(), cells.colors.end(), [](Color c) { return c.a < 255; });
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Color& c = cells.colors[static_cast<std::size_t>(y / times * cells.columns + x / times)];
            image.rgb.insert(image.rgb.end(), {c.r, c.g, c.b});
            if (is_clear) image.alpha.push_back(c.a);
        }
    return image;
}

// Writes the items of a sheet in order.
class SvgWriter {
 public:
    SvgWriter(const FontFile& font, std::string prefix) : font_(font), prefix_(std::move(prefix)) {}

    void operator()(const Fill& fill) {
        const Rectangle& r = fill.area;
        body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", number(r.x), number(r.y),
                             number(r.width), number(r.height), color("fill", fill.color));
    }

    void operator()(const Path& path) {
        const Stroke& stroke = path.stroke;
        if (!(stroke.width > 0.0) || stroke.color.a == 0) return;
        const std::vector<Point> points = thinned(nearby(path), thinning_tolerance);
        if (points.empty()) return;
        body_ += fmt::format("<g clip-path=\"url(#{})\"{} stroke-width=\"{}\">\n", clip(path.clip),
                             color("stroke", stroke.color), number(stroke.width));
        // Solid pieces form one path. Separate paths that overlap, as for a periodic motion, would add up their
        // anti-aliased edges.
        if (stroke.dash.empty()) body_ += "<path d=\"";
        double length = 0.0;  // arc length so far: dashes continue across a break
        for (auto begin = points.begin(); begin != points.end();) {
            const auto end = std::find_if_not(begin, points.end(), is_finite);
            if (begin != end) write_piece(begin, end, stroke, length);
            begin = end == points.end() ? end : end + 1;
        }
        if (stroke.dash.empty()) body_ += "\"/>\n";
        body_ += "</g>\n";
    }

    // Fills the interior of a closed line.
    void fill(const std::vector<Point>& rim, const Color& inside, const Rectangle& within) {
        if (rim.size() < 3 || inside.a == 0 || !std::all_of(rim.begin(), rim.end(), is_finite)) return;
        body_ += fmt::format("<path clip-path=\"url(#{})\"{} d=\"M", clip(within), color("fill", inside));
        for (const Point& p : thinned(nearby({rim, {}, {}}), thinning_tolerance))
            body_ += number(p.x) + "," + number(p.y) + " ";
        body_ += "Z\"/>\n";
    }

    void operator()(const Strip& strip) {
        std::vector<Point> rim = strip.upper;
        rim.insert(rim.end(), strip.lower.rbegin(), strip.lower.rend());
        fill(rim, strip.color, strip.clip);
    }

    void operator()(const Mark& mark) {
        const std::string look =
            color("fill", mark.fill) +
            (mark.edge.a > 0 ? color("stroke", mark.edge) + " stroke-width=\"" + number(mark.edge_width) + "\"" : "");
        if (mark.shape == Markers::MarkerShape::circle) {
            body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", number(mark.at.x), number(mark.at.y),
                                 number(mark.size / 2.0), look);
            return;
        }
        body_ += "<path d=\"M";
        for (const Point& p : corners(mark)) body_ += number(p.x) + "," + number(p.y) + " ";
        body_ += "Z\"" + look + "/>\n";
    }

    void operator()(const Tiles& tiles) {
        const Rectangle& r = tiles.area;
        body_ += fmt::format(
            "<g clip-path=\"url(#{})\"><image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" "
            "preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" style=\"image-rendering:pixelated\" "
            "xlink:href=\"data:image/png;base64,",
            clip(tiles.clip), number(r.x), number(r.y), number(r.width), number(r.height));
        body_ += base64(png_bytes(image_of(*tiles.cells), {9, -1})) + "\"/></g>\n";
        has_images_ = true;
    }

    void operator()(const TextRun& words) {
        const std::vector<Letter> line = letters(words.label);
        if (line.empty()) return;
        const double em = font_.em() * double{words.size}, base = font_.base() * double{words.size};
        const char* const anchor = words.anchor == 0.5F ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
        const std::string place =
            words.upwards
                ? fmt::format("transform=\"translate({} {}) rotate(-90)\"", number(words.x + base), number(words.y))
                : fmt::format("x=\"{}\" y=\"{}\"", number(words.x), number(words.y + base));
        body_ += fmt::format("<text {} font-size=\"{}\"{}{}>", place, number(em), words.anchor == 0.0F ? "" : anchor,
                             color("fill", words.color));
        write_spans(spans(line, em), em);
        body_ += "</text>\n";
    }

    const std::string& body() const { return body_; }
    bool has_images() const { return has_images_; }
    std::string clips() const {
        std::string text;
        for (const auto& [box, name] : clips_)
            text += fmt::format("<clipPath id=\"{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
                                name, number(std::get<0>(box)), number(std::get<1>(box)), number(std::get<2>(box)),
                                number(std::get<3>(box)));
        return text;
    }

 private:
    using Points = std::vector<Point>::const_iterator;

    // Renderers use single precision, so the part of a path far outside is clipped.
    static std::vector<Point> nearby(const Path& path) {
        constexpr double far = 1e5;
        const auto is_near = [](const Point& p) {
            return !is_finite(p) || (std::abs(p.x) < far && std::abs(p.y) < far);
        };
        if (std::all_of(path.points.begin(), path.points.end(), is_near)) return path.points;
        return cut(path.points, {-far, -far, far, far}, {}, 0.0);
    }

    // Writes a part of the path that is open, or a separate path with dashes.
    void write_piece(Points begin, Points end, const Stroke& stroke, double& length) {
        const bool is_dashed = !stroke.dash.empty();
        body_ += is_dashed ? "<path d=\"M" : body_.back() == '"' ? "M" : " M";
        for (Points p = begin; p != end; ++p) body_ += (p == begin ? "" : " ") + number(p->x) + "," + number(p->y);
        if (!is_dashed) return;
        // Strokes have round ends, which extend by half the stroke width: dashes are shortened by that.
        body_ += "\" stroke-dasharray=\"";
        for (std::size_t i = 0; i < stroke.dash.size(); ++i)
            body_ +=
                (i == 0 ? "" : ",") + number(std::max(stroke.dash[i] + (i % 2 == 0 ? -1.0 : 1.0) * stroke.width, 0.0));
        body_ += fmt::format("\" stroke-dashoffset=\"{}\"/>\n", number(length - stroke.width / 2.0));
        for (Points p = begin; p + 1 < end; ++p) length += std::hypot((p + 1)->x - p->x, (p + 1)->y - p->y);
    }

    const std::string& clip(const Rectangle& r) {
        std::string& name = clips_[{r.x, r.y, r.width, r.height}];
        if (name.empty()) name = fmt::format("{}plot{}", prefix_, clips_.size());
        return name;
    }

    // Splits letters into spans. Dots are separate characters, centered above their letter.
    std::vector<Span> spans(const std::vector<Letter>& line, double em) const {
        std::vector<Span> result;
        double dx = 0.0;
        for (const Letter& letter : line) {
            const double size = letter.script == 0 ? em : em * double{script_size};
            const double shift = letter.script < 0 ? -double{index_drop} : letter.script > 0 ? double{power_rise} : 0.0;
            if (result.empty() || !result.back().same_kind(letter) || dx != 0.0)
                result.push_back({"", letter.italic, letter.script, dx, shift * em / font_.em()});
            result.back().text += utf8(letter.code);
            dx = 0.0;
            if (letter.dots == 0) continue;
            const char32_t sign = letter.dots == 1 ? 0x02D9 : 0x00A8;
            const FontFile::Glyph &below = font_.glyph(letter.code), &dot = font_.glyph(sign);
            const double rise = (below.top - dot.bottom) * size + dot_gap * em;
            const double lean = letter.italic ? double{italic_slant} * (dot.top * em + rise) : 0.0;
            const double back = (below.left + below.right) / 2.0 * size + lean - (dot.left + dot.right) / 2.0 * em -
                                below.advance * size;
            result.push_back({utf8(sign), false, 0, back, result.back().up + rise});
            dx = -back - dot.advance * em;
        }
        return result;
    }

    void write_spans(const std::vector<Span>& spans, double em) {
        double up = 0.0;
        for (const Span& span : spans) {
            std::string look;
            if (span.dx != 0.0) look += fmt::format(" dx=\"{}\"", number(span.dx));
            if (std::abs(span.up - up) > 1e-9) look += fmt::format(" dy=\"{}\"", number(up - span.up));
            if (span.script != 0) look += fmt::format(" font-size=\"{}\"", number(em * double{script_size}));
            if (span.italic) look += " font-style=\"italic\"";
            up = span.up;
            body_ += look.empty() ? xml_escaped(span.text)
                                  : fmt::format("<tspan{}>{}</tspan>", look, xml_escaped(span.text));
        }
    }

    static constexpr double dot_gap = 0.08;  // between a letter and its dots, as a fraction of the em

    const FontFile& font_;
    std::string prefix_;  // of the names of clip paths
    std::string body_;
    bool has_images_ = false;
    std::map<std::tuple<float, float, float, float>, std::string> clips_;
};

// The complete file around the written body.
std::string file_of(const SvgWriter& writer, const SvgSize& size, const Notes& notes) {
    const double height_mm = size.width_mm * size.height / size.width;
    const std::string extent = size.width_mm > 0.0
                                   ? fmt::format("width=\"{:.6g}mm\" height=\"{:.6g}mm\"", size.width_mm, height_mm)
                                   : fmt::format("width=\"{}\" height=\"{}\"", size.width, size.height);
    std::string text = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\"{} {} viewBox=\"0 0 {} {}\">\n",
        writer.has_images() ? " xmlns:xlink=\"http://www.w3.org/1999/xlink\"" : "", extent, size.width, size.height);
    for (const Note& note : notes)
        if (note.keyword == "Title") text += "<title>" + xml_escaped(note.text) + "</title>\n";
    text += xml_notes(notes);
    text += "<defs>\n" + writer.clips() + "</defs>\n";
    text +=
        "<g font-family=\"DejaVu Sans, Verdana, sans-serif\" fill=\"none\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\" xml:space=\"preserve\">\n";
    return text + writer.body() + "</g>\n</svg>\n";
}

Rectangle area_of(const SvgSize& size) {
    return {0.0F, 0.0F, static_cast<float>(size.width), static_cast<float>(size.height)};
}

}  // namespace

std::string svg(const Figure& figure, const SvgSize& size, const std::filesystem::path& fonts, const Notes& notes) {
    const FontFile font(fonts);
    const auto measure = [&font](const std::string& label, float size_of_it) { return font.width(label, size_of_it); };
    SvgWriter writer(font, size.prefix);
    for (const auto& item : layout(figure, measure, area_of(size), size.scale)) std::visit(writer, item);
    return file_of(writer, size, notes);
}

std::vector<PlotArea> plot_areas(const Figure& figure, const SvgSize& size, const std::filesystem::path& fonts) {
    const FontFile font(fonts);
    const auto measure = [&font](const std::string& label, float size_of_it) { return font.width(label, size_of_it); };
    return plot_areas(figure, measure, area_of(size), size.scale);
}

std::string svg(const Drawing& world, const Color& background, const SvgSize& size, const std::filesystem::path& fonts,
                const Notes& notes) {
    const FontFile font(fonts);
    SvgWriter writer(font, size.prefix);
    const Rectangle area = area_of(size);
    if (background.a > 0) writer(Fill{area, background});
    const Placement placement = place(world, area);
    for (const DrawnShape& shape : world.shapes) {
        if (shape.points.empty()) continue;
        if (shape.kind == DrawnShape::Kind::text) {
            const Point at = placement.pixel(shape.points.front());
            const auto high = static_cast<float>(world_text_size * size.scale);
            if (is_finite(at))
                writer(TextRun{static_cast<float>(at.x), static_cast<float>(at.y) - high / 2.0F, 0.5F, shape.text,
                               shape.stroke.color, high});
            continue;
        }
        const std::vector<Point> points = outline(shape, placement, area);
        const bool is_closed = shape.closed || shape.kind == DrawnShape::Kind::disc;
        if (shape.fill && is_closed) writer.fill(points, shape.fill_color, area);
        Stroke stroke = shape.stroke;
        stroke.width *= size.scale;
        for (double& length : stroke.dash) length *= size.scale;
        writer(Path{points, stroke, area});
    }
    return file_of(writer, size, notes);
}

Notes svg_notes(std::string_view text) { return xml_notes_of(text); }

}  // namespace achilles
