#include "expression/habits.hpp"

namespace achilles {

namespace {

constexpr std::string_view product = "write '*' for a product", power = "write '^' for a power",
                           minus = "write the keyboard minus sign, -",
                           prime = "write the keyboard apostrophe, ' as in x'", round = "write parentheses, ( and )",
                           comparison = "write the expression alone: the contact is open where the gap is positive";

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
    {"=", "write the expression alone, without a name and =", ""},
    {"\u2264", comparison, ""},
    {"\u2265", comparison, ""},
    {";", "leave out the semicolon", ""},
    {"\\dot", "the rate of x is written x'", ""},
    {"\\", "expressions are not LaTeX", ""},
};

// What has corners or jumps.
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
            return "; " + std::string(other.told);
    return "";
}

std::string_view instead_of_corner(std::string_view name) {
    for (const Habit& corner : corners)
        if (corner.written == name) return corner.instead;
    return {};
}

}  // namespace achilles
