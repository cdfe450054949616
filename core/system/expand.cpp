#include "system/expand.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "expression/parse.hpp"
#include "system/mechanism.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

// The tables that only a mechanism has.
constexpr const char* mechanism_tables[] = {"world", "body", "ground", "spring", "damper", "force", "torque"};

void remove_entry(TomlValue& table, std::string_view key) {
    std::erase_if(table.entries, [&](const TomlEntry& entry) { return entry.key == key; });
}

// A sum of texts, each with its origin.
class TextSum {
 public:
    explicit TextSum(const Location& at) { sum_.at = at; }
    void add(const Text& term) {
        if (term.text.find_first_not_of(' ') == std::string::npos) return;
        const bool is_negative = term.text.starts_with('-');
        if (!sum_.text.empty()) sum_.text += is_negative ? " - " : " + ";
        // The text may be a sum whose terms have several signs, so only its first sign moves out.
        const std::size_t skipped = is_negative && !sum_.text.empty() ? 1 : 0, begin = sum_.text.size();
        sum_.text += term.text.substr(skipped);
        sum_.pieces.push_back({begin, place_in(term, skipped), term.is_written});
        for (TextPiece piece : term.pieces) {
            piece.begin += begin - skipped;
            sum_.pieces.push_back(piece);
        }
        sum_.is_written = false;
    }
    const Text& text() const { return sum_; }

 private:
    Text sum_;
};

class MechanismExpander {
 public:
    MechanismExpander(TomlValue& root, ParsedFile& reading)
        : root_(root),
          system_(reading.system),
          names_(reading.names),
          mistakes_(reading.mistakes),
          mechanism_(root, system_, names_, mistakes_),
          symbols_(mechanism_.symbols()) {}

    void expand() {
        expand_energies();
        expand_constraints();
        for (TomlValue* friction : tables_of(root_, "friction")) {
            substitute_in_slip(*friction);
            for (const char* key : {"level", "static_level"}) substitute_in(*friction, key, "slip");
        }
        for (TomlValue* jump : tables_of(root_, "jump")) {
            substitute_in_trigger(*jump, "on");
            substitute_in(*jump, "when");
            if (TomlValue* set = find_entry(*jump, "set"))
                for (TomlEntry& entry : set->entries) substitute_in(entry.value);
        }
        MechanismDrawings drawings = draw_mechanism(mechanism_, contacts_);
        expand_written_drawings();
        add_drawings(drawings);
        for (TomlValue* view : tables_of(root_, "view")) {
            substitute_in(*view, "x");
            substitute_in(*view, "y");
        }
        if (mistakes_.count() == 0) summarize();
        for (const char* key : mechanism_tables) remove_entry(root_, key);
    }

 private:
    static std::vector<TomlValue*> tables_of(TomlValue& parent, const char* key) {
        std::vector<TomlValue*> list;
        TomlValue* array = find_entry(parent, key);
        if (array != nullptr && array->kind == TomlValue::Kind::array)
            for (TomlValue& item : array->items)
                if (item.kind == TomlValue::Kind::table) list.push_back(&item);
        return list;
    }

    // Replaces values such as thigh.end.x, and the name `own` if it has a value, in a string or in all strings of an
    // array. Returns false after a mistake.
    bool substitute_in(TomlValue& value, const std::string& own = "", const std::string& own_value = "") {
        bool is_done = value.kind != TomlValue::Kind::string ||
                       mistakes_.attempt([&] { value.text = mechanism_.substituted(value.text, own, own_value); });
        if (!is_done) value.text = {"0", value.text.at, false, {}};  // so that the name is reported once
        if (value.kind == TomlValue::Kind::array)
            for (TomlValue& item : value.items) is_done = substitute_in(item, own, own_value) && is_done;
        return is_done;
    }
    void substitute_in(TomlValue& table, const char* key, const std::string& own = "",
                       const std::string& own_value = "") {
        if (TomlValue* value = find_entry(table, key)) substitute_in(*value, own, own_value);
    }

    // What starts a jump or ends a latch: one word that is the name of a contact stays, even if a ground or a body has
    // the same name.
    void substitute_in_trigger(TomlValue& table, const char* key) {
        TomlValue* const value = find_entry(table, key);
        if (value == nullptr) return;
        for (TomlValue* constraint : tables_of(root_, "constraint"))
            if (const TomlValue* name = find_entry(*constraint, "name"); name && name->text.text == value->text.text)
                return;
        substitute_in(*value);
    }

