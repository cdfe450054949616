#include "expression/repair.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "expression/expression.hpp"
#include "expression/name_suggestions.hpp"

namespace achilles {

namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_name_part(char c) { return is_letter(c) || is_digit(c) || c == '_'; }

std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == text.npos) return "";
    return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first));
}

bool is_function(std::string_view word) {
    return std::any_of(functions.begin(), functions.end(), [&](const Function& one) { return one.name == word; });
}

// Index of the bracket that closes the one at `open`; npos if there is none.
std::size_t closing(std::string_view text, std::size_t open) {
    const char opens = text[open], closes = opens == '(' ? ')' : '}';
    int depth = 0;
    for (std::size_t i = open; i < text.size(); ++i) {
        if (text[i] == opens) ++depth;
        if (text[i] == closes && --depth == 0) return i;
    }
    return text.npos;
}

// ---- LaTeX ----

// Removes LaTeX: \frac{a}{b} becomes (a)/(b), \dot{x} and \dot x become x', x_{1} becomes x_1. Other commands lose
// their backslash.
std::string without_latex(std::string text) {
    if (text.find('\\') == text.npos) return text;
    std::erase(text, '$');
    for (const std::string_view idle : {"\\left", "\\right", "\\,", "\\;", "\\!", "\\ "})
        for (std::size_t at = text.find(idle); at != text.npos; at = text.find(idle, at)) text.erase(at, idle.size());
    for (std::size_t at = text.find("_{"); at != text.npos; at = text.find("_{", at + 1))
        if (const std::size_t end = text.find('}', at); end != text.npos)
            text = text.substr(0, at + 1) + text.substr(at + 2, end - at - 2) + text.substr(end + 1);
    for (const std::string_view fraction : {"\\frac{", "\\dfrac{", "\\tfrac{"})
        for (std::size_t at = text.find(fraction); at != text.npos; at = text.find(fraction)) {
            const std::size_t open = at + fraction.size() - 1, end = closing(text, open);
            if (end == text.npos || end + 1 >= text.size() || text[end + 1] != '{') return text;
            text = text.substr(0, at) + "(" + text.substr(open + 1, end - open - 1) + ")/" + text.substr(end + 1);
        }
    for (std::size_t at = text.find("\\dot"); at != text.npos; at = text.find("\\dot")) {
        std::size_t begin = std::min(text.find_first_not_of(' ', at + 4), text.size()), end = begin;
        if (begin < text.size() && text[begin] == '{') {
            end = closing(text, begin++);
            if (end == text.npos) return text;
        } else {
            if (end < text.size() && text[end] == '\\') ++end;
            while (end < text.size() && is_name_part(text[end])) ++end;
        }
        const std::string name = text.substr(begin, end - begin);
        text.replace(at, std::min(text.size(), end + (text[begin - 1] == '{')) - at, name + "'");
    }
    for (const std::string_view product : {"\\cdot", "\\times"})
        for (std::size_t at = text.find(product); at != text.npos; at = text.find(product))
            text.replace(at, product.size(), "*");
    std::replace(text.begin(), text.end(), '\\', ' ');
    return text;
}

// ---- signs ----

constexpr std::array<std::string_view, 10> superscripts{"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                        "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};

// The digits of the superscripts at the start of `rest`, such as "-1" for ⁻¹, and their size in bytes.
std::pair<std::string, std::size_t> exponent_of(std::string_view rest) {
    std::string digits;
    std::size_t size = 0;
    if (rest.starts_with("\u207b")) digits = "-", size = 3;
    for (bool found = true; found;) {
        found = false;
        for (std::size_t i = 0; i < superscripts.size() && !found; ++i) {
            if (!rest.substr(size).starts_with(superscripts[i])) continue;
            digits += static_cast<char>('0' + i);
            size += superscripts[i].size();
            found = true;
        }
    }
    return digits == "-" ? std::pair<std::string, std::size_t>{} : std::pair{digits, size};
}

