// The folder listing below a path field. The last part of the path filters the entries.
#pragma once

#include <string>
#include <vector>

#include "session/folder_entries.hpp"

namespace achilles {

// State of the listing: the folder, its entries and the selected row.
struct BrowserState {
    std::string folder, letters;  // to which the rows belong
    std::vector<std::string> endings;
    bool is_hidden = false;
    std::vector<FolderEntry> all, rows;
    double read_at = -1.0;  // s, ImGui time; below 0: read again
    int chosen = -1;        // -1 until an arrow key is pressed
    bool scrolls = false;   // scroll to the selected row
    std::string line;       // new content of the field, if `rewrites`
    bool rewrites = false, focuses = false;
    bool selects = false;  // select the whole proposed text
    bool tab = false;      // Tab was pressed and there was nothing to complete
};

}  // namespace achilles
