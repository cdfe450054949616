#include "expression/parse.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "expression/expression.hpp"
#include "expression/name_suggestions.hpp"
#include "expression/repair.hpp"
#include "number/float_environment.hpp"

namespace achilles {

namespace {

// Nesting limit: far deeper than formulas written by hand, and safe for every stack.
constexpr int deepest = 200;

constexpr std::array<std::string_view, 9> reserved{"t",    "pi",   "gap",   "lambda", "energy",
                                                   "work", "loss", "power", "deg"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_part(char c) { return is_letter(c) || is_digit(c) || c == '_'; }

// The first character of `rest` for a message: a whole UTF-8 sequence, or "a control character".
std::string first_character(std::string_view rest) {
    const auto byte = static_cast<unsigned char>(rest.front());
    if (byte < 0x20 || byte == 0x7f) return "a control character";
    if (byte < 0x80) return in_quotes(rest.substr(0, 1));
    std::size_t length = 1;
    while (length < rest.size() && (static_cast<unsigned char>(rest[length]) & 0xC0) == 0x80 && length < 4) ++length;
    return in_quotes(rest.substr(0, length));
}

constexpr std::string_view functions_are = "; the functions are ";

std::string the_functions() {
    std::string list;
    for (const Function& function : functions)
        list += std::string(list.empty() ? functions_are : ", ") + std::string(function.name);
    return list;
}

class Parser {
 public:
    Parser(std::string_view text, const Scope& scope, Graph& graph, TextParts* parts)
        : text_(text), scope_(scope), graph_(graph), parts_(parts) {}

    std::size_t at() const { return at_; }  // bytes read so far

    Expression whole() {
        skip_space();
        if (at_end()) throw ParseError(0, "an expression is missing");
        const Expression result = sum();
        if (!at_end()) fail_at_leftover();
        return result;
    }

 private:
    // Counts the nesting depth for the lifetime of the object.
    struct NestingGuard {
        explicit NestingGuard(Parser& parser) : parser_(parser) {
            if (++parser_.depth_ > deepest)
                throw ParseError(parser_.at_, "nested more than " + std::to_string(deepest) + " levels deep");
        }
        ~NestingGuard() { --parser_.depth_; }
        NestingGuard(const NestingGuard&) = delete;
        NestingGuard& operator=(const NestingGuard&) = delete;
        Parser& parser_;
    };

    bool at_end() const { return at_ >= text_.size(); }
    char peek() const { return at_end() ? '\0' : text_[at_]; }
    void skip_space() {
        while (!at_end() && (peek() == ' ' || peek() == '\t' || peek() == '\n' || peek() == '\r')) ++at_;
    }
    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        skip_space();
        return true;
    }

    Expression sum() {
        Expression left = product();
        for (;;) {
            if (take('+')) {
                left = left + product();
            } else if (take('-')) {
                left = left - product();
            } else {
                return left;
            }
        }
    }

    // One term of a sum.
    Expression product() {
        const std::size_t begin = at_;
        const Expression term = factors();
        if (parts_ != nullptr && depth_ == 0) parts_->terms.push_back(part(begin, term));
        return noted(begin, term);
    }

    TextPart part(std::size_t begin, Expression value) const {
        const std::size_t last = text_.find_last_not_of(" \t\r\n", at_ - 1);
        return {begin, last + 1 - begin, value};
    }

    Expression noted(std::size_t begin, Expression value) {
        if (parts_ != nullptr) parts_->all.push_back(part(begin, value));
        return value;
    }

    // 1/2 deg is (1/2) deg: a unit is a factor.
    Expression factors() {
        Expression left = signed_factor();
        bool has_unit = false;
        for (;;) {
            const std::size_t where = at_;
            if (const Expression* unit = take_unit()) {
                if (std::exchange(has_unit, true)) throw ParseError(where, "write one unit only, as in 30 deg");
                left = left * *unit;
                continue;
            }
            if (take('*')) {
                if (peek() == '*') throw ParseError(where, "unknown operator '**'; write '^' for a power");
                left = left * signed_factor();
            } else if (take('/')) {
                const Expression divisor = signed_factor();
                if (divisor.is_zero()) throw ParseError(where, "division by zero");
                left = left / divisor;
            } else {
                return left;
            }
        }
    }

    bool begins_with(std::string_view word) const {
        const std::string_view rest = text_.substr(at_);
        const bool ends_there =
            rest.size() == word.size() || (rest.size() > word.size() && !is_name_part(rest[word.size()]));
        return rest.starts_with(word) && (ends_there || !is_letter(word[0]));
    }

    // The unit that follows a value; null if there is none.
    const Expression* take_unit() {
        for (auto unit = scope_.units.rbegin(); unit != scope_.units.rend(); ++unit) {  // deg/s before deg
            if (!begins_with(unit->first)) continue;
            at_ += unit->first.size();
            skip_space();
            return &unit->second;
        }
        return nullptr;
    }

    // -x^2 is -(x^2): the sign binds less tightly than the power.
    Expression signed_factor() {
        const NestingGuard level(*this);
        if (take('-')) return -signed_factor();
        if (take('+')) return signed_factor();
        const std::size_t begin = at_;
        const Expression base = noted(begin, atom());
        const std::size_t where = at_;
        if (!take('^')) return base;
        return noted(begin, raise(base, signed_factor(), where));  // 2^3^2 = 2^(3^2)
    }

    Expression raise(Expression base, Expression exponent, std::size_t where) {
        if (!is_constant(exponent) && !(value_of_constant(base) > 0.0))
            throw ParseError(where, "the exponent of '^' must be a number, or its base a positive number");
        try {
            return real_power(base, exponent);
        } catch (const std::domain_error&) {
            throw ParseError(where, "division by zero: a negative power of 0");
        }
    }

    Expression atom() {
        if (at_end()) throw ParseError(at_, "the expression ends where a value is expected");
        if (is_digit(peek()) || (peek() == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))) return number();
        if (is_letter(peek())) return name();
        const std::size_t open = at_;
        if (take('(')) {
            const Expression inner = sum();
            close(open);
            return inner;
        }
        refuse_greek();
        refuse_bar();
        throw ParseError(at_, "unexpected " + first_character(text_.substr(at_)) + " where a value is expected" +
                                  instead_of_sign(text_.substr(at_)));
    }