std::string with_plain_signs(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        const std::string_view rest = text.substr(i);
        if (const auto [digits, size] = exponent_of(rest); size > 0) {
            result += digits[0] == '-' ? "^(" + digits + ")" : "^" + digits;
            i += size;
            continue;
        }
        const auto letter = std::find_if(greek_letters.begin(), greek_letters.end(),
                                         [&](const auto& one) { return rest.starts_with(one.second); });
        if (letter != greek_letters.end()) {
            if (!result.empty() && is_name_part(result.back())) result += ' ';
            result += letter->first;
            i += letter->second.size();
            if (i < text.size() && is_letter(text[i])) result += ' ';
            continue;
        }
        const bool is_last = rest.find_first_not_of(" \t\r\n", 1) == rest.npos;
        const std::size_t before = result.find_last_not_of(' ');
        if (rest[0] == '%' && is_last && before != result.npos && is_digit(result[before])) {  // 60%
            result.resize(before + 1);
            result += "/100";
            ++i;
            continue;
        }
        const bool is_between_digits = i > 0 && rest.size() > 1 && is_digit(text[i - 1]) && is_digit(rest[1]);
        const bool is_decimal = i > 0 && is_digit(text[i - 1]) && rest[0] == '.';  // 2.*x
        if (rest[0] == ',' && is_between_digits) {
            result += '.';
            ++i;
        } else if (const Habit* sign = is_decimal ? nullptr : sign_at(rest); sign != nullptr && !sign->right.empty()) {
            result += sign->right;
            i += sign->written.size();
        } else {
            result += text[i++];
        }
    }
    return result;
}

// ---- tokens ----
struct Token {
    enum class Kind { number, name, sign } kind;
    std::string text;
    bool has_space;  // preceded by white space
};

std::vector<Token> tokens_of(std::string_view text) {
    std::vector<Token> tokens;
    bool has_space = false;
    for (std::size_t i = 0; i < text.size();) {
        if (std::isspace(static_cast<unsigned char>(text[i])) != 0) {
            has_space = true;
            ++i;
            continue;
        }
        std::size_t end = i;
        Token::Kind kind = Token::Kind::sign;
        if (is_digit(text[i]) || (text[i] == '.' && i + 1 < text.size() && is_digit(text[i + 1]))) {
            kind = Token::Kind::number;
            while (end < text.size() && (is_digit(text[end]) || text[end] == '.')) ++end;
            std::size_t power = end + 1;
            if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
                if (power < text.size() && (text[power] == '-' || text[power] == '+')) ++power;
                if (power < text.size() && is_digit(text[power]))
                    for (end = power; end < text.size() && is_digit(text[end]);) ++end;
            }
        } else if (is_letter(text[i])) {
            kind = Token::Kind::name;
            while (end < text.size() && is_name_part(text[end])) ++end;
            while (end < text.size() && text[end] == '\'') ++end;
        } else {
            end = i + 1;
            while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
        }
        tokens.push_back({kind, std::string(text.substr(i, end - i)), has_space});
        has_space = false;
        i = end;
    }
    return tokens;
}

std::string text_of(const std::vector<Token>& tokens) {
    std::string text;
    for (const Token& token : tokens) text += (token.has_space && !text.empty() ? " " : "") + token.text;
    return text;
}

// ---- words ----
class TokenRepair {
 public:
    TokenRepair(std::vector<Token> tokens, const Scope& scope) : tokens_(std::move(tokens)), scope_(scope) {}

