// Contacts for tests: given by numbers, or random with random gradients.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <numeric>
#include <random>

#include "contacts/delassus.hpp"

namespace achilles {

inline ContactVector<double> numbers(std::initializer_list<double> values) {
    ContactVector<double> x(static_cast<Eigen::Index>(values.size()));
    std::copy(values.begin(), values.end(), x.data());
    return x;
}

// Delassus matrix of two contacts with W_11 = W_22 = 1.
inline ContactMatrix<double> pair_with(double W12) {
    ContactMatrix<double> W(2, 2);
    W << 1.0, W12, W12, 1.0;
    return W;
}

inline ContactSet contacts(std::initializer_list<Eigen::Index> members) {
    ContactSet set;
    for (const Eigen::Index j : members) set = with(set, j);
    return set;
}

inline ContactSet all_contacts(Eigen::Index size) {
    ContactSet set;
    for (Eigen::Index j = 0; j < size; ++j) set = with(set, j);
    return set;
}

// A random subset of the contacts.
inline ContactSet some_of(Eigen::Index size, std::mt19937& random) {
    ContactSet set;
    for (Eigen::Index j = 0; j < size; ++j)
        if (random() % 2 == 0) set = with(set, j);
    return set;
}

inline ContactMatrix<double> random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& random) {
    std::normal_distribution<double> normal;
    ContactMatrix<double> result(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i)
        for (Eigen::Index k = 0; k < columns; ++k) result(i, k) = normal(random);
    return result;
}

// A permutation of rows: row i of the result is row order[i] of the original.
using Order = std::array<Eigen::Index, 8>;
inline Order random_order(Eigen::Index size, std::mt19937& random) {
    Order order;
    std::iota(order.begin(), order.end(), 0);
    for (Eigen::Index i = size; i-- > 1;)
        std::swap(order[static_cast<std::size_t>(i)], order[random() % static_cast<std::size_t>(i + 1)]);
    return order;
}
inline Eigen::Index at(const Order& order, Eigen::Index i) { return order[static_cast<std::size_t>(i)]; }
inline ContactVector<double> renumbered(const ContactVector<double>& x, const Order& order) {
    ContactVector<double> result(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) result[i] = x[at(order, i)];
    return result;
}
inline ContactMatrix<double> renumbered(const ContactMatrix<double>& W, const Order& order) {
    ContactMatrix<double> result(W.rows(), W.cols());
    for (Eigen::Index i = 0; i < W.rows(); ++i)
        for (Eigen::Index k = 0; k < W.cols(); ++k) result(i, k) = W(at(order, i), at(order, k));
    return result;
}
inline ContactSet renumbered(ContactSet set, const Order& order, Eigen::Index size) {
    ContactSet result;
    for (Eigen::Index i = 0; i < size; ++i)
        if (contains(set, at(order, i))) result = with(result, i);
    return result;
}

}  // namespace achilles