    // Rejects Greek letters: θ, and θ1 as one name.
    void refuse_greek() const {
        const std::string_view rest = text_.substr(at_);
        for (const auto& [name, letter] : greek_letters) {
            if (!rest.starts_with(letter)) continue;
            std::size_t end = letter.size();
            while (end < rest.size() && is_name_part(rest[end])) ++end;
            const std::string_view whole = rest.substr(0, end);
            throw ParseError(
                at_, "names have Latin letters: write " + spelled_out(whole) + " for '" + std::string(whole) + "'");
        }
    }

    // Rejects |x|.
    void refuse_bar() const {
        if (peek() == '|')
            throw ParseError(at_, "|x| is not allowed: it is not smooth, and the equations of motion need derivatives",
                             {}, std::string(instead_of_corner("abs")));
    }

    void close(std::size_t open) {
        if (take(')')) return;
        if (at_end()) throw ParseError(open, "this '(' is never closed");
        fail_at_leftover();
    }

    [[noreturn]] void fail_at_leftover() const {
        if (peek() == ')') throw ParseError(at_, "this ')' has no matching '('");
        for (const char* unit : {"deg", "\u00b0", "rad"}) {
            const auto reason = scope_.forbidden.find(unit);
            if (begins_with(unit) && reason != scope_.forbidden.end()) throw ParseError(at_, reason->second, unit);
            if (begins_with(unit) && unit != std::string_view("rad"))
                throw ParseError(
                    at_, "degrees are allowed only in a plain number, as in start = \"30 deg\"; here write pi/180*");
        }
        refuse_unit();
        const bool number_follows = peek() == '.' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]);
        if (is_name_part(peek()) || peek() == '(' || number_follows)
            throw ParseError(at_, "an operator is missing here; write '*' for a product");
        refuse_greek();
        refuse_bar();
        if (peek() == '\'') throw ParseError(at_, "a prime may only follow the name of a coordinate");
        if (peek() == '[' && follows_name()) throw ParseError(at_, "unexpected '['; coordinates have no index");
        throw ParseError(at_, "unexpected " + first_character(text_.substr(at_)) + instead_of_sign(text_.substr(at_)));
    }

    // True right after a name that stands for a single value.
    bool follows_name() const {
        std::size_t begin = text_.find_last_not_of(" \t\r\n", at_ - 1) + 1;
        const std::size_t end = begin;
        while (begin > 0 && is_name_part(text_[begin - 1])) --begin;
        const std::string_view name = text_.substr(begin, end - begin);
        return scope_.allowed.find(name) != scope_.allowed.end() && scope_.listed.find(name) == scope_.listed.end();
    }

    // Rejects a unit after a number, as in 1.0 m, if m is not a name.
    void refuse_unit() const {
        const std::size_t last = text_.find_last_not_of(" \t\r\n", at_ - 1);
        if (!is_letter(peek()) || !(is_digit(text_[last]) || text_[last] == '.')) return;
        std::size_t end = at_;
        while (end < text_.size() && is_name_part(text_[end])) ++end;
        const std::string_view word = text_.substr(at_, end - at_);
        if (scope_.allowed.find(word) != scope_.allowed.end() || is_reserved(word)) return;
        if (word == "e" || word == "E") throw ParseError(at_, "write the exponent, as in 1e-3");
        throw ParseError(at_, in_quotes(word) +
                                  " may not follow a number: write numbers without units (a file has the key unit for "
                                  "that) and products with '*'");
    }

    Expression number() {
        const std::size_t begin = at_;
        while (is_digit(peek())) ++at_;
        if (peek() == '.') ++at_;
        while (is_digit(peek())) ++at_;
        if (peek() == 'e' || peek() == 'E') {
            std::size_t digits = at_ + 1;
            if (digits < text_.size() && (text_[digits] == '+' || text_[digits] == '-')) ++digits;
            if (digits < text_.size() && is_digit(text_[digits])) {
                at_ = digits;
                while (is_digit(peek())) ++at_;
            }
        }
        const std::string_view literal = text_.substr(begin, at_ - begin);
        skip_space();
        try {
            return graph_.decimal(literal);
        } catch (const std::out_of_range& problem) {
            throw ParseError(begin, std::string("this number is out of range: it has ") + problem.what());
        }
    }

    Expression name() {
        const std::size_t begin = at_;
        while (is_name_part(peek())) ++at_;
        const std::string_view bare = text_.substr(begin, at_ - begin);
        while (peek() == '\'') ++at_;
        const std::string_view full = text_.substr(begin, at_ - begin);
        skip_space();
        for (const Function& function : functions)
            if (function.name == full) return call(function.name, function.operation, begin);
        if (full == "pi" && peek() != '(') return graph_.pi();
        const auto list = scope_.listed.find(full);
        if (list != scope_.listed.end() && peek() == '(') return list->second(number_in_list(full));
        const auto by_contact = scope_.of_contact.find(full);
        const auto found = scope_.allowed.find(full);
        if (by_contact != scope_.of_contact.end() && (peek() == '(' || found == scope_.allowed.end()))
            return contact_in_list(full, by_contact->second, begin);
        if (found != scope_.allowed.end() || full == "pi") {
            if (peek() == '(') throw ParseError(begin, in_quotes(full) + " is not a function; write '*' for a product");
            return found->second;
        }
        const auto reason = scope_.forbidden.find(full);
        if (reason != scope_.forbidden.end()) throw ParseError(begin, reason->second, full);
        fail_at_unknown(begin, bare, full);
    }

    // Reads an index in parentheses, such as "(2)".
    int number_in_list(std::string_view word) {
        const std::size_t open = at_;
        take('(');
        const std::size_t begin = at_;
        int number = 0;
        const auto [end, problem] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
        if (problem == std::errc()) at_ += static_cast<std::size_t>(end - (text_.data() + at_));
        skip_space();
        const bool is_whole = peek() == ')' || at_end();
        if (problem != std::errc() || number < 1 || !is_whole)
            throw ParseError(begin, std::string(word) + "(k) needs a whole number of at least 1, as in " +
                                        std::string(word) + "(1)");
        close(open);
        return number;
    }

    // Reads the name of a contact in parentheses, such as "(foot)".
    Expression contact_in_list(std::string_view word, const std::map<std::string, Expression, std::less<>>& of_contact,
                               std::size_t where) {
        const std::size_t open = at_;
        const std::string needs = std::string(word) + "(NAME) takes the name of a contact, and nothing else";
        if (!take('(')) throw ParseError(where, needs);
        const std::size_t begin = at_;
        while (is_name_part(peek())) ++at_;
        const std::string_view name = text_.substr(begin, at_ - begin);
        skip_space();
        const auto found = of_contact.find(name);
        if (name.empty() || !(peek() == ')' || at_end())) throw ParseError(begin, needs);
        if (found == of_contact.end()) {
            std::vector<std::string> contacts;
            for (const auto& [contact, symbol] : of_contact) contacts.push_back(contact);
            throw ParseError(begin, "no contact is named " + in_quotes(name) + did_you_mean(name, contacts));
        }
        close(open);
        return found->second;
    }

    Expression call(std::string_view word, Operation function, std::size_t begin) {
        const std::size_t open = at_;
        if (!take('('))
            throw ParseError(
                begin, "the function " + in_quotes(word) + " needs parentheses: " + std::string(word) + "(...)", word);
        const Expression argument = sum();
        if (peek() == ',') throw ParseError(at_, "the function " + in_quotes(word) + " takes one argument");
        close(open);
        return apply(function, argument);
    }

    [[noreturn]] void fail_at_unknown(std::size_t begin, std::string_view bare, std::string_view full) const {
        if (!scope_.listed.empty() && !instead_of_corner(bare).empty())
            throw ParseError(
                begin, in_quotes(bare) + " over a run is not available", bare,
                "expressions are evaluated at the end of the run; least_gap is the smallest gap of the whole run");
        if (const std::string_view instead = instead_of_corner(bare == "sgn" && peek() == '(' ? "sign" : bare);
            !instead.empty())
            throw ParseError(
                begin,
                in_quotes(bare) + " is not allowed: it is not smooth, and the equations of motion need derivatives",
                bare, instead);
        std::vector<std::string> known;
        for (const Function& function : functions) known.emplace_back(function.name);
        for (const auto& [word, element] : scope_.listed) known.push_back(word);
        if (peek() == '(' && scope_.allowed.find(full) == scope_.allowed.end()) {
            std::string hint = instead_of_name(bare, [](std::string_view) { return false; });
            if (hint.empty()) hint = did_you_mean(bare, known);
            throw ParseError(begin, "unknown function " + in_quotes(full) + (hint.empty() ? the_functions() : hint));
        }
        for (const auto& [word, symbol] : scope_.allowed) known.push_back(word);
        known.emplace_back("pi");
        std::vector<std::string> rates;  // including rates that are not allowed here
        for (const auto& [word, reason] : scope_.forbidden)
            if (reason.starts_with("the rate ")) rates.push_back(word);
        if (const std::string hint = rates_are_written(full, rates); !hint.empty())
            throw ParseError(begin, "unknown name " + in_quotes(full) + hint, full);
        if (peek() == '=')
            throw ParseError(begin, "write the expression alone, without " + in_quotes(full) + " and '='");
        const std::string habit = instead_of_name(
            full, [&](std::string_view word) { return scope_.allowed.find(word) != scope_.allowed.end(); });
        throw ParseError(begin, "unknown name " + in_quotes(full) + (habit.empty() ? did_you_mean(full, known) : habit),
                         full);
    }

    std::string_view text_;
    const Scope& scope_;
    Graph& graph_;
    TextParts* parts_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