    std::vector<Token> repaired() {
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            if (tokens_[i].kind != Token::Kind::name) continue;
            drop_module(i);
            drop_instant(i);
            list(i);
            rename(i);
            if (is_function(tokens_[i].text)) call(i);
        }
        std::vector<Token> result;
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            if (i > 0 && is_product(i)) result.push_back({Token::Kind::sign, "*", false});
            result.push_back(tokens_[i]);
            if (i > 0 && is_product(i)) result.back().has_space = false;
        }
        return result;
    }

 private:
    using Kind = Token::Kind;

    bool is(std::size_t i, std::string_view text) const { return i < tokens_.size() && tokens_[i].text == text; }
    bool is_known(std::string_view name) const {
        return scope_.allowed.find(name) != scope_.allowed.end() ||
               scope_.forbidden.find(name) != scope_.forbidden.end() || name == "pi";
    }
    bool is_listed(std::string_view name) const { return scope_.listed.find(name) != scope_.listed.end(); }
    bool is_rate(std::string_view name) const {
        return name.ends_with('\'') && scope_.allowed.find(name) != scope_.allowed.end();
    }

    // Index of the parenthesis that closes the one at `open`; the number of tokens if there is none.
    std::size_t closing(std::size_t open) const {
        int depth = 0;
        for (std::size_t i = open; i < tokens_.size(); ++i) {
            if (is(i, "(")) ++depth;
            if (is(i, ")") && --depth == 0) return i;
        }
        return tokens_.size();
    }

    void erase(std::size_t from, std::size_t to) {
        tokens_.erase(tokens_.begin() + static_cast<std::ptrdiff_t>(from),
                      tokens_.begin() + static_cast<std::ptrdiff_t>(to));
    }
    void insert(std::size_t at, const char* sign) {
        tokens_.insert(tokens_.begin() + static_cast<std::ptrdiff_t>(at), {Kind::sign, sign, false});
    }

    // np.sin(x) becomes sin(x).
    void drop_module(std::size_t i) {
        constexpr std::array<std::string_view, 7> modules{"np", "numpy", "math", "Math", "sympy", "sp", "cmath"};
        if (std::find(modules.begin(), modules.end(), tokens_[i].text) == modules.end() || !is(i + 1, ".")) return;
        const bool has_space = tokens_[i].has_space;
        erase(i, i + 2);
        if (i < tokens_.size()) tokens_[i].has_space = has_space;
    }

    // x(t) and x(end) become x.
    void drop_instant(std::size_t i) {
        const bool is_instant = is(i + 2, "t") || is(i + 2, "T") || is(i + 2, "end");
        if (scope_.allowed.contains(tokens_[i].text) && is(i + 1, "(") && is_instant && is(i + 3, ")"))
            erase(i + 1, i + 4);
    }

    // zeno_time 1, zeno_time1 and zeno_time_1 become zeno_time(1).
    void list(std::size_t i) {
        std::string& word = tokens_[i].text;
        if (is_listed(word) && i + 1 < tokens_.size() && tokens_[i + 1].kind == Kind::number) {
            word += "(" + tokens_[i + 1].text + ")";
            return erase(i + 1, i + 2);
        }
        const std::size_t digits = word.find_last_not_of("0123456789") + 1;
        if (digits == word.size() || is_known(word)) return;
        const std::string bare = word.substr(0, digits - (word[digits - 1] == '_' ? 1 : 0));
        if (is_listed(bare)) word = bare + "(" + word.substr(digits) + ")";
    }

    void rename(std::size_t i) {
        std::string& word = tokens_[i].text;
        if (is_known(word) || is_function(word) || is_listed(word) || word.ends_with(')')) return;
        std::string lower = word;
        for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (lower.starts_with("arc") && is_function("a" + lower.substr(3))) word = "a" + lower.substr(3);
        if (is_function(lower) && (is(i + 1, "(") || is(i + 1, "["))) word = lower;
        if (lower == "ln") word = "log";
        if ((lower == "pow" || lower == "power") && is(i + 1, "(")) return write_power(i);
        if (lower == "e" && is(i + 1, "^")) {
            word = "exp";
            return erase(i + 1, i + 2);
        }
        if (is_derivative(lower, i)) {
            word = tokens_[i + 2].text + "'";
            return erase(i + 1, closing(i + 1) + 1);
        }
        std::vector<std::string> rates;
        for (const auto& [name, symbol] : scope_.allowed)
            if (is_rate(name)) rates.push_back(name);
        const bool is_of_one = word != "v" || rates.size() == 1;
        if (const std::string rate = rate_meant(word, rates); !rate.empty() && is_of_one)
            word = rate;
        else if (const std::string product = as_product(word); !product.empty())
            word = product;
    }

    // True for der(x) and diff(x, t), if x has a rate.
    bool is_derivative(std::string_view word, std::size_t i) const {
        constexpr std::array<std::string_view, 6> words{"der", "diff", "dot", "d", "ddt", "derivative"};
        return std::find(words.begin(), words.end(), word) != words.end() && is(i + 1, "(") && i + 2 < tokens_.size() &&
               is_rate(tokens_[i + 2].text + "'") &&
               (is(i + 3, ")") || (is(i + 3, ",") && is(i + 4, "t") && is(i + 5, ")")));
    }

    // pow(a, b) becomes ((a)^(b)); names and numbers need no parentheses.
    void write_power(std::size_t i) {
        const std::size_t close = closing(i + 1);
        std::size_t comma = i + 2;
        for (int depth = 0; comma < close && (depth > 0 || !is(comma, ",")); ++comma)
            depth += is(comma, "(") ? 1 : is(comma, ")") ? -1 : 0;
        if (close == tokens_.size() || comma >= close) return;
        const bool has_space = tokens_[i].has_space, is_simple = comma == i + 3, is_plain = close == comma + 2;
        tokens_[comma + 1].has_space = false;
        if (is_plain) erase(close, close + 1);
        tokens_[comma] = {Kind::sign, "^", false};
        if (!is_plain) insert(comma + 1, "(");
        if (!is_simple) insert(comma, ")");
        erase(i, i + (is_simple ? 2 : 1));
        tokens_[i].has_space = has_space;
    }

    // sin x becomes sin(x), and sin^2(x) and sin^2 x become sin(x)^2.
    void call(std::size_t i) {
        std::string exponent;
        if (is(i + 1, "^") && i + 2 < tokens_.size() && tokens_[i + 2].kind == Kind::number) {
            exponent = tokens_[i + 2].text;
            erase(i + 1, i + 3);
        }
        if (i + 1 >= tokens_.size()) return;
        if (!is(i + 1, "(")) {
            if (tokens_[i + 1].kind == Kind::sign) return;
            const bool has_factor = tokens_[i + 1].kind == Kind::number && i + 2 < tokens_.size() &&
                                    tokens_[i + 2].kind == Kind::name && !is_function(tokens_[i + 2].text);
            tokens_[i + 1].has_space = false;
            insert(i + 2 + (has_factor ? 1 : 0), ")");
            insert(i + 1, "(");
        }
        const std::size_t close = closing(i + 1);
        if (exponent.empty() || close == tokens_.size()) return;
        insert(close + 1, "^");
        tokens_.insert(tokens_.begin() + static_cast<std::ptrdiff_t>(close + 2), {Kind::number, exponent, false});
    }

    // m*g*y for mgy, if this is the only way to split it into allowed names and all factors are different.
    std::string as_product(const std::string& word) const {
        constexpr std::size_t longest = 12;
        if (word.size() > longest) return "";
        std::vector<std::string> ways(word.size() + 1);
        std::vector<int> counts(word.size() + 1);
        counts[0] = 1;
        for (std::size_t end = 1; end <= word.size(); ++end)
            for (std::size_t begin = 0; begin < end; ++begin) {
                const std::string part = word.substr(begin, end - begin);
                if (counts[begin] == 0 || scope_.allowed.find(part) == scope_.allowed.end()) continue;
                counts[end] += counts[begin];
                ways[end] = ways[begin] + (begin == 0 ? "" : "*") + part;
            }
        std::vector<std::string> factors = names_in(ways.back());
        std::sort(factors.begin(), factors.end());
        const bool is_square = std::adjacent_find(factors.begin(), factors.end()) != factors.end();
        return counts.back() == 1 && !is_square ? ways.back() : "";
    }

    // True if tokens i - 1 and i are adjacent values, which are meant as a product.
    bool is_product(std::size_t i) const {
        const Token &left = tokens_[i - 1], &right = tokens_[i];
        const bool ends = left.text == ")" || left.kind != Kind::sign;
        const bool begins = right.text == "(" || right.kind != Kind::sign;
        if (!ends || !begins || (left.kind == Kind::number && right.kind == Kind::number)) return false;
        if (left.kind == Kind::name && (is_function(left.text) || is_listed(left.text))) return false;
        return scope_.units.find(right.text) == scope_.units.end();
    }

    std::vector<Token> tokens_;
    const Scope& scope_;
};

