// A page with all pictures that differ from their golden files, the worst first. Tests run in parallel: each writes an
// entry to its own folder and then collects all entries.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "golden/goldens.hpp"

namespace achilles::golden {

// Lock of the report; only one of all test programs can hold it at a time.
class ReportLock {
 public:
    explicit ReportLock(const std::filesystem::path& report);
    ~ReportLock();
    ReportLock(const ReportLock&) = delete;
    ReportLock& operator=(const ReportLock&) = delete;

 private:
    int file_;
};

// Writes the entry of one picture to its folder, which has the files that it shows.
void write_entry(const std::filesystem::path& folder, const std::string& name, double score,
                 const std::vector<Finding>& findings);

// Writes index.html from all entries below the report's folder.
void write_page(const std::filesystem::path& report);

}  // namespace achilles::golden