// The suggested text, such as 0.5*x^2 for 0.5x²; "" if there is no suggestion that can be parsed.
std::string suggestion(std::string_view text, const Scope& scope, Graph& graph) {
    constexpr std::size_t longest = 200;  // longer texts do not fit into a message
    if (text.size() > longest) return "";
    const std::string right = repaired(text, scope);
    if (right == text) return "";
    try {
        Parser(right, scope, graph, nullptr).whole();
    } catch (const ParseError&) {
        return "";
    } catch (const ExpressionTooLarge&) {
        return "";
    }
    return "write " + right;
}

}  // namespace

Expression parse(std::string_view text, const Scope& scope, Graph& graph, TextParts* parts) {
    Parser parser(text, scope, graph, parts);
    try {
        return parser.whole();
    } catch (const ParseError& error) {
        const std::string right = error.hint.empty() ? suggestion(text, scope, graph) : "";
        if (right.empty()) throw;
        // The guess at a single name is dropped, because it would contradict the suggestion.
        const std::string message = error.what();
        const std::size_t end = std::min(message.find("; did you mean"), message.find(functions_are));
        throw ParseError(error.offset, message.substr(0, end), error.name, right);
    } catch (const ExpressionTooLarge& problem) {
        throw ParseError(parser.at(), std::string("this expression is too large: ") + problem.what());
    }
}

