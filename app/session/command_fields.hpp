// What a command of the explorer says of itself, once: its name, how it is written, what it changes, its fields. The
// reader, the printer, == and the history derive from it (command.cpp).
#pragma once

#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace achilles::command {

// What a command changes, and so what undo makes of it.
enum class Change {
    none,      // nothing but the present: what the last change complained about stays
    view,      // how the run is looked at, a file: undo leaves it
    alone,     // what undo takes back
    together,  // the same, with the last change if that was of this kind and the same thing: the first of several fields
};

// The value of a name. What says its own unit (30 deg) keeps its text: whether that fits, the system tells.
struct Given {
    double value = 0.0;
    std::string text = {};

    Given() = default;
    Given(double number) : value(number) {}  // NOLINT: most are numbers
    Given(double number, std::string said) : value(number), text(std::move(said)) {}
    friend bool operator==(const Given&, const Given&) = default;
};

// How a field is written. Nothing said: a text, a finite number, a whole number is one word; a list is the rest.
struct How {
    std::string_view yes = {}, no = {};                // the words for a bool; where one is empty, it is left out
    bool is_name = false;                              // these are names of the command, not words after it
    bool in_quotes = false;                            // a text, always
    const std::vector<std::string>* one_of = nullptr;  // a text
    std::string_view known = {};     // what is said, with {} for them, where it is none of these; else the usage
    bool (*fits)(double) = nullptr;  // a number
    std::string_view zero = {};      // the word for 0
    std::string_view after = {};     // a number above 0, behind this word; 0 where both are left out
    // A bool of one word: another one is the next field's. A whole number from 1: 0 where it is left out. A list: of none.
    bool may_lack = false;
    std::string_view complaint = {};  // {}: what stands there instead, and for a text what was probably meant
};
constexpr How in_quotes{.in_quotes = true};
constexpr How on_off{.yes = "on", .no = "off", .complaint = "'{}' is neither on nor off"};
constexpr How x_or_y{.yes = "x", .no = "y", .complaint = "the axis must be x or y"};
constexpr How length_after(std::string_view word) {
    return {.fits = [](double x) { return x > 0.0; }, .after = word, .complaint = "this must be above 0, not {}"};
}
constexpr How overwrite{.yes = "overwrite", .complaint = "'{}' is not expected here"};

template <class Kind, class Value>
struct Field {
    Value Kind::*member;
    How how{};

    constexpr Field(Value Kind::*of_it, const How& written) : member(of_it), how(written) {}
    constexpr explicit Field(Value Kind::*of_it) : member(of_it) {}
};

template <class... Fields>
struct Said {
    std::string_view name;
    std::string_view usage;  // what is said where a line is wrong; {} is the name
    Change change;
    std::tuple<Fields...> fields;  // members, or Fields where there is more to say

    constexpr Said(std::string_view called, std::string_view written, Change changed, Fields... of_it)
        : name(called), usage(written), change(changed), fields(of_it...) {}
};
constexpr std::string_view alone = "it takes no arguments";

template <class Kind>
concept Spoken = requires {
    Kind::said;
};

// Calls what(Field) for every field of a kind, in order.
template <Spoken Kind, class What>
constexpr void for_each_field(const What& what) {
    std::apply([&](const auto&... field) { (what(Field(field)), ...); }, Kind::said.fields);
}

template <Spoken Kind>
bool operator==(const Kind& a, const Kind& b) {
    bool same = true;
    for_each_field<Kind>([&](const auto& field) { same = same && a.*field.member == b.*field.member; });
    return same;
}

}  // namespace achilles::command
