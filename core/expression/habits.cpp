#include "expression/habits.hpp"

namespace achilles {

namespace {

constexpr std::string_view product = "write '*' for a product", power = "write '^' for a power",
                           minus = "write the minus sign of the keyboard, -",
                           prime = "write the apostrophe of the keyboard, ' as in x'",
                           round = "write round parentheses, ( and )",
                           comparison = "an expression stands alone: a gap is open where it is positive";

// The longer ones first.
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
    {"=", "an expression stands alone, without a name and =", ""},
    {"\u2264", comparison, ""},
    {"\u2265", comparison, ""},
    {";", "nothing ends an expression", ""},
    {"\\dot", "the rate of x is written x'", ""},
    {"\\", "expressions are not LaTeX", ""},
};

// What has corners or jumps.
constexpr std::string_view for_abs = "sqrt(x^2 + w^2) is nearly |x|, with a small w";
constexpr std::string_view for_step = "a step at x = 0 is nearly (1 + tanh(x/w))/2, with a small w";
constexpr std::string_view for_mod = "what repeats is made of sin and cos";
constexpr Habit corners[] = {
    {"abs", for_abs},
    {"min",
     "two gaps are two [[constraint]]; else (a + b - sqrt((a - b)^2 + w^2))/2 is nearly min(a, b), with a small w"},
    {"max", "(a + b + sqrt((a - b)^2 + w^2))/2 is nearly max(a, b), with a small w"},
    {"floor", for_step},
    {"ceil", for_step},
    {"round", for_step},
    {"sign", "tanh(x/w) is nearly sign(x), with a small w"},
    {"mod", for_mod},
    {"fmod", for_mod},
};

struct OtherName {
    std::string_view written, known, told;
};

// Said where the second name has a meaning; where that is empty, always.
constexpr OtherName names[] = {
    {"h", "gap", "the gap is called gap"},
    {"hdot", "gap'", "the rate of the gap is called gap'"},
    {"dh", "gap'", "the rate of the gap is called gap'"},
    {"hddot", "gap''", "the acceleration of the gap is called gap''"},
    {"force", "lambda", "the contact force is called lambda"},
    {"F", "lambda", "the contact force is called lambda"},
    {"E", "energy", "it is called energy"},
    {"time", "t", "time is called t"},
    {"zeno", "zeno_points", "write zeno_time(1), or zeno_points for how many"},
    {"impact", "impacts", "write impact_time(1), or impacts for how many"},
    {"bounces", "impacts", "write impacts"},
    {"bounce", "impacts", "write impact_time(1), or impacts for how many"},
    {"collisions", "impacts", "write impacts"},
    {"release", "releases", "write release_time(1), or releases for how many"},
    {"min_gap", "least_gap", "write least_gap"},
    {"status", "zeno_points", "write outcome"},
    {"result", "zeno_points", "write outcome"},
    {"np", "", "functions stand alone: sin(x)"},
    {"numpy", "", "functions stand alone: sin(x)"},
    {"math", "", "functions stand alone: sin(x)"},
    {"Math", "", "functions stand alone: sin(x)"},
    {"ln", "", "did you mean 'log'?"},
    {"log10", "", "log is the natural logarithm: log(x)/log(10)"},
    {"log2", "", "log is the natural logarithm: log(x)/log(2)"},
    {"pow", "", "a power is written x^2"},
    {"atan2", "", "atan takes one argument: atan(y/x), where x > 0"},
    {"sec", "", "write 1/cos(x)"},
    {"csc", "", "write 1/sin(x)"},
    {"cot", "", "write cos(x)/sin(x)"},
    {"if", "", "what jumps is not smooth: a step at x = 0 is nearly (1 + tanh(x/w))/2, with a small w"},
};

}  // namespace

const Habit* sign_at(std::string_view rest) {
    for (const Habit& habit : signs)
        if (rest.starts_with(habit.written)) return &habit;
    return nullptr;
}

std::string instead_of_sign(std::string_view rest) {
    if (rest.size() > 1 && rest[0] == ',' && rest[1] >= '0' && rest[1] <= '9') return "; decimals have a point";
    const Habit* const sign = sign_at(rest);
    return sign == nullptr ? "" : "; " + std::string(sign->instead);
}

std::string instead_of_name(std::string_view name, const std::function<bool(std::string_view)>& is_known) {
    for (const OtherName& other : names)
        if (name == other.written && (other.known.empty() || is_known(other.known)))
            return "; " + std::string(other.told);
    return "";
}

std::string_view instead_of_corner(std::string_view name) {
    for (const Habit& corner : corners)
        if (corner.written == name) return corner.instead;
    return {};
}

}  // namespace achilles
