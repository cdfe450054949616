// Which ending of a file's name goes with which kind of picture.
#pragma once

#include <string>

namespace achilles {

// The ending of a name in small letters, without its dot: "svg"; empty where it has none.
std::string ending_of(const std::string& file);

// "png", "svg" or "pdf", by the ending, in letters of either case; empty: the name says none of these.
std::string ending_of_picture(const std::string& file);

// What --out will hold: `wanted`, or where that is empty what its name says. Standard output, `-`, says nothing and is a PNG
// then. Throws InputError where the name says another kind than is wanted, or none is wanted and it says none; `advice` is
// added to what would be right.
std::string format_for(const std::string& out, const std::string& wanted, const std::string& advice = {});

}  // namespace achilles
