#include "pictures/player_drawings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "paint/paint.hpp"
#include "surface/curves.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// The coordinate as it stands in the page. Nothing is drawn far outside of a picture.
long whole(double x) { return std::lround(std::clamp(x, -1e6, 1e6)); }

std::string list_of(const std::vector<long>& numbers) {
    std::string text = "[";
    for (const long number : numbers) text += fmt::format("{}{}", text.size() > 1 ? "," : "", number);
    return text + "]";
}

// The numbers of a shape without its breaks, and how many points each part between two breaks has.
struct ShapeParts {
    std::vector<long> numbers, counts;
};

double area_of(const std::vector<long>& numbers, std::size_t first, std::size_t count) {
    double twice = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t a = first + 2 * i, b = first + 2 * ((i + 1) % count);
        twice += static_cast<double>(numbers[a]) * static_cast<double>(numbers[b + 1]) -
                 static_cast<double>(numbers[b]) * static_cast<double>(numbers[a + 1]);
    }
    return 0.5 * twice;
}

// `thins`: points that are not seen, and polygons without an area, are left out.
ShapeParts parts_of(const DrawnShape& look, const ShapeNumbers& given, bool thins) {
    ShapeParts parts;
    if (look.kind == DrawnShape::Kind::disc) {
        for (const double x : given) parts.numbers.push_back(std::isfinite(x) ? whole(x) : 0);
        return parts;
    }
    std::vector<Point> points;
    for (std::size_t i = 0; i + 1 < given.size(); i += 2) points.push_back({given[i], given[i + 1]});
    const bool is_area = look.kind == DrawnShape::Kind::area;
    if (thins && look.kind == DrawnShape::Kind::polyline) points = thinned(points, 1.0);
    points.push_back(break_of_curve);
    std::size_t first = 0;
    for (const Point& p : points) {
        if (std::isfinite(p.x) && std::isfinite(p.y)) {
            parts.numbers.insert(parts.numbers.end(), {whole(p.x), whole(p.y)});
            continue;
        }
        const std::size_t count = (parts.numbers.size() - first) / 2;
        if (thins && is_area && area_of(parts.numbers, first, count) == 0.0)
            parts.numbers.resize(first);
        else if (count > 0)
            parts.counts.push_back(static_cast<long>(count));
        first = parts.numbers.size();
    }
    return parts;
}

std::string css_color(const Color& c) { return fmt::format("#{:02x}{:02x}{:02x}{:02x}", c.r, c.g, c.b, c.a); }

// The rules of a shape in one theme.
std::string rules_of(const DrawnShape& shape) {
    if (shape.kind == DrawnShape::Kind::text) return "fill:" + css_color(shape.stroke.color);
    const bool is_area = shape.kind == DrawnShape::Kind::area;
    const bool is_filled = is_area || (shape.fill && (shape.closed || shape.kind == DrawnShape::Kind::disc));
    std::string rules = "fill:" + (is_filled ? css_color(shape.fill_color) : "none");
    if (is_area || !(shape.stroke.width > 0.0)) return rules;
    rules += fmt::format(";stroke:{};stroke-width:{:.4g}", css_color(shape.stroke.color), shape.stroke.width);
    for (std::size_t i = 0; i < shape.stroke.dash.size(); ++i)
        rules += fmt::format("{}{:.4g}", i == 0 ? ";stroke-dasharray:" : ",", shape.stroke.dash[i]);
    return rules;
}

// A moving curve as a fixed number of points at equal distances along it. The file's curves are drawn with a number of
// points that changes as they move, so that they could not be interpolated.
std::vector<Point> evenly_spaced(const std::vector<Point>& points) {
    constexpr std::size_t most = 160;
    if (points.size() <= most ||
        !std::all_of(points.begin(), points.end(), [](const Point& p) { return std::isfinite(p.x + p.y); }))
        return points;
    std::vector<double> lengths{0.0};
    for (std::size_t i = 1; i < points.size(); ++i)
        lengths.push_back(lengths.back() + std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y));
    std::vector<Point> made;
    for (std::size_t k = 0, i = 1; k < most; ++k) {
        const double length = lengths.back() * static_cast<double>(k) / static_cast<double>(most - 1);
        while (i + 1 < points.size() && lengths[i] < length) ++i;
        const double step = lengths[i] - lengths[i - 1];
        const double share = step > 0.0 ? std::min((length - lengths[i - 1]) / step, 1.0) : 0.0;
        made.push_back({points[i - 1].x + share * (points[i].x - points[i - 1].x),
                        points[i - 1].y + share * (points[i].y - points[i - 1].y)});
    }
    return made;
}

