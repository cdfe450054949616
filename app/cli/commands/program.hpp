// The program as a function.
#pragma once

#include <string>
#include <vector>

namespace achilles {

// Runs one command line, without the program's name. Returns the exit status (commands.hpp). What is wrong with the command
// line or with a file is one message on standard error, and status 2.
int run_program(const std::vector<std::string>& words);

}  // namespace achilles