    // The slip of a contact or a [[friction]]. One with a mistake becomes a rate, which is a slip.
    void substitute_in_slip(TomlValue& table) {
        TomlValue* slip = find_entry(table, "slip");
        if (slip == nullptr) return;
        const std::size_t before = mistakes_.count();
        substitute_in(*slip);
        if (mistakes_.count() > before && !system_.coordinates.empty())
            slip->text.text = system_.coordinates.front().name + "'";
    }

    Text written_in(TomlValue* table, const char* key) {
        if (table == nullptr) return {};
        TomlValue* value = find_entry(*table, key);
        if (value == nullptr || (value->kind != TomlValue::Kind::string && value->kind != TomlValue::Kind::number))
            return {};
        substitute_in(*value);
        return value->text;
    }

    void expand_energies() {
        TomlValue* lagrangian = find_entry(root_, "lagrangian");
        const bool has_bodies = find_entry(root_, "body") != nullptr;
        TomlValue* kinetic = lagrangian ? find_entry(*lagrangian, "kinetic") : nullptr;
        if (has_bodies && kinetic != nullptr)
            mistakes_.add({kinetic->at, "'kinetic' is derived from the bodies, and may not be given besides",
                           "leave it out, or leave out [[body]]; potential, dissipation and force may be given"});
        if (has_bodies && kinetic != nullptr) remove_entry(*lagrangian, "kinetic");
        if (!has_bodies && kinetic == nullptr) return;  // reported as missing
        const MechanismTerms terms = derive_terms(mechanism_, system_, mistakes_);
        if (mistakes_.count() > 0) return;
        system_.mechanism.is_prescribed = terms.is_prescribed;
        if (lagrangian == nullptr) lagrangian = &set_entry(root_, "lagrangian", made_table(terms.kinetic.at));
        if (has_bodies)
            attempt_part(mistakes_, terms.kinetic.at, "the kinetic energy of the bodies", [&] {
                set_entry(*lagrangian, "kinetic", made_string(symbols_.text(terms.kinetic.value), terms.kinetic.at));
            });
        put_sum(*lagrangian, "potential", terms.potential, "0", terms.kinetic.at);
        put_sum(*lagrangian, "dissipation", terms.dissipation, "", terms.kinetic.at);
        const std::vector<TomlValue*> coordinates = tables_of(root_, "coordinate");
        for (std::size_t i = 0; i < coordinates.size() && i < terms.forces.size(); ++i) {
            put_sum(*coordinates[i], "force", terms.forces[i], "", coordinates[i]->at);
            if (const TomlValue* force = find_entry(*coordinates[i], "force"))
                system_.coordinates[i].force = force->text;
        }
    }

    // The sum of a typed text and derived terms as the value of a key; `otherwise` if there is none.
    void put_sum(TomlValue& table, const char* key, const std::vector<DerivedTerm>& terms, const std::string& otherwise,
                 const Location& at) {
        const Text typed = written_in(&table, key);
        if (!typed.text.empty() && terms.empty()) return;
        TextSum sum(terms.empty() ? at : terms.front().at);
        sum.add(typed);
        for (const DerivedTerm& term : terms)
            attempt_part(mistakes_, term.at, fmt::format("the {}", key), [&] {
                sum.add({symbols_.text(term.value), term.at, false, {}});
            });
        if (sum.text().text.empty() && otherwise.empty()) return;
        TomlValue value = made_string(otherwise, at);
        if (!sum.text().text.empty()) {
            value.text = sum.text();
            value.at = value.text.at;
        }
        set_entry(table, key, std::move(value));
    }