bool is_reserved(std::string_view name) {
    const auto is_name_of = [&](const auto& entry) { return entry.name == name; };
    return std::find(reserved.begin(), reserved.end(), name) != reserved.end() || !instead_of_corner(name).empty() ||
           std::find_if(functions.begin(), functions.end(), is_name_of) != functions.end();
}

std::vector<std::string> names_in(std::string_view text) {
    std::vector<std::string> names;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && is_name_part(text[end])) ++end;
        if (end > at && is_letter(text[at])) names.emplace_back(text.substr(at, end - at));
        at = std::max(end, at + 1);
    }
    return names;
}

bool is_name(std::string_view text) {
    return !text.empty() && is_letter(text.front()) && std::all_of(text.begin(), text.end(), is_name_part);
}

namespace {

constexpr std::string_view spaces = " \t\r\n";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(spaces);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(spaces) + 1 - first);
}

// Parses the whole text as a decimal number. One too small for a double is 0, if it is within the range of long double.
// Any other number out of range is infinite, so that it is refused.
std::optional<double> plain_number(std::string_view text) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || problem == std::errc::invalid_argument) return std::nullopt;
    if (problem == std::errc()) return value;
    long double wide = HUGE_VALL;  // unchanged by a number out of its range
    std::from_chars(text.data(), end, wide);
    return static_cast<double>(wide);
}