// 1, 2 or 5 times a power of ten, at most x.
double round_factor(double x) { return round_length(x > 0.0 && std::isfinite(x) ? x : 1.0); }

}  // namespace

std::string json_text(std::string_view text) {
    std::string result = "\"";
    for (const char c : printable(text)) {
        const bool is_plain =
            static_cast<unsigned char>(c) >= 0x20 && std::string_view("\"\\<>&").find(c) == std::string_view::npos;
        result += is_plain ? std::string(1, c) : fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    }
    return result + "\"";
}

PlayerDrawings::PlayerDrawings(const Trajectory& trajectory)
    : trajectory_(trajectory),
      samples_(plot_samples(trajectory)),
      mechanism_(*trajectory.model),
      stage_(mechanism_, trajectory, samples_) {
    const Drawing& limits = stage_.limits();
    const double shape = (limits.x_high - limits.x_low) / (limits.y_high - limits.y_low);
    constexpr double lowest = 300.0, highest = 640.0, beside = 0.02;
    height_ = std::round(std::clamp(width_ / shape, lowest, highest));
    seen_ = widened(limits, width_, height_);
    // A margin shows the continuation of the ground.
    const double margin = beside * (seen_.x_high - seen_.x_low);
    seen_.x_low -= margin, seen_.x_high += margin;
    seen_.y_low -= margin * height_ / width_, seen_.y_high += margin * height_ / width_;
    const Placement placement =
        place(seen_, {0.0F, 0.0F, static_cast<float>(fineness * width_), static_cast<float>(fineness * height_)});
    origin_ = {placement.x, placement.y};
    unit_ = placement.unit;
}

void PlayerDrawings::add_plot(const ViewDescription& view, const Panel& panel, const Rectangle& inner) {
    plots_.push_back(std::make_unique<PlotDots>(trajectory_, view, panel, inner));
}

DrawnShape PlayerDrawings::on_page(DrawnShape shape) const {
    if (shape.moves && shape.kind == DrawnShape::Kind::polyline) shape.points = evenly_spaced(shape.points);
    for (Point& p : shape.points) p = {origin_.x + unit_ * p.x, origin_.y - unit_ * p.y};
    shape.radius *= unit_;
    return shape;
}

// A bar at the present time and a dot on every curve.
void PlayerDrawings::add_dots(std::vector<PictureShape>& shapes, std::size_t plot, const Sample& now,
                              const Theme& theme) {
    PlotDots& dots = *plots_[plot];
    const std::size_t picture = plot + (has_mechanism() ? 1 : 0);
    const Rectangle& r = dots.inner;
    dots.values.set(now);
    const auto& quantities = dots.view.quantities();
    const auto pixel = [&](std::size_t i) { return dots.map({dots.values[0], dots.values[i]}); };
    if (const double x = dots.map.x(dots.values[0]); quantities[0].is_time && std::isfinite(x)) {
        DrawnShape bar;
        bar.stroke = {theme.surface, 1.0, {}};
        bar.moves = true;
        bar.points = {{fineness * x, fineness * double{r.y}}, {fineness * x, fineness * double{r.y + r.height}}};
        shapes.push_back(picture_shape(picture, bar));
    }
    for (std::size_t i = 1; i < quantities.size(); ++i) {
        const Point p = pixel(i);
        constexpr double slack = 1.0;
        if (!(p.x >= double{r.x} - slack && p.x <= double{r.x + r.width} + slack && p.y >= double{r.y} - slack &&
              p.y <= double{r.y + r.height} + slack))
            continue;  // also where there is no value
        DrawnShape dot;
        dot.kind = DrawnShape::Kind::disc;
        dot.moves = dot.fill = true;
        dot.fill_color = theme.body;
        dot.stroke = {theme.background, 1.0, {}};
        dot.radius = 4.5 * fineness;
        dot.points = {{fineness * p.x, fineness * p.y}};
        shapes.push_back(picture_shape(picture, dot));
    }
}