    void expand_constraints() {
        for (TomlValue* table : tables_of(root_, "constraint")) {
            std::optional<ShapeContact>& contact = contacts_.emplace_back();
            for (const char* key : {"restitution", "when"}) substitute_in(*table, key);
            substitute_in_trigger(*table, "latch");
            substitute_in_slip(*table);
            TomlValue* typed = find_entry(*table, "gap");
            if (typed != nullptr && !substitute_in(*typed)) remove_entry(*table, "gap");  // 0 would be a second mistake
            const Fields fields(*table, "[[constraint]]");
            attempt_part(mistakes_, table->at, "the gap", [&] {
                if (fields.find("between") == nullptr) {
                    for (const char* key : {"longest", "normal"})
                        if (const TomlValue* value = fields.find(key))
                            throw Mistake{
                                value->at, fmt::format("'{}' in [[constraint]] goes with 'between'", key), {}};
                    return;
                }
                for (const char* key : {"gap", "slip"})
                    if (const TomlValue* value = fields.find(key))
                        throw Mistake{value->at, fmt::format("'{}' is derived from 'between'", key),
                                      "leave one of them out"};
                contact = read_contact(mechanism_, fields);
            });
            const Location at = fields.find("between") ? fields.find("between")->at : table->at;
            const bool is_scaled = contact && !contact->scale.is_zero();
            const std::string speed = is_scaled ? fmt::format("slip/({})", symbols_.text(contact->scale)) : "";
            for (const char* key : {"friction", "static_friction"}) substitute_in(*table, key, "slip", speed);
            for (const char* key : {"between", "longest", "normal"}) remove_entry(*table, key);
            if (!contact) continue;
            set_entry(*table, "gap", made_string(symbols_.text(contact->gap), at));
            if (contact->has_slip) set_entry(*table, "slip", made_string(symbols_.text(contact->slip), at));
        }
    }

    // Drawings as typed: points may be names, and those of a drawing `on` a body are in its axes.
    void expand_written_drawings() {
        for (TomlValue* drawing : tables_of(root_, "drawing")) expand_drawing(*drawing);
        for (TomlValue* constraint : tables_of(root_, "constraint"))
            for (TomlValue* drawing : tables_of(*constraint, "drawing")) expand_drawing(*drawing);
    }

    void expand_drawing(TomlValue& drawing) {
        mistakes_.attempt([&] {
            const Fields fields(drawing, "[[drawing]]");
            PlacedShape* on = fields.find("on") ? mechanism_.find(fields.string("on")) : nullptr;
            remove_entry(drawing, "on");
            const TomlValue* over = fields.find("over");
            const std::string own = over != nullptr && !over->items.empty() ? over->items[0].text.text : "";
            for (const char* key : {"radius", "size", "coils", "across", "width"}) substitute_in(drawing, key, own);
            if (over != nullptr)
                for (std::size_t i = 1; i < over->items.size(); ++i)
                    substitute_in(find_entry(drawing, "over")->items[i], own);
            for (const char* key : {"at", "from", "to"})
                if (TomlValue* value = find_entry(drawing, key)) place_in_world(*value, fields, key, on, own);
            if (TomlValue* points = find_entry(drawing, "points"); points && points->kind == TomlValue::Kind::array)
                for (TomlValue& point : points->items) place_in_world(point, fields, "points", on, own);
            const bool is_named = is_name(own) && !is_reserved(own) && !names_.places.contains(own);
            if (on != nullptr && is_named)
                find_entry(drawing, "over")->items[0].text.text =
                    symbols_.text(ProductSum::from(symbols_.graph().symbol(symbols_.abscissa())));
            turn_with(drawing, on);
        });
    }

    // A point in the axes of `on` becomes one of the world. The name `own` of a curve's parameter becomes the abscissa.
    void place_in_world(TomlValue& value, const Fields& fields, const char* key, PlacedShape* on,
                        const std::string& own) {
        if (value.kind != TomlValue::Kind::string && on == nullptr) {
            substitute_in(value, own);
            return;
        }
        MovingPoint point;  // stays the origin after a mistake, so that this is reported once
        mistakes_.attempt([&] { point = mechanism_.read_point(value, fields, key, on, own).point; });
        value = made_point(world_point(symbols_, point), value.at);
    }

    void turn_with(TomlValue& drawing, const PlacedShape* on) {
        substitute_in(drawing, "angle");
        const TomlValue* shape = find_entry(drawing, "shape");
        if (on == nullptr || on->frame.angle.is_zero() || shape == nullptr || shape->text.text != "box") return;
        TextSum angle(drawing.at);
        angle.add({symbols_.text(on->frame.angle), drawing.at, false, {}});
        angle.add(written_in(&drawing, "angle"));
        TomlValue value = made_string("", drawing.at);
        value.text = angle.text();
        set_entry(drawing, "angle", std::move(value));
    }