// The text with a decimal point, "0.4" for 0,4; "" if that is not a number.
std::string with_a_point(std::string_view text) {
    std::string other(text);
    std::replace(other.begin(), other.end(), ',', '.');
    return other != text && plain_number(other) ? other : "";
}

// A text as shown in a message: truncated, with control characters replaced.
std::string shown(std::string_view text) {
    constexpr std::size_t most = 60;
    std::string result;
    for (const char c : text.substr(0, most)) result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    while (text.size() > most && !result.empty() && (static_cast<unsigned char>(result.back()) & 0x80) != 0)
        result.pop_back();  // possibly an incomplete UTF-8 sequence
    return "'" + result + (text.size() > most ? "...'" : "'");
}

[[noreturn]] void fail(std::string_view text, std::size_t offset, const std::string& why, std::string_view name = {},
                       std::string_view hint = {}) {
    throw ParseError(offset, shown(text) + " is not a finite number" + (why.empty() ? "" : ": " + why), name, hint);
}

}  // namespace

void allow_units(Scope& scope, std::string_view unit, Graph& graph) {
    const Expression degree = graph.pi() / graph.number(180);
    const bool is_rate = unit == "rad/s" && scope.allowed.find("s") == scope.allowed.end();  // else deg/s divides by s
    for (const std::string word : {"deg", "\u00b0", "rad"}) {
        const Expression factor = word == "rad" ? graph.number(1) : degree;
        if (unit == "rad" || unit == "rad/s")
            scope.units.emplace(word, factor);
        else
            scope.forbidden.emplace(word, in_quotes(word) + " is allowed only where the unit is rad, and here it " +
                                              (unit.empty() ? "is not" : "is " + std::string(unit)));
        if (is_rate) scope.units.emplace(word + "/s", factor);
    }
}

bool has_names(std::string_view text) {
    const std::vector<std::string> names = names_in(text);
    return std::any_of(names.begin(), names.end(), [](const std::string& name) {
        const auto is_it = [&](const Function& function) { return function.name == name; };
        constexpr std::string_view of_numbers[] = {"pi", "deg", "rad", "inf", "nan"};
        return std::find(std::begin(of_numbers), std::end(of_numbers), name) == std::end(of_numbers) &&
               std::none_of(functions.begin(), functions.end(), is_it);
    });
}

ParsedNumber read_number(std::string_view whole, std::string_view unit) {
    const FloatEnvironmentGuard ground;
    const std::string_view text = trimmed(whole);
    const auto begin = text.empty() ? 0 : static_cast<std::size_t>(text.data() - whole.data());
    if (text.empty()) throw ParseError(0, "a number is missing");
    ParsedNumber given;
    if (const auto plain = plain_number(text)) {
        if (!std::isfinite(*plain)) fail(text, begin, "");
        given.value = *plain;
        return given;
    }
    if (const std::string better = with_a_point(text); !better.empty())
        fail(text, begin, "write a decimal point, " + better);
    Graph graph;
    Scope scope;
    allow_units(scope, unit, graph);
    try {
        given.value = value_of_constant(parse(text, scope, graph));
    } catch (const ParseError& error) {
        const bool is_unknown = !error.name.empty() && !scope.forbidden.contains(error.name);
        // Functions are not suggested: without parentheses, ten is not a misspelling of tan.
        const std::vector<std::string> known{"pi"};
        fail(text, begin + error.offset,
             is_unknown ? "pi is the only name allowed here" + did_you_mean(error.name, known) : error.what(),
             error.name, error.hint);
    }
    if (!std::isfinite(given.value)) fail(text, begin, "");
    // No other name of the language contains these letters.
    given.has_pi = text.find("pi") != text.npos;
    for (const auto& [word, factor] : scope.units) given.has_unit = given.has_unit || text.find(word) != text.npos;
    return given;
}

}  // namespace achilles
