// An expression graph: immutable, shared nodes with exact rational constants.
//
// Nodes live in a Graph and are hash-consed: equal expressions are the same node, so equality is a comparison of ids
// Nodes live in a Graph and are hash-consed: equal expressions are the same node. Equality is therefore a comparison of
// ids, and every common subexpression is stored once. Operands always have smaller ids than their node, so every pass
// over a graph (derivative, substitution, compilation) is a loop without recursion, and deep nesting cannot overflow
// the stack.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {

enum class Operation : std::uint8_t {
    number,  // exact rational constant
    pi,      // the circle constant
    symbol,  // an input variable, identified by its slot
    add,
    subtract,
    multiply,
    divide,
    negate,
    power,       // integer exponent, |exponent| >= 2
    real_power,  // a^b for a > 0, both operands nodes
    sqrt,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    exp,
    log,
    midpoint  // a number near a, constant in time and in all variables; it cannot be typed
};
constexpr bool is_function(Operation operation) { return operation >= Operation::sqrt; }
constexpr bool is_binary(Operation operation) {
    return operation == Operation::add || operation == Operation::subtract || operation == Operation::multiply ||
           operation == Operation::divide || operation == Operation::real_power;
}
constexpr bool is_leaf(Operation operation) {
    return operation == Operation::number || operation == Operation::pi || operation == Operation::symbol;
}

class Graph;

// A node of a graph. A small value: copy it freely. It must not outlive its graph.
class Expression {
 public:
    Expression() = default;
    Expression(Graph* graph, std::uint32_t id) : graph_(graph), id_(id) {}

    Graph& graph() const { return *graph_; }
    std::uint32_t id() const { return id_; }
    bool is_zero() const;
    bool is_one() const;
    bool is_number() const;
    friend bool operator==(const Expression&, const Expression&) = default;

 private:
    Graph* graph_ = nullptr;
    std::uint32_t id_ = 0;
};

// Thrown by every function that creates nodes if a graph would hold too many nodes, or too many digits of exact
// numbers. what() is "it takes more than ...".
struct ExpressionTooLarge : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Arithmetic creates nodes and simplifies locally: constants are folded, 0 and 1 vanish, x - x = 0, equal factors are
// merged.
Expression operator+(Expression a, Expression b);
Expression operator-(Expression a, Expression b);
Expression operator*(Expression a, Expression b);
Expression operator/(Expression a, Expression b);  // throws std::domain_error for the constant divisor 0
Expression operator-(Expression a);
Expression power(Expression base, int exponent);
Expression real_power(Expression base, Expression exponent);  // base > 0; integers and 1/2 become power and sqrt
Expression apply(Operation function, Expression argument);    // one of sqrt ... log

// A number near x whose value does not matter: its derivatives are 0, and over intervals it is the midpoint. For
// expressions that have the same value whatever this number is, such as C (C'MC)^-1 C' = M^-1 with a good choice of C.
Expression midpoint(Expression x);

// A rational constant in the forms that the scalar types need.
struct Constant {
    double nearest;         // rounded to nearest
    double low, high;       // low <= exact value <= high, equal where a double is exact
    std::string numerator;  // exact, decimal digits
    std::string denominator;
};

class Graph {
 public:
    Graph();
    Graph(const Graph&);  // ids are valid in the copy: see adopt()
    Graph& operator=(const Graph&) = delete;
    ~Graph();

    Expression number(long numerator, long denominator = 1);
    // The exact value of a decimal literal such as 12, 0.5 or 1e-3. Throws std::out_of_range if the exponent exceeds
    // +-400.
    Expression decimal(std::string_view digits);
    Expression pi();
    Expression symbol(std::uint32_t slot);
    // The node with the same id, for an expression of a graph that was copied to or from this one.
    Expression adopt(Expression other) { return {this, other.id()}; }

    struct Node {
        Operation operation;
        std::uint32_t a = 0;  // first operand; the slot of a symbol; the table index of a number
        std::uint32_t b = 0;  // second operand
        std::int32_t exponent = 0;
    };
    const Node& node(std::uint32_t id) const;
    std::uint32_t size() const;
    Constant constant(std::uint32_t id) const;  // requires a number node

 private:
    friend class Expression;
    friend struct Builder;
    struct Table;
    std::unique_ptr<Table> table_;
};

// The derivative of each expression along a direction: the sum over i of direction[i] times the derivative by the symbol
// of slots[i]. One pass over the graph computes all of them.
std::vector<Expression> derivative_along(std::span<const Expression> expressions, std::span<const std::uint32_t> slots,
                                         std::span<const Expression> direction);
// d(expression)/d(symbol `slot`). For a list, all derivatives are taken in one pass.
Expression derivative(Expression expression, std::uint32_t slot);
std::vector<Expression> derivative(std::span<const Expression> expressions, std::uint32_t slot);
// The same for each slot of a list. Each row of a Jacobian belongs to an expression, each column to a slot.
std::vector<Expression> gradient(Expression expression, std::span<const std::uint32_t> slots);
std::vector<std::vector<Expression>> jacobian(std::span<const Expression> expressions,
                                              std::span<const std::uint32_t> slots);

// Substitutes values[i] for the symbol of slots[i]. A list is substituted in one pass.
Expression substitute(Expression expression, std::span<const std::uint32_t> slots, std::span<const Expression> values);
std::vector<Expression> substitute(std::span<const Expression> expressions, std::span<const std::uint32_t> slots,
                                   std::span<const Expression> values);

// True if the expression depends on any of these symbols.
bool depends_on(Expression expression, std::span<const std::uint32_t> slots);

// True if the expression depends on no symbol.
bool is_constant(Expression expression);
// The value of a constant expression in double arithmetic; NaN for any other expression.
double value_of_constant(Expression expression);
// The value in double arithmetic with the values of symbols by slot; NaN if it depends on another symbol.
double value_of(Expression expression, std::span<const double> symbols);

// The expression as text that parse() can read; symbols print as names[slot].
std::string to_text(Expression expression, std::span<const std::string> names);

// The functions of the input language: name, operation and value in double arithmetic.
struct Function {
    std::string_view name;
    Operation operation;
    double (*value)(double);
};

inline constexpr std::array<Function, 12> functions{{
    {"sqrt", Operation::sqrt, std::sqrt},
    {"sin", Operation::sin, std::sin},
    {"cos", Operation::cos, std::cos},
    {"tan", Operation::tan, std::tan},
    {"asin", Operation::asin, std::asin},
    {"acos", Operation::acos, std::acos},
    {"atan", Operation::atan, std::atan},
    {"sinh", Operation::sinh, std::sinh},
    {"cosh", Operation::cosh, std::cosh},
    {"tanh", Operation::tanh, std::tanh},
    {"exp", Operation::exp, std::exp},
    {"log", Operation::log, std::log},
}};

}  // namespace achilles
