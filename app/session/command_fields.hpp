// Self-description of an explorer command: its name, usage, effect on undo, and fields. Parser, printer, == and undo
// history are derived from it (command.cpp).
#pragma once

#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace achilles::command {

// What a command changes, which determines how undo treats it.
enum class UndoPolicy {
    none,      // only the playback state; the error of the last change stays visible
    view,      // the view, or a file: not undone
    own_step,  // the system or the run: one undo step
    // As `own_step`, but merged with the previous step if that set the same thing (the same first field).
    merge_with_previous,
};

// The value of a named quantity. A value typed with a unit (30 deg) keeps its text; the system checks whether the unit
// fits.
struct ValueArgument {
    double value = 0.0;
    std::string text = {};

    ValueArgument() = default;
    ValueArgument(double number) : value(number) {}  // NOLINT: most are numbers
    ValueArgument(double number, std::string typed) : value(number), text(std::move(typed)) {}
    friend bool operator==(const ValueArgument&, const ValueArgument&) = default;
};

// Text format of a field. Default: strings, finite numbers and integers are one word; a list takes the rest of the
// line.
struct FieldFormat {
    // Words for a bool; if one is empty, that value is written by leaving the word out.
    std::string_view yes = {}, no = {};
    bool is_name = false;                              // the two words are names of the command itself, not arguments
    bool in_quotes = false;                            // string, always quoted
    const std::vector<std::string>* one_of = nullptr;  // string, one of these
    std::string_view known = {};                       // error if it is none of them, {} lists them; default: the usage
    bool (*fits)(double) = nullptr;                    // number, validity check
    std::string_view zero = {};                        // word for the number 0
    std::string_view after = {};                       // keyword before a positive number; 0 if both are absent
    // Optional. A bool with one word: any other word belongs to the next field. An integer from 1: 0 if absent. A list:
    // may be empty.
    bool may_lack = false;
    std::string_view complaint = {};  // error message; {} is the offending word and, for a string, the suggestion
};
constexpr FieldFormat in_quotes{.in_quotes = true};
constexpr FieldFormat on_off{.yes = "on", .no = "off", .complaint = "'{}' is neither on nor off"};
constexpr FieldFormat x_or_y{.yes = "x", .no = "y", .complaint = "the axis must be x or y"};
constexpr FieldFormat length_after(std::string_view word) {
    return {.fits = [](double x) { return x > 0.0; }, .after = word, .complaint = "this must be above 0, not {}"};
}
constexpr FieldFormat overwrite{.yes = "overwrite", .complaint = "'{}' is not expected here"};

template <class Kind, class Value>
struct Field {
    Value Kind::*member;
    FieldFormat how{};

    constexpr Field(Value Kind::*of_it, const FieldFormat& written) : member(of_it), how(written) {}
    constexpr explicit Field(Value Kind::*of_it) : member(of_it) {}
};

template <class... Fields>
struct CommandSpec {
    std::string_view name;
    std::string_view usage;  // error text for a malformed line; {} is the name
    UndoPolicy change;
    std::tuple<Fields...> fields;  // members, or Fields if they need a format

    constexpr CommandSpec(std::string_view called, std::string_view written, UndoPolicy changed, Fields... of_it)
        : name(called), usage(written), change(changed), fields(of_it...) {}
};
constexpr std::string_view alone = "it takes no arguments";

template <class Kind>
concept HasCommandSpec = requires {
    Kind::spec;
};

// Calls what(Field) for every field of a command type, in order.
template <HasCommandSpec Kind, class What>
constexpr void for_each_field(const What& what) {
    std::apply([&](const auto&... field) { (what(Field(field)), ...); }, Kind::spec.fields);
}

template <HasCommandSpec Kind>
bool operator==(const Kind& a, const Kind& b) {
    bool same = true;
    for_each_field<Kind>([&](const auto& field) { same = same && a.*field.member == b.*field.member; });
    return same;
}

}  // namespace achilles::command