std::vector<PictureShape> PlayerDrawings::shapes_at(const Sample& now, const Theme& theme) {
    std::vector<PictureShape> shapes;
    if (has_mechanism()) {
        Layers layers;
        layers.way = false;
        for (const DrawnShape& shape : stage_.draw(now, seen_, theme, layers).shapes)
            shapes.push_back(picture_shape(0, on_page(shape)));
    }
    for (std::size_t i = 0; i < plots_.size(); ++i) add_dots(shapes, i, now, theme);
    return shapes;
}

PlayerDrawings::Written PlayerDrawings::write() {
    constexpr double finest = 0.25 * fineness, coarsest = 8.0 * fineness;
    constexpr std::size_t max_size = 3'000'000;
    const Keyframes keyframes(
        trajectory_, [this](const Sample& now, const Theme& theme) { return shapes_at(now, theme); }, finest);
    Written page;
    for (page.tolerance = finest; page.json.empty() || (page.json.size() > max_size && page.tolerance < coarsest);
         page.tolerance *= 2.0) {
        shapes_.clear(), shape_list_.clear(), looks_.clear(), light_.clear(), dark_.clear();
        page.json = written(keyframes.clips(page.tolerance));
    }
    page.tolerance /= 2.0 * fineness;
    for (const PhaseLook each : phase_looks) {
        const auto rule = [&](const Theme& theme) {
            return fmt::format(".p{}{{color:{}}}\n", static_cast<int>(each), css_color(phase_color(theme, each)));
        };
        light_ += rule(light_theme()), dark_ += rule(dark_theme());
    }
    page.css = light_ + "@media screen and (prefers-color-scheme: dark) {\n" + dark_ + "}\n";
    return page;
}

std::string PlayerDrawings::written(const std::vector<MotionClip>& clips) {
    const double start = trajectory_.run.options.start_time, end = trajectory_.end_time, duration = end - start;
    constexpr double shortest = 1.5, longest = 60.0, usual = 20.0;  // s, of watching a run
    const double speed = duration >= shortest && duration <= longest ? 1.0 : round_factor(duration / usual);
    const int digits = std::clamp(static_cast<int>(std::ceil(2.0 - std::log10(speed) - 1e-9)), 0, 12);
    std::string all;
    for (const MotionClip& clip : clips) all += (all.empty() ? "\n" : ",\n") + written(clip);
    const std::string trail = written_trail();
    std::string shapes;
    for (const std::string& shape : shape_list_) shapes += (shapes.empty() ? "\n" : ",\n") + shape;
    return fmt::format(
        "{{\"start\":{},\"end\":{},\"speed\":{},\"digits\":{},\"world\":{},\"map\":[{},{},{}],\n\"trail\":[{}],\n"
        "\"shapes\":[{}],\n\"clips\":[{}]}}",
        start, end, speed, digits, has_mechanism() ? 0 : -1, origin_.x, origin_.y, unit_, trail, shapes, all);
}

