#include "surface/damage.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>

#include "surface/imgui_version.hpp"

namespace achilles {

namespace {

using DrawnCommand = DrawnFrame::DrawnCommand;
using DrawnList = DrawnFrame::DrawnList;

constexpr std::size_t triangle_bytes = 3 * sizeof(ImDrawVert);

bool is_empty(const PixelArea& area) { return area.width <= 0 || area.height <= 0; }

// The smallest area of whole pixels with all these vertices, and a pixel around it.
PixelArea area_of(std::span<const unsigned char> vertices) {
    float x_low = 1e9F, y_low = 1e9F, x_high = -1e9F, y_high = -1e9F;
    for (std::size_t at = 0; at + sizeof(ImDrawVert) <= vertices.size(); at += sizeof(ImDrawVert)) {
        ImDrawVert vertex;
        std::memcpy(&vertex, &vertices[at], sizeof vertex);
        x_low = std::min(x_low, vertex.pos.x), x_high = std::max(x_high, vertex.pos.x);
        y_low = std::min(y_low, vertex.pos.y), y_high = std::max(y_high, vertex.pos.y);
    }
    if (!(x_low <= x_high)) return {};
    const auto whole = [](float x) { return static_cast<int>(std::clamp(x, -1e6F, 1e6F)); };
    const int x = whole(std::floor(x_low) - 1.0F), y = whole(std::floor(y_low) - 1.0F);
    return {x, y, whole(std::ceil(x_high) + 1.0F) - x, whole(std::ceil(y_high) + 1.0F) - y};
}

DrawnCommand drawn_command(const ImDrawList& list, const ImDrawCmd& command) {
    const ImVec4& clip = command.ClipRect;
    DrawnCommand drawn{{clip.x, clip.y, clip.z, clip.w}, clip_of(command), {}, 0, DrawnCommand::Kind::other, {}};
    drawn.area = drawn.inside;
    if (const std::span<const unsigned char> content = curve_or_tiles(list, command, drawn.area); !content.empty()) {
        drawn.kind = is_curve(command) ? DrawnCommand::Kind::curve : DrawnCommand::Kind::tiles;
        drawn.content.assign(content.begin(), content.end());
    } else if (command.UserCallback == nullptr) {
        drawn.kind = DrawnCommand::Kind::triangles;
        drawn.texture = texture_of(command);
        drawn.content.resize(command.ElemCount * sizeof(ImDrawVert));
        for (unsigned i = 0; i < command.ElemCount; ++i) {
            const ImDrawIdx index = list.IdxBuffer[static_cast<int>(command.IdxOffset + i)];
            std::memcpy(&drawn.content[i * sizeof(ImDrawVert)],
                        &list.VtxBuffer[static_cast<int>(command.VtxOffset + index)], sizeof(ImDrawVert));
        }
        drawn.area = common(area_of(drawn.content), drawn.inside);
    }
    return drawn;
}

bool have_same_state(const DrawnCommand& a, const DrawnCommand& b) {
    return a.kind == b.kind && a.texture == b.texture && a.clip == b.clip;
}

bool are_same(const DrawnCommand& a, const DrawnCommand& b) {
    return a.kind != DrawnCommand::Kind::other && have_same_state(a, b) && a.content == b.content;
}

void add_area(std::vector<PixelArea>& areas, const PixelArea& area) {
    if (!is_empty(area)) areas.push_back(area);
}

// The part of two commands between their common first and their common last triangles.
void add_triangles(const DrawnCommand& a, const DrawnCommand& b, std::vector<PixelArea>& areas) {
    const std::size_t least = std::min(a.content.size(), b.content.size()) / triangle_bytes;
    const auto same = [&](std::size_t in_a, std::size_t in_b) {
        return std::memcmp(&a.content[in_a], &b.content[in_b], triangle_bytes) == 0;
    };
    std::size_t first = 0, last = 0;
    while (first < least && same(first * triangle_bytes, first * triangle_bytes)) ++first;
    while (first + last < least &&
           same(a.content.size() - (last + 1) * triangle_bytes, b.content.size() - (last + 1) * triangle_bytes))
        ++last;
    for (const DrawnCommand* one : {&a, &b}) {
        const std::span<const unsigned char> all(one->content);
        add_area(areas,
                 common(area_of(all.subspan(first * triangle_bytes, all.size() - (first + last) * triangle_bytes)),
                        one->inside));
    }
}

// What differs between two lists: from their first to their last commands that do.
void add_differences(const DrawnList& a, const DrawnList& b, std::vector<PixelArea>& areas) {
    const std::size_t least = std::min(a.commands.size(), b.commands.size());
    std::size_t first = 0, last = 0;
    while (first < least && are_same(a.commands[first], b.commands[first])) ++first;
    while (first + last < least &&
           are_same(a.commands[a.commands.size() - 1 - last], b.commands[b.commands.size() - 1 - last]))
        ++last;
    const bool are_pairs = a.commands.size() == b.commands.size();
    for (std::size_t i = first; i < std::max(a.commands.size(), b.commands.size()) - last; ++i) {
        const DrawnCommand* const in_a = i + last < a.commands.size() ? &a.commands[i] : nullptr;
        const DrawnCommand* const in_b = i + last < b.commands.size() ? &b.commands[i] : nullptr;
        if (are_pairs && are_same(*in_a, *in_b)) continue;
        if (are_pairs && in_a->kind == DrawnCommand::Kind::triangles && have_same_state(*in_a, *in_b)) {
            add_triangles(*in_a, *in_b, areas);
            continue;
        }
        for (const DrawnCommand* one : {in_a, in_b})
            if (one != nullptr) add_area(areas, one->area);
    }
}

double size_of_area(const PixelArea& area) { return double{1.0} * area.width * area.height; }

// Joins areas until none overlaps another and there are few: first those whose common rectangle is hardly larger.
void join(std::vector<PixelArea>& areas) {
    constexpr std::size_t most = 12, too_many = 100;
    while (areas.size() > too_many) {
        areas.front() = around(areas.front(), areas.back());
        areas.pop_back();
    }
    for (;;) {
        std::size_t first = 0, second = 0;
        double least = 0.0;
        for (std::size_t i = 0; i < areas.size(); ++i)
            for (std::size_t k = i + 1; k < areas.size(); ++k) {
                const bool overlap = !is_empty(common(areas[i], areas[k]));
                if (!overlap && areas.size() <= most) continue;
                const double more =
                    size_of_area(around(areas[i], areas[k])) - size_of_area(areas[i]) - size_of_area(areas[k]);
                if (second == 0 || more < least) first = i, second = k, least = more;
            }
        if (second == 0) return;
        areas[first] = around(areas[first], areas[second]);
        areas.erase(areas.begin() + static_cast<std::ptrdiff_t>(second));
    }
}

}  // namespace

DrawnFrame::DrawnFrame(const ImDrawData& data) {
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        DrawnList& drawn = lists_.emplace_back();
        drawn.name = list._OwnerName == nullptr ? "" : list._OwnerName;
        for (const ImDrawCmd& command : list.CmdBuffer) drawn.commands.push_back(drawn_command(list, command));
    }
}

std::vector<PixelArea> DrawnFrame::differences(const DrawnFrame& before, int width, int height) const {
    const PixelArea all{0, 0, width, height};
    std::vector<PixelArea> areas;
    // Lists in one of the frames only, such as a tooltip, lie between those in both.
    const auto is_in = [](const DrawnFrame& frame, const DrawnList& list) {
        return std::any_of(frame.lists_.begin(), frame.lists_.end(),
                           [&](const DrawnList& other) { return other.name == list.name; });
    };
    const auto add_alone = [&](const DrawnList& list) {
        for (const DrawnCommand& command : list.commands) add_area(areas, command.area);
    };
    auto old = before.lists_.begin();
    const auto skip_alone = [&] {
        for (; old != before.lists_.end() && !is_in(*this, *old); ++old) add_alone(*old);
    };
    for (const DrawnList& list : lists_) {
        skip_alone();
        if (!is_in(before, list)) {
            add_alone(list);
            continue;
        }
        if (old == before.lists_.end() || old->name != list.name) return {all};
        add_differences(*old++, list, areas);
    }
    skip_alone();
    for (PixelArea& area : areas) area = common(area, all);
    std::erase_if(areas, is_empty);
    join(areas);
    return areas;
}

}  // namespace achilles