// ---- statements ----

// y[1] becomes y, or x1 for x[1] if the scope has such a name.
std::string without_index(std::string text, const Scope& scope) {
    for (std::size_t open = text.find('['); open != text.npos; open = text.find('[', open + 1)) {
        std::size_t begin = open, end = open + 1;
        while (begin > 0 && is_name_part(text[begin - 1])) --begin;
        while (end < text.size() && is_digit(text[end])) ++end;
        const std::string name = text.substr(begin, open - begin);
        if (end == open + 1 || end == text.size() || text[end] != ']' || scope.listed.contains(name)) continue;
        const std::string whole = name + text.substr(open + 1, end - open - 1);
        const bool is_whole = scope.allowed.contains(whole);
        if (is_whole || scope.allowed.contains(name)) text.replace(begin, end + 1 - begin, is_whole ? whole : name);
    }
    return text;
}

// y >= sin(x) and y = sin(x) become y - sin(x). If the left side is not a value, as in "V =" or "h(q) =", only the
// right side is kept.
std::string without_relation(const std::string& text, const Scope& scope) {
    struct Relation {
        std::string_view sign;
        bool is_turned;
    };
    constexpr Relation relations[] = {{">=", false},    {"\u2265", false}, {">", false},  {"<=", true},
                                      {"\u2264", true}, {"<", true},       {"==", false}, {"=", false}};
    for (const Relation& relation : relations) {
        const std::size_t at = text.find(relation.sign);
        if (at == text.npos) continue;
        std::string left = trimmed(text.substr(0, at)), right = trimmed(text.substr(at + relation.sign.size()));
        if (left.empty() || right.empty() || right.find_first_of("<>=") != right.npos) return text;
        if (relation.is_turned) std::swap(left, right);
        const std::vector<std::string> names = names_in(left);
        const bool is_label = relation.sign == "=" && !names.empty() && left.starts_with(names[0]) &&
                              scope.allowed.find(names[0]) == scope.allowed.end() && !is_function(names[0]);
        if (is_label) return right;
        const bool is_sum = right.find_first_of("+-") != right.npos;
        return right == "0" ? left : left + " - " + (is_sum ? "(" + right + ")" : right);
    }
    return text;
}

}  // namespace