// A clip: its instants, what the phase is called, and its shapes in painting order. A shape that is still is its number; one
// that moves has its numbers as differences from instant to instant; a stepped one has them as they are, with its parts.
std::string PlayerDrawings::written(const MotionClip& clip) {
    const double duration = trajectory_.end_time - trajectory_.run.options.start_time;
    const int digits = std::clamp(static_cast<int>(std::ceil(9.0 - std::log10(std::max(duration, 1e-9)))), 0, 17);
    std::string times, shapes;
    // Rounded down, so that at the time of an event the page shows what follows it.
    const double fine = std::pow(10.0, digits);
    for (const double t : clip.times)
        times += fmt::format("{}{:.{}f}", times.empty() ? "" : ",", std::floor(t * fine) / fine, digits);
    std::map<std::string, std::size_t> copies;
    for (const MotionClip::ClipShape& shape : clip.shapes) {
        const bool is_stepped = shape.course == MotionClip::Course::stepped;
        std::vector<ShapeParts> instants;
        for (const auto& numbers : shape.numbers)
            instants.push_back(parts_of(shape.look, *numbers, shape.course != MotionClip::Course::smooth));
        const bool is_still = std::all_of(instants.begin(), instants.end(), [&](const ShapeParts& other) {
            return other.numbers == instants[0].numbers && other.counts == instants[0].counts;
        });
        const bool is_disc = shape.look.kind == DrawnShape::Kind::disc;
        const bool is_text = shape.look.kind == DrawnShape::Kind::text;
        std::string json = fmt::format("{{\"in\":{},\"kind\":\"{}\",\"look\":\"{}\"", shape.picture,
                                       is_disc   ? "circle"
                                       : is_text ? "text"
                                                 : "path",
                                       look(shape.look, shape.dark));
        if (is_text) json += ",\"text\":" + json_text(shape.look.text);
        if (shape.look.closed || shape.look.kind == DrawnShape::Kind::area) json += ",\"closed\":true";
        if (shape.look.moves) json += ",\"moves\":true";
        if (!is_disc && !is_text && (is_still || !is_stepped)) json += ",\"counts\":" + list_of(instants[0].counts);
        if (is_still) json += ",\"numbers\":" + list_of(instants[0].numbers);
        const std::size_t number = shape_number(json + "}", copies[json]++);
        shapes += shapes.empty() ? "" : ",";
        if (is_still) {
            shapes += fmt::format("{}", number);
        } else if (is_stepped) {
            std::string all;
            for (const ShapeParts& now : instants)
                all += fmt::format("{}[{},{}]", all.empty() ? "" : ",", list_of(now.counts), list_of(now.numbers));
            shapes += fmt::format("[{},[{}]]", number, all);
        } else {
            std::vector<long> differences = instants[0].numbers;
            for (std::size_t k = 1; k < instants.size(); ++k)
                for (std::size_t i = 0; i < instants[k].numbers.size(); ++i)
                    differences.push_back(instants[k].numbers[i] - instants[k - 1].numbers[i]);
            shapes += fmt::format("[{},{}]", number, list_of(differences));
        }
    }
    return fmt::format("{{\"phase\":{},\"look\":\"p{}\",\"t\":[{}],\"shapes\":[{}]}}", json_text(clip.phase.text),
                       static_cast<int>(clip.phase.color), times, shapes);
}

// The trail of the body in pieces of one look, each in two looks: still to come, and passed.
std::string PlayerDrawings::written_trail() {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (!has_mechanism()) return "";
    const std::vector<WayPoint>& way = stage_.trail().way;
    std::vector<double> times;
    for (const WayPoint& point : way)
        if (std::isfinite(point.at.x) && std::isfinite(point.at.y)) times.push_back(point.t);
    const auto lines = [&](double t, const Theme& theme) {
        std::vector<DrawnShape> made;
        add_body_trail(made, way, t, theme);
        return made;
    };
    const auto future = lines(-never, light_theme()), future_dark = lines(-never, dark_theme()),
               past = lines(never, light_theme()), past_dark = lines(never, dark_theme());
    std::string text;
    std::size_t first = 0;
    for (std::size_t k = 0; k < past.size(); ++k) {
        std::vector<long> numbers;
        std::string instants;
        const std::vector<Point> points = on_page(past[k]).points;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point& p = points[i];
            numbers.insert(numbers.end(), {whole(p.x), whole(p.y)});
            instants += fmt::format("{}{:.9g}", instants.empty() ? "" : ",", times.at(first + i));
        }
        first += points.size();
        text += fmt::format("{}{{\"future\":\"{}\",\"past\":\"{}\",\"t\":[{}],\"numbers\":{}}}",
                            text.empty() ? "\n" : ",\n", look(future[k], future_dark[k]), look(past[k], past_dark[k]),
                            instants, list_of(numbers));
    }
    return text;
}

// The class of a shape, by its rules in both themes.
std::string PlayerDrawings::look(const DrawnShape& light, const DrawnShape& dark) {
    const std::string in_light = rules_of(light), in_dark = rules_of(dark);
    const auto [at, is_new] = looks_.emplace(in_light + "|" + in_dark, looks_.size());
    const std::string name = fmt::format("s{}", at->second);
    if (is_new) {
        light_ += fmt::format(".{}{{{}}}\n", name, in_light);
        dark_ += fmt::format(".{}{{{}}}\n", name, in_dark);
    }
    return name;
}

// `copy`: the number of equal shapes before it in the same clip, each of which is an element of its own.
std::size_t PlayerDrawings::shape_number(const std::string& json, std::size_t copy) {
    const auto [at, is_new] = shapes_.emplace(std::pair{json, copy}, shape_list_.size());
    if (is_new) shape_list_.push_back(json);
    return at->second;
}

}  // namespace achilles
