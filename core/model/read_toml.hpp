// Reading one TOML table with errors that teach: for description.cpp only.
#pragma once

#include <toml++/toml.h>

#include <initializer_list>

#include "model/description.hpp"

namespace achilles {

// One table of a system file. Every getter throws the description's InputError where the value is not what it should
// be.
class TableReader {
 public:
    // `name` is how messages call the table, e.g. "[[coordinate]]". Keys that are not in `known` are errors.
    TableReader(const SystemDescription& description, const toml::table& table, std::string name,
                std::initializer_list<std::string_view> known);

    Location at() const;  // of the table itself
    const toml::node* find(std::string_view key) const { return table_.get(key); }
    const toml::node& require(std::string_view key) const;

    std::string string(std::string_view key) const;  // required
    std::string string(std::string_view key, const std::string& otherwise) const;
    double number(std::string_view key, double otherwise) const;
    double positive(std::string_view key, double otherwise) const;
    bool boolean(std::string_view key, bool otherwise) const;
    std::array<double, 2> range(std::string_view key, std::array<double, 2> otherwise) const;
    Text text(std::string_view key) const;  // required: a string or a number
    std::array<Text, 2> pair(const toml::node& node, std::string_view key) const;
    // The tables of an array of tables; none if the key is absent.
    std::vector<const toml::table*> tables(std::string_view key) const;

    Text text_of(const toml::node& node, std::string_view key) const;
    [[noreturn]] void fail(const toml::node& node, const std::string& message, const std::string& hint = {}) const;
    [[noreturn]] void fail(Location at, const std::string& message, const std::string& hint = {}) const;

 private:
    const SystemDescription& description_;
    const toml::table& table_;
    std::string name_;
};

Location location_of(const toml::node& node);
// The first character inside a string's quotes.
Location inside_quotes(const toml::node& node, const std::string& source);

}  // namespace achilles
