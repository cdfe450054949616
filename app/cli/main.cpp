#include "cli/commands/commands.hpp"
#include "commit.hpp"

int main(int argc, char** argv) { return achilles::run_program({argv + 1, argv + argc}, build_commit); }
