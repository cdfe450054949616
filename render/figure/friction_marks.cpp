#include "figure/mechanism_scene.hpp"

#include <algorithm>
#include <cmath>

#include "figure/body.hpp"
#include "output/contacts.hpp"

namespace achilles {

namespace {

Point moved(const Point& from, double way, const Point& along) {
    return {from.x + way * along.x, from.y + way * along.y};
}

// A color mixed with the background, nearly opaque: on a body the force in it remains visible.
Color tinted(const Color& color, const Color& background, double share) {
    const auto mixed = [&](std::uint8_t a, std::uint8_t b) {
        return static_cast<std::uint8_t>(std::lround(share * a + (1.0 - share) * b));
    };
    return {mixed(color.r, background.r), mixed(color.g, background.g), mixed(color.b, background.b), 225};
}

// The line of an arrow and its head, as long as `head` or a shorter arrow allows, with an edge around both.
void add_arrow(Drawing& drawing, const Point& from, const Point& to, double head, const Stroke& stroke,
               const Color& edge) {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const Point along{(to.x - from.x) / length, (to.y - from.y) / length}, aside{-along.y, along.x};
    const double size = std::min(head, 0.7 * length);
    const Point back = moved(to, -size, along);
    const std::vector<Point> corners{to, moved(back, 0.4 * size, aside), moved(back, -0.4 * size, aside)};
    for (const bool is_edge : {true, false}) {
        DrawnShape line, tip;
        line.points = {from, back};
        line.stroke = is_edge ? Stroke{edge, stroke.width + 2.5, {}} : stroke;
        tip.points = corners;
        tip.fill = tip.closed = true;
        tip.fill_color = tip.stroke.color = line.stroke.color;
        tip.stroke.width = is_edge ? 2.5 : 0.0;
        line.moves = tip.moves = true;
        drawing.shapes.insert(drawing.shapes.end(), {line, tip});
    }
}

}  // namespace

Point FrictionMarks::Mark::tip(double scale) const {
    return moved(moved(at, scale * pressing, normal), scale * friction, tangent);
}

FrictionMarks::FrictionMarks(const Mechanism& mechanism, const Trajectory& trajectory, const ContactGeometry& touch,
                             std::span<const Sample> samples)
    : model_(*trajectory.model),
      touch_(touch),
      grips_(mechanism.grips(trajectory.run.parameters)),
      forces_(model_, trajectory.run.parameters),
      cache_(model_, trajectory.run) {
    constexpr std::size_t wanted = 300;
    const std::size_t stride = 1 + samples.size() / wanted;
    for (std::size_t i = 0; i < samples.size(); i += stride)
        for (const Mark& mark : at(samples[i]))
            if (const double force = std::hypot(mark.pressing, mark.friction); std::isfinite(force))
                strongest_ = std::max(strongest_, force);
}

// The gap is k times a distance and the slip k times a velocity, so that both forces are multiplied by k
// (theory-friction.md 1). The point that meets the ground gives k, and the direction in which its slip is positive.
std::optional<FrictionMarks::Mark> FrictionMarks::of_contact(std::size_t contact, const Sample& now) {
    const auto tip = touch_.tip_of(contact);
    for (std::size_t i = 0; i < grips_.size(); ++i) {
        if (tip && i != *tip) continue;
        auto near = touch_.ground_below(grips_[i], contact, now.t, now.state);
        const bool is_drawn = near.has_value();
        if (!is_drawn) near = touch_.nearness(grips_[i], contact, now.t, now.state);
        const auto body = near ? Body::of(grips_[i], now.t, now.state) : std::nullopt;
        const auto along = body ? body->force(cache_.of(contact).at(now.state).g) : std::nullopt;
        if (!along) continue;
        const double k = std::hypot(along->x, along->y);
        Mark mark{contact, look_of(model_, ContactSet::of(contact), now.mode), near->foot, near->away, {}};
        // A gap that contains the radius of a disc is 0 where its rim meets the ground.
        if (!is_drawn) mark.at = moved(mark.at, -body->radius(), near->away);
        mark.tangent = {near->away.y, -near->away.x};
        mark.pressing = k * forces_.force(contact);
        if (!cache_.rough().contains(contact)) return mark;
        const Slip slip = cache_.slip(contact, now.state);
        const auto rates = body->rates(Vector::Zero(now.state.q.size()), mark.tangent);
        const double response = rates ? slip.d.dot(*rates) : 0.0;
        if (response == 0.0) return std::nullopt;
        if (response < 0.0) mark.tangent = {-mark.tangent.x, -mark.tangent.y};
        mark.friction = k * forces_.friction_force(contact);
        const double coefficient = mark.look == PhaseLook::stick ? slip.static_coefficient : slip.coefficient;
        if (!cache_.never_slides(contact)) mark.limit = coefficient * mark.pressing;
        return mark;
    }
    return std::nullopt;
}

// Only for a slip between points: a torque is no force at a point. The mark is at the lower edge of the body that it
// acts on.
std::optional<FrictionMarks::Mark> FrictionMarks::of_joint(std::size_t joint, const Sample& now) {
    const Slip slip = cache_.slip(joint, now.state);
    const auto& coordinates = model_.description().coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
        if (slip.d[static_cast<Eigen::Index>(i)] != 0.0 &&
            (coordinates[i].unit == "rad" || coordinates[i].unit == "deg"))
            return std::nullopt;
    for (AnchorPoint& grip : grips_) {
        const auto body = Body::of(grip, now.t, now.state);
        const auto along = body ? body->force(slip.d) : std::nullopt;
        const double k = along ? std::hypot(along->x, along->y) : 0.0;
        if (!(k > 0.0)) continue;
        Mark mark{
            joint, look_of(model_, ContactSet::of(joint), now.mode), body->at(), {}, {along->x / k, along->y / k}};
        mark.normal = {-mark.tangent.y, mark.tangent.x};
        if (mark.normal.y < 0.0) mark.normal = {-mark.normal.x, -mark.normal.y};
        mark.at = moved(mark.at, -body->radius(), mark.normal);
        mark.friction = k * forces_.friction_force(joint);
        mark.limit = k * (mark.look == PhaseLook::stick ? slip.static_coefficient : slip.coefficient);
        return mark;
    }
    return std::nullopt;
}

std::vector<FrictionMarks::Mark> FrictionMarks::at(const Sample& now) {
    Sample here = now;
    here.state.t = now.t;
    forces_.set(here);
    std::vector<Mark> marks;
    for (const std::size_t i : now.mode.held().with(now.mode.joints()))
        if (const auto mark = is_joint(i) ? of_joint(i, here) : of_contact(i, here)) marks.push_back(*mark);
    return marks;
}

// The whole force of a contact, and a little below the contact, or of a joint, its friction alone.
std::vector<FrictionMarks::ForceArrow> FrictionMarks::arrows_of(const Mark& mark, double side) const {
    constexpr double least = 0.02;  // fraction of the largest force: a shorter arrow is not drawn
    const double scale = longest * side / strongest_, below = 0.014 * side;
    std::vector<ForceArrow> arrows;
    if (!is_joint(mark.which) && std::hypot(mark.pressing, mark.friction) > least * strongest_)
        arrows.push_back({mark.which, mark.at, mark.tip(scale)});
    const Point foot = is_joint(mark.which) ? mark.at : moved(mark.at, -below, mark.normal);
    if (std::abs(mark.friction) > least * strongest_)
        arrows.push_back({mark.which, foot, moved(foot, scale * mark.friction, mark.tangent)});
    return arrows;
}

namespace {

double smaller_side(const Drawing& seen) { return std::min(seen.x_high - seen.x_low, seen.y_high - seen.y_low); }

}  // namespace

std::vector<FrictionMarks::ForceArrow> FrictionMarks::arrows(const Drawing& seen, const Sample& now) {
    std::vector<ForceArrow> all;
    if (!(strongest_ > 0.0)) return all;
    for (const Mark& mark : at(now))
        for (const ForceArrow& arrow : arrows_of(mark, smaller_side(seen))) all.push_back(arrow);
    return all;
}

void FrictionMarks::add(Drawing& drawing, const Sample& now, const Theme& theme) {
    if (!(strongest_ > 0.0)) return;
    const double side = smaller_side(drawing), scale = longest * side / strongest_, head = 0.022 * side;
    for (const Mark& mark : at(now)) {
        const Color color = phase_color(theme, mark.look);
        const Stroke stroke{color, 2.0, {}};
        if (mark.limit) {
            const Point base = moved(mark.at, scale * mark.pressing, mark.normal);
            DrawnShape& cone = drawing.shapes.emplace_back();
            cone.points = {moved(base, -scale * *mark.limit, mark.tangent),
                           moved(base, scale * *mark.limit, mark.tangent)};
            if (!is_joint(mark.which)) cone.points.push_back(mark.at);
            cone.fill = cone.closed = !is_joint(mark.which);
            cone.stroke = {color, is_joint(mark.which) ? 5.0 : 1.0, {}};
            cone.fill_color = tinted(color, theme.background, 0.3);
            if (is_joint(mark.which)) cone.stroke.color = tinted(color, theme.background, 0.5);
            cone.moves = true;
        }
        for (const ForceArrow& arrow : arrows_of(mark, side))
            add_arrow(drawing, arrow.from, arrow.to, head, stroke, theme.background);
    }
}

}  // namespace achilles