std::string repaired(std::string_view text, const Scope& scope) {
    std::string plain = trimmed(with_plain_signs(without_index(without_latex(std::string(text)), scope)));
    while (plain.ends_with(';') || plain.ends_with(',')) plain = trimmed(plain.substr(0, plain.size() - 1));
    return text_of(TokenRepair(tokens_of(without_relation(plain, scope)), scope).repaired());
}

namespace {

constexpr std::string_view product = "write '*' for a product", power = "write '^' for a power",
                           minus = "write the keyboard minus sign, -",
                           prime = "write the keyboard apostrophe, ' as in x'", round = "write parentheses, ( and )",
                           comparison = "write the expression alone: the contact is open where the gap is positive";

// A sign that starts with another one comes before it.
constexpr Habit signs[] = {
    {"**", power, "^"},
    {".*", "write '*'", "*"},
    {"./", "write '/'", "/"},
    {".^", "write '^'", "^"},
    {"\u00b7", product, "*"},
    {"\u00d7", product, "*"},
    {"\u2219", product, "*"},
    {"\u22c5", product, "*"},
    {"\u00f7", "write '/'", "/"},
    {"\u2212", minus, "-"},
    {"\u2013", minus, "-"},
    {"\u2014", minus, "-"},
    {"\u00b9", power, ""},
    {"\u00b2", "write ^2", ""},
    {"\u00b3", "write ^3", ""},
    {"\u2019", prime, "'"},
    {"\u2032", prime, "'"},
    {"\u00b4", prime, "'"},
    {"`", prime, "'"},
    {"\u0307", "the rate of x is written x'", "'"},
    {"\u1e8b", "the rate of x is written x'", "x'"},
    {"\u1e8f", "the rate of y is written y'", "y'"},
    {"\u221a", "write sqrt(...)", "sqrt"},
    {"\u00bd", "write 1/2", "(1/2)"},
    {"\u00a0", "write an ordinary space", " "},
    {"\u2009", "write an ordinary space", " "},
    {"\u202f", "write an ordinary space", " "},
    {"[", round, "("},
    {"{", round, "("},
    {"]", round, ")"},
    {"}", round, ")"},
    {"<", comparison, ""},
    {">", comparison, ""},
    {"=", "write the expression alone, without a name and =", ""},
    {"\u2264", comparison, ""},
    {"\u2265", comparison, ""},
    {";", "leave out the semicolon", ""},
    {"\\dot", "the rate of x is written x'", ""},
    {"\\", "expressions are not LaTeX", ""},
};

// Smooth approximations of functions with corners or jumps.
constexpr std::string_view for_abs = "sqrt(x^2 + w^2) approximates |x| for small w";
constexpr std::string_view for_step = "(1 + tanh(x/w))/2 approximates a step at x = 0 for small w";
constexpr std::string_view for_mod = "write a periodic function with sin and cos";
constexpr Habit corners[] = {
    {"abs", for_abs},
    {"min",
     "write one [[constraint]] for each of two gaps; elsewhere (a + b - sqrt((a - b)^2 + w^2))/2 approximates min(a, "
     "b) for small w"},
    {"max", "(a + b + sqrt((a - b)^2 + w^2))/2 approximates max(a, b) for small w"},
    {"floor", for_step},
    {"ceil", for_step},
    {"round", for_step},
    {"sign", "tanh(x/w) approximates sign(x) for small w"},
    {"mod", for_mod},
    {"fmod", for_mod},
};

struct OtherName {
    std::string_view written, known, hint;
};

// A hint is given if the scope has the name `known`; if `known` is empty, always.
constexpr OtherName names[] = {
    {"h", "gap", "the gap is called gap"},
    {"hdot", "gap'", "the rate of the gap is called gap'"},
    {"dh", "gap'", "the rate of the gap is called gap'"},
    {"hddot", "gap''", "the acceleration of the gap is called gap''"},
    {"force", "lambda", "the contact force is called lambda"},
    {"F", "lambda", "the contact force is called lambda"},
    {"E", "energy", "the energy is called energy"},
    {"time", "t", "time is called t"},
    {"zeno", "zeno_points",
     "write zeno_time(1) for the time of the first Zeno point, or zeno_points for how many there are"},
    {"impact", "impacts", "write impact_time(1), or impacts for their number"},
    {"bounces", "impacts", "write impacts"},
    {"bounce", "impacts", "write impact_time(1), or impacts for their number"},
    {"collisions", "impacts", "write impacts"},
    {"release", "releases", "write release_time(1), or releases for their number"},
    {"min_gap", "least_gap", "write least_gap"},
    {"status", "zeno_points", "write outcome"},
    {"result", "zeno_points", "write outcome"},
    {"np", "", "write the function without a prefix: sin(x)"},
    {"numpy", "", "write the function without a prefix: sin(x)"},
    {"math", "", "write the function without a prefix: sin(x)"},
    {"Math", "", "write the function without a prefix: sin(x)"},
    {"ln", "", "did you mean 'log'?"},
    {"log10", "", "log is the natural logarithm: write log(x)/log(10)"},
    {"log2", "", "log is the natural logarithm: write log(x)/log(2)"},
    {"pow", "", "write x^2 for a power"},
    {"atan2", "", "atan takes one argument: write atan(y/x), valid for x > 0"},
    {"sec", "", "write 1/cos(x)"},
    {"csc", "", "write 1/sin(x)"},
    {"cot", "", "write cos(x)/sin(x)"},
    {"if", "", "a jump is not smooth: (1 + tanh(x/w))/2 approximates a step at x = 0 for small w"},
};

}  // namespace

const Habit* sign_at(std::string_view rest) {
    for (const Habit& habit : signs)
        if (rest.starts_with(habit.written)) return &habit;
    return nullptr;
}

std::string instead_of_sign(std::string_view rest) {
    if (rest.size() > 1 && rest[0] == ',' && rest[1] >= '0' && rest[1] <= '9') return "; write a decimal point";
    const Habit* const sign = sign_at(rest);
    return sign == nullptr ? "" : "; " + std::string(sign->instead);
}

std::string instead_of_name(std::string_view name, const std::function<bool(std::string_view)>& is_known) {
    for (const OtherName& other : names)
        if (name == other.written && (other.known.empty() || is_known(other.known)))
            return "; " + std::string(other.hint);
    return "";
}

std::string_view instead_of_corner(std::string_view name) {
    for (const Habit& corner : corners)
        if (corner.written == name) return corner.instead;
    return {};
}

}  // namespace achilles
