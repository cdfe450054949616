// Inside an expression graph: the tables behind Graph, for the files of this folder only.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <unordered_map>

#include "expression/expression.hpp"

namespace achilles {

using Rational = boost::multiprecision::cpp_rational;

struct Graph::Table {
    std::vector<Node> nodes;
    std::vector<Rational> numbers;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> index;  // hash of a node -> ids
    std::unordered_map<std::string, std::uint32_t> number_ids;            // "3/2" -> id

    // The node with this content: the one that exists, or a new one.
    std::uint32_t intern(const Node& node);
    std::uint32_t intern(const Rational& value);
};

// Makes nodes without asking whether a simpler form exists, and reads what they are made of.
struct Builder {
    static Graph::Table& table(Graph& graph) { return *graph.table_; }
    static Expression make(Graph& graph, const Graph::Node& node) { return {&graph, graph.table_->intern(node)}; }
    static Expression number(Graph& graph, const Rational& value) { return {&graph, graph.table_->intern(value)}; }
    static const Graph::Node& node(Expression e) { return e.graph().table_->nodes[e.id()]; }
    static const Rational& value(Expression e) { return e.graph().table_->numbers[node(e).a]; }
    static Expression first(Expression e) { return {&e.graph(), node(e).a}; }
    static Expression second(Expression e) { return {&e.graph(), node(e).b}; }
    static bool is(Expression e, Operation operation) { return node(e).operation == operation; }
};

constexpr bool is_function(Operation operation) { return operation >= Operation::sqrt; }
constexpr bool is_binary(Operation operation) {
    return operation == Operation::add || operation == Operation::subtract || operation == Operation::multiply ||
           operation == Operation::divide || operation == Operation::real_power;
}
constexpr bool is_leaf(Operation operation) {
    return operation == Operation::number || operation == Operation::pi || operation == Operation::symbol;
}

// For every node up to the last output: is it needed for one of them?
std::vector<bool> reachable(std::span<const Expression> outputs);

}  // namespace achilles
