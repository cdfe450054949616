// What a page asks of its browser, besides what its window does (window.cpp).
#pragma once

#include <string>

namespace achilles {

// Hands a file that the explorer has written to the user, as a download.
void download(const std::string& file);
// Asks the user for a file, which is then dropped on the window.
void choose_file();

}  // namespace achilles