    // Puts made drawings before the typed ones, so that those are drawn over them.
    static void put_before(TomlValue& parent, std::vector<TomlValue>& made, const Location& at) {
        if (made.empty()) return;
        TomlValue* typed = find_entry(parent, "drawing");
        if (typed != nullptr && typed->kind != TomlValue::Kind::array) return;
        if (typed == nullptr) typed = &set_entry(parent, "drawing", made_list(at));
        typed->items.insert(typed->items.begin(), std::make_move_iterator(made.begin()),
                            std::make_move_iterator(made.end()));
    }

    void add_drawings(MechanismDrawings& drawings) {
        put_before(root_, drawings.free, root_.at);
        // Before the constraints, whose drawings are drawn over them.
        const auto place_of = [&](const char* key) {
            return std::find_if(root_.entries.begin(), root_.entries.end(),
                                [&](const TomlEntry& e) { return e.key == key; });
        };
        const auto drawing = place_of("drawing"), constraint = place_of("constraint");
        if (drawing != root_.entries.end() && constraint < drawing) std::rotate(constraint, drawing, drawing + 1);
        const std::vector<TomlValue*> constraints = tables_of(root_, "constraint");
        for (std::size_t i = 0; i < constraints.size() && i < drawings.of_contacts.size(); ++i)
            put_before(*constraints[i], drawings.of_contacts[i], constraints[i]->at);
    }

    void summarize() {
        MechanismSummary& summary = system_.mechanism;
        for (const RigidBody* body : mechanism_.bodies()) summary.bodies.push_back(summary_of(*body));
        for (const SpringOrDamper& spring : mechanism_.springs) summary.springs.push_back(summary_of(spring, summary));
        for (const auto& contact : contacts_) {
            SummaryContact& line = summary.contacts.emplace_back();
            if (!contact) continue;
            line = {contact->name,
                    symbols_.text(contact->gap),
                    contact->has_slip ? symbols_.text(contact->slip) : "",
                    contact->force,
                    contact->behind,
                    contact->hint};
        }
    }

    SummaryLine summary_of(const RigidBody& body) const {
        SummaryLine line{body.name, {}, {}};
        if (!body.mass.is_zero()) {
            line.pattern = "{0}";
            line.values.push_back(symbols_.text(body.mass));
        } else {
            line.pattern = "no mass";
        }
        if (!body.inertia.is_zero()) {
            line.pattern += fmt::format(", {{{}}} about its center", line.values.size());
            line.values.push_back(symbols_.text(body.inertia));
            // Masses and lengths that are plain numbers have no unit of their own.
            const bool has_mass = !body.mass.is_zero();
            if (has_mass && unit_of_expression(system_, line.values[0]) == "kg") line.units = {"", "kg*m^2"};
            if (has_mass && unit_of_expression(system_, line.values[1]) == "m^2") line.units = {"kg", "kg*m^2"};
            if (!body.how.empty()) line.pattern += fmt::format(" ({})", body.how);
        } else if (!body.mass.is_zero()) {
            line.pattern += ", a point";
        }
        line.pattern += "; " + body.placement;
        return line;
    }

    SummaryLine summary_of(const SpringOrDamper& spring, MechanismSummary& summary) const {
        SummaryLine line{spring.is_damper ? "damper" : "spring", {}, {symbols_.text(spring.coefficient)}};
        line.pattern = spring.between ? fmt::format("{} to {}: ", (*spring.between)[0].name, (*spring.between)[1].name)
                                      : fmt::format("angle `{}`: ", symbols_.text(spring.angle));
        line.pattern += spring.is_damper ? "d = {0}" : "k = {0}";
        if (spring.between) {
            const auto& [from, to] = *spring.between;
            const PointDistance length = distance_between(mechanism_, from, to, true, spring.at);
            line.values.push_back(symbols_.text(length.value));
            line.pattern += ", length {1}";
            if (length.is_signed) line.pattern += " (signed)";
            summary.has_signed_length = summary.has_signed_length || length.is_signed;
        }
        if (spring.is_damper) return line;
        line.pattern += fmt::format(", {} {{{}}}", spring.between ? "rest length" : "at rest at", line.values.size());
        line.values.push_back(symbols_.text(spring.rest));
        return line;
    }

    TomlValue& root_;
    SystemDescription& system_;
    Names& names_;
    ErrorCollector& mistakes_;
    PlacedMechanism mechanism_;
    const MechanismSymbols& symbols_;
    std::vector<std::optional<ShapeContact>> contacts_;
};

