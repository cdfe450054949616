#include "paint/svg.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "figure/publication.hpp"
#include "image/notes.hpp"
#include "model/read_system.hpp"
#include "paint/paint.hpp"
#include "render/samples.hpp"
#include "render/support.hpp"
#include "simulate/simulate.hpp"

namespace achilles {
namespace {

const std::filesystem::path fonts = ACHILLES_BINARY_DIR "/assets/fonts";

const Notes quoted_notes{{"Title", "θ & <friends>"}, {"Achilles Command", "achilles figure 'a \"b\".toml'\r\n\t]]>"}};

std::string sample(int panels = 4) { return svg(samples::figure(panels), {900, 600, 1.0}, fonts, quoted_notes); }

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

// Writes a text to a file. Returns the exit status of a shell command in which %s stands for its name.
int status_of(const std::string& command, const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    std::string full = command;
    for (std::size_t at = full.find("%s"); at != std::string::npos; at = full.find("%s"))
        full.replace(at, 2, file.string());
    const int status = std::system(full.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Svg, IsValidXml) {
    const auto file = std::filesystem::path(testing::TempDir()) / "achilles_valid.svg";
    EXPECT_EQ(status_of("xmllint --noout %s", file, sample()), 0);
    EXPECT_NE(status_of("xmllint --noout %s 2>/dev/null", file, sample().substr(0, 20000)), 0);
    std::filesystem::remove(file);
}

TEST(Svg, HasTextAsText) {
    const std::string text = sample();
    // Theta with its index, lowered by 0.13 of the line height and at 0.72 of its size.
    EXPECT_NE(text.find(">θ<tspan dy=\"1.82\" font-size=\"8.66\">1</tspan><tspan dy=\"-1.82\"> [°]</tspan></text>"),
              std::string::npos);
    // A separate dot above theta, and the way back.
    EXPECT_NE(text.find(">θ<tspan dx=\""), std::string::npos);
    EXPECT_EQ(count(text, "˙"), 1u);
    EXPECT_EQ(count(text, "¨"), 1u);
    EXPECT_EQ(count(text, "<text "), count(text, "</text>"));
    EXPECT_NE(text.find("stroke-dasharray=\"5,6\""), std::string::npos);  // 7 on, 4 off, at width 2 with round ends
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_EQ(text.find("inf"), std::string::npos);
}

TEST(Svg, KeepsCurvesWithinAHundredthAndSmall) {
    Figure figure = samples::figure(1);
    Curve& curve = figure.panels[0].curves[0];
    curve.points.clear();
    for (int i = 0; i <= 200000; ++i) curve.points.push_back({i * 2.5e-5, 1.0 + std::sin(i * 1e-4)});
    EXPECT_LT(svg(figure, {900, 600, 1.0}, fonts, {}).size(), 30000u);
}

// The figure without words: glyphs are rasterized differently, which alone scores 0.16. The words are tested above.
Figure without_words(Figure figure) {
    for (Panel& panel : figure.panels) {
        panel.title.clear();
        for (Axis* axis : {&panel.x, &panel.y}) {
            axis->label.clear();
            for (Tick& tick : axis->ticks) tick.label.clear();
        }
        for (Curve& curve : panel.curves) curve.label.clear();
        for (Markers& markers : panel.markers) markers.label.clear();
        for (TimeBar& bar : panel.time_bars) bar.label.clear();
    }
    figure.keys.clear();
    return figure;
}

// librsvg renders the same picture as our painter.
TEST(Svg, LooksLikeThePng) {
    const auto file = std::filesystem::path(testing::TempDir()) / "achilles_look.svg";
    const auto rendered = [&](const Figure& figure) {
        const std::string text = svg(figure, {900, 600, 1.0}, fonts, {});
        EXPECT_EQ(status_of("rsvg-convert %s -o %s.png", file, text), 0);
        return read_png(file.string() + ".png");
    };
    SurfaceOptions options = support::options(900, 600);
    options.curve_fineness = 2;
    Offscreen surface(options);
    for (const int panels : {1, 2, 4}) {
        const Figure figure = without_words(samples::figure(panels));
        const Image ours = surface.frame([&] { paint(figure, ImGui::GetBackgroundDrawList(), {0, 0, 900, 600}); });
        const double distance = worst_tile(rendered(figure), ours);
        EXPECT_LT(distance, 0.015) << panels;
        Figure lie = figure;
        for (Point& p : lie.panels[0].curves[0].points) p.y += 0.01;
        EXPECT_GT(worst_tile(rendered(lie), ours), 0.02) << panels;
    }
    std::filesystem::remove(file);
    std::filesystem::remove(file.string() + ".png");
}

// The figures of all systems of the gallery: valid SVG with words, and the same picture without them.
TEST(Svg, OfTheGalleryIsValidAndLooksLikeThePng) {
    const auto file = std::filesystem::path(testing::TempDir()) / "achilles_gallery.svg";
    SurfaceOptions options = support::options(1200, 800, publication_scale);
    options.curve_fineness = 2;
    Offscreen surface(options);
    int systems = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ACHILLES_SOURCE_DIR "/assets/systems")) {
        const auto model = std::make_shared<const Model>(read_system(entry.path()));
        const Trajectory trajectory = simulate(model, model->default_run());
        const Figure figure = publication(trajectory, model->description().views, {});
        const auto as_svg = [&](const Figure& f) { return svg(f, {1200, 800, publication_scale}, fonts, {}); };
        EXPECT_EQ(status_of("xmllint --noout %s", file, as_svg(figure)), 0) << entry.path();
        // In curves of many thousand pixels, the phase of the dashes depends on how finely the curves are thinned.
        Figure bare = without_words(figure);
        for (Panel& panel : bare.panels)
            for (Curve& curve : panel.curves) curve.stroke.dash.clear();
        ASSERT_EQ(status_of("rsvg-convert %s -o %s.png", file, as_svg(bare)), 0);
        const Image ours = surface.frame([&] {
            paint(bare, ImGui::GetBackgroundDrawList(), {0, 0, 1200, 800}, publication_scale);
        });
        EXPECT_LT(worst_tile(read_png(file.string() + ".png"), ours), 0.015) << entry.path();
        ++systems;
    }
    EXPECT_GE(systems, 15);
    std::filesystem::remove(file);
    std::filesystem::remove(file.string() + ".png");
}

// Bounding box of the points of a path: left, top, right, bottom.
std::array<double, 4> box_of(const std::string& path) {
    std::array<double, 4> box{1e9, 1e9, -1e9, -1e9};
    for (std::size_t at = path.find('M') + 1; path[at] != 'Z'; at = path.find(' ', at) + 1) {
        const double x = std::stod(path.substr(at)), y = std::stod(path.substr(path.find(',', at) + 1));
        box = {std::min(box[0], x), std::min(box[1], y), std::max(box[2], x), std::max(box[3], y)};
    }
    return box;
}

// A release and an impact exactly at the ends of an axis are neither clipped nor crossed by the box, in SVG and pixels.
TEST(Svg, EventsAtTheEndsOfAnAxisAreDrawnWhole) {
    const auto model =
        std::make_shared<const Model>(read_system(ACHILLES_SOURCE_DIR "/assets/systems/ball_on_sine.toml"));
    const Trajectory trajectory = simulate(model, model->default_run());
    const auto release = std::find_if(trajectory.events.begin(), trajectory.events.end(),
                                      [](const Event& event) { return event.kind == Event::Kind::release; });
    const auto impact = std::next(release);
    ASSERT_EQ(impact->kind, Event::Kind::impact);
    ViewDescription height;
    height.x.text = "t";
    height.y.emplace_back().text = "y";
    const auto figure_from = [&](double from, double to) {
        Framing framing;
        framing.for_print = true;
        framing.x = {from, to};
        return publication(
            trajectory,
            {compose(trajectory, plot_samples(trajectory), PreparedView(*model, height), light_theme(), framing)}, {});
    };
    const Figure at_ends = figure_from(release->t, impact->t);
    const double span = impact->t - release->t;
    const Figure inside = figure_from(release->t - 0.3 * span, impact->t + 0.3 * span);

    // SVG: outside every clipping group, and on both sides of the end of the axis.
    std::istringstream lines(svg(at_ends, {600, 400, 1.4}, fonts, {}));
    const Color green = event_markers(light_theme(), Event::Kind::release).fill;
    const std::string fill = fmt::format("fill=\"#{:02x}{:02x}{:02x}\"", green.r, green.g, green.b);
    int triangles = 0;
    bool clipped = false;
    double left = 0.0;                                             // of the axes
    const std::string area = "<clipPath id=\"plot3\"><rect x=\"";  // after those of two legend entries
    for (std::string line; std::getline(lines, line);) {
        clipped = line.starts_with("<g clip-path") || (clipped && line != "</g>");
        if (const std::size_t at = line.find(area); at != std::string::npos)
            left = std::stod(line.substr(at + area.size()));
        if (line.find(fill) == std::string::npos || !line.starts_with("<path") || line.find("Z\"") == std::string::npos)
            continue;
        const auto box = box_of(line);
        if (box[1] < 50.0) continue;  // in the legend
        EXPECT_FALSE(clipped);
        EXPECT_NEAR(0.5 * (box[0] + box[2]), left, 0.5) << line;
        EXPECT_NEAR(box[2] - box[0], 2.0 * 9.0 * 1.4 * 0.68 * std::sin(std::acos(-1.0) / 3.0), 0.02) << line;
        ++triangles;
    }
    EXPECT_EQ(triangles, 1);

    // Pixels: as many in their colors as for isolated events.
    SurfaceOptions options = support::options(600, 400, 1.4);
    options.curve_fineness = 2;
    Offscreen surface(options);
    const auto pixels_of = [&](const Figure& figure) {
        const Image image = surface.frame([&] {
            paint(figure, ImGui::GetBackgroundDrawList(), {0, 0, 600, 400}, 1.4);
        });
        int found = 0;
        for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
            const bool is_green = image.rgb[i] == green.r && image.rgb[i + 1] == green.g && image.rgb[i + 2] == green.b;
            found += is_green && i / 3 / 600 > 50 ? 1 : 0;
        }
        return found;
    };
    const int whole = pixels_of(inside), there = pixels_of(at_ends);
    EXPECT_GT(whole, 40);
    EXPECT_NEAR(there, whole, 0.1 * whole);
}

