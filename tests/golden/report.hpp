// One page with every picture that is not as it was, the worst first. Tests run side by side: each leaves an entry in a
// folder of its own and then collects all there are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "golden/goldens.hpp"

namespace achilles::golden {

// Whoever writes to the report holds it, one after the other over all test programs.
class ReportLock {
 public:
    explicit ReportLock(const std::filesystem::path& report);
    ~ReportLock();
    ReportLock(const ReportLock&) = delete;
    ReportLock& operator=(const ReportLock&) = delete;

 private:
    int file_;
};

// The entry of one picture, in its folder beside the files it shows.
void write_entry(const std::filesystem::path& folder, const std::string& name, double score,
                 const std::vector<Finding>& findings);

// index.html from all entries below the report's folder.
void write_page(const std::filesystem::path& report);

}  // namespace achilles::golden