// True if a table of this section has one of the keys.
bool has_key(const TomlValue& root, const char* section, std::initializer_list<const char*> keys) {
    const TomlValue* tables = find_entry(root, section);
    return tables != nullptr && std::any_of(tables->items.begin(), tables->items.end(), [&](const TomlValue& table) {
               return std::any_of(keys.begin(), keys.end(),
                                  [&](const char* key) { return find_entry(table, key) != nullptr; });
           });
}

bool has_mechanism(const TomlValue& root) {
    const TomlValue* constraints = find_entry(root, "constraint");
    return std::any_of(std::begin(mechanism_tables), std::end(mechanism_tables),
                       [&](const char* key) { return find_entry(root, key) != nullptr; }) ||
           has_key(root, "drawing", {"on"}) || has_key(root, "constraint", {"between", "longest", "normal"}) ||
           (constraints != nullptr &&
            std::any_of(constraints->items.begin(), constraints->items.end(),
                        [](const TomlValue& constraint) { return has_key(constraint, "drawing", {"on"}); }));
}

}  // namespace

MechanismExpansion expand_mechanism(TomlValue& root, ParsedFile& reading) {
    MechanismExpansion result;
    result.has_mechanism = has_mechanism(root);
    if (!result.has_mechanism) return result;
    attempt_part(reading.mistakes, {1, 1}, "the mechanism", [&] { MechanismExpander(root, reading).expand(); });
    result.has_failed = reading.mistakes.count() > 0;
    return result;
}

Text with_body_values(const SystemDescription& system, const Scope& scope, const Text& typed) {
    const MechanismSummary& mechanism = system.mechanism;
    const auto is_body = [&](std::string_view name) {
        return !scope.allowed.contains(std::string(name)) &&
               std::any_of(mechanism.bodies.begin(), mechanism.bodies.end(),
                           [&](const SummaryLine& body) { return body.name == name; });
    };
    const auto names = dotted_names_in(typed.text);
    const bool has_value = std::any_of(names.begin(), names.end(), [&](std::string_view name) {
        return name.find('.') != name.npos || is_body(name);
    });
    const bool has_bodies = !mechanism.bodies.empty() || !mechanism.contacts.empty();
    if (!has_bodies || !has_value) return typed;
    const TomlValue root = read_toml(system.source_text, system.file);
    Names known;
    for (const auto& [name, symbol] : scope.allowed) known.places.emplace(name, Location{});
    ErrorCollector mistakes;  // stays empty: the file has been read before
    return PlacedMechanism(root, system, known, mistakes).substituted(typed);
}

namespace {

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (c == '\n')
            result += "\\n";
        else if (c == '\t')
            result += "\\t";
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            result += c;
    }
    return result + "\"";
}

std::string key_of(const std::string& key) {
    const bool is_bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
    return is_bare ? key : quoted(key);
}

std::string inline_value(const TomlValue& value) {
    std::string result;
    const auto add = [&](const std::string& part) { result += (result.empty() ? "" : ", ") + part; };
    switch (value.kind) {
        case TomlValue::Kind::string:
            return quoted(value.text.text);
        case TomlValue::Kind::boolean:
            return value.boolean ? "true" : "false";
        case TomlValue::Kind::array:
            for (const TomlValue& item : value.items) add(inline_value(item));
            return "[" + result + "]";
        case TomlValue::Kind::table:
            for (const TomlEntry& entry : value.entries) add(key_of(entry.key) + " = " + inline_value(entry.value));
            return "{" + result + "}";
        default:
            return value.text.text;
    }
}

}  // namespace

std::string to_toml(const TomlValue& root) {
    std::string result;
    for (const auto& [key, at, value] : root.entries) {
        if (key == "extra") continue;
        const bool is_list_of_tables = value.kind == TomlValue::Kind::array && !value.items.empty() &&
                                       value.items.front().kind == TomlValue::Kind::table;
        if (is_list_of_tables) {
            result += fmt::format("\n{} = [\n", key_of(key));
            for (const TomlValue& item : value.items) result += fmt::format("    {},\n", inline_value(item));
            result += "]\n";
        } else if (key == "lagrangian" && value.kind == TomlValue::Kind::table) {
            result += "\n";
            for (const TomlEntry& entry : value.entries)
                result += fmt::format("lagrangian.{} = {}\n", key_of(entry.key), inline_value(entry.value));
        } else {
            result += fmt::format("{} = {}\n", key_of(key), inline_value(value));
        }
    }
    return result;
}

}  // namespace achilles