// At page size no label is shortened.
TEST(Svg, LabelsOfTheGalleryAreWhole) {
    for (const auto& entry : std::filesystem::directory_iterator(ACHILLES_SOURCE_DIR "/assets/systems")) {
        const auto model = std::make_shared<const Model>(read_system(entry.path()));
        const Figure figure = publication(simulate(model, model->default_run()), model->description().views, {});
        EXPECT_EQ(svg(figure, {1200, 800, publication_scale}, fonts, {}).find("\u2026"), std::string::npos)
            << entry.path();
        for (const Panel& panel : figure.panels)
            EXPECT_NE(panel.y.label.find(" ("), std::string::npos) << entry.path() << panel.title << ": no unit";
    }
}

TEST(Svg, CarriesNotes) {
    EXPECT_EQ(svg_notes(sample()), quoted_notes);
    EXPECT_TRUE(svg_notes("<svg/>").empty());
    EXPECT_TRUE(svg_notes("").empty());
    for (const char* text : {"a\x01", "\xff", "\xed\xa0\x80", "\xc0\x80"})
        EXPECT_THROW(xml_escaped(text), std::runtime_error) << text;
}

TEST(Svg, DamagedNotesAreRefusedWhereverTheyEnd) {
    const std::string whole = xml_notes(quoted_notes);
    const std::size_t first_line = whole.find('\n') + 1;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        if (size < first_line)
            EXPECT_TRUE(xml_notes_of(whole.substr(0, size)).empty()) << size;
        else
            EXPECT_THROW(xml_notes_of(whole.substr(0, size)), std::runtime_error) << size;
    }
    std::string unknown = whole;
    unknown.replace(unknown.find("&amp;"), 5, "&bad;");
    EXPECT_THROW(xml_notes_of(unknown), std::runtime_error);
}

TEST(Svg, SurvivesFiguresThatMakeNoSense) {
    Figure nothing, empty = samples::figure(2);
    nothing.columns = 0;
    empty.panels[0].x.low = empty.panels[0].x.high = 1.0;
    empty.panels[1].y.low = std::numeric_limits<double>::quiet_NaN();
    for (const Figure& figure : {nothing, empty, samples::figure(6)})
        for (const int size : {1, 60, 300})
            EXPECT_EQ(svg(figure, {size, size, 1.0}, fonts, {}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace achilles
