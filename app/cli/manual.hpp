// The manual: the pages of assets/manual, with the tables that the program itself has.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace achilles {

// The topics there are, with their first lines as titles, in alphabetical order.
struct ManualTopic {
    std::string name, title;
};
std::vector<ManualTopic> manual_topics();

// A page, as Markdown. A line {{NAME}} of the file becomes a table: of keys, options, functions, commands, columns, words, shortcuts.
// Throws InputError where there is no such topic, with the nearest.
std::string manual_page(std::string_view topic);

// A system file to start from, with every key; it runs as it is.
std::string skeleton_system();

}  // namespace achilles
