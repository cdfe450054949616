// The tables behind Graph, for the files of this folder only.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <utility>

#include "expression/expression.hpp"

namespace achilles {

using Rational = boost::multiprecision::cpp_rational;

// Limits of a graph. A chain of twelve links in relative angles needs more than a million nodes, certificates included.
// A larger input is rejected within seconds. The size of an exact number is that of its numerator and denominator
// together.
inline constexpr std::size_t max_nodes = 6000000;
inline constexpr std::size_t max_bits = 1 << 14, max_bits_in_all = 1 << 26;

// Hash set of ids with open addressing: copying a graph then copies plain memory.
class IdSet {
 public:
    // The entry with this hash for which same(id) holds. If there is none, the free entry, which holds `none`; the
    // caller writes the new id there, after a call of room().
    template <class Same>
    std::uint32_t& find(std::uint64_t hash, const Same& same) {
        std::size_t at = hash & (places_.size() - 1);
        while (places_[at] != none && !same(places_[at])) at = (at + 1) & (places_.size() - 1);
        return places_[at];
    }
    // Makes room for one more id when there are `count`; hash_of(id) returns the hash of an id.
    template <class HashOf>
    void room(std::size_t count, const HashOf& hash_of) {
        if (2 * count < places_.size()) return;
        const std::vector<std::uint32_t> old(2 * places_.size(), none);
        const std::vector<std::uint32_t> ids = std::exchange(places_, old);
        for (const std::uint32_t id : ids)
            if (id != none) find(hash_of(id), [](std::uint32_t) { return false; }) = id;
    }
    static constexpr std::uint32_t none = 0xFFFFFFFF;

 private:
    std::vector<std::uint32_t> places_ = std::vector<std::uint32_t>(64, none);  // a power of two
};

struct Graph::Table {
    std::vector<Node> nodes;
    std::vector<Rational> numbers;
    std::vector<std::uint32_t> number_nodes;  // the node of each number
    IdSet node_ids, number_ids;               // ids of nodes, indices into numbers
    std::size_t bits_in_all = 0;              // of all numbers requested so far: arithmetic costs in proportion

    // The node with this content, created if it does not exist. Throws ExpressionTooLarge.
    std::uint32_t intern(const Node& node);
    std::uint32_t intern(const Rational& value);
};

// Creates nodes without simplification, and reads their contents.
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

// For every node up to the last output: true if an output needs it.
std::vector<bool> reachable(std::span<const Expression> outputs);

}  // namespace achilles
