#include "golden/report.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace achilles::golden {

namespace {

namespace fs = std::filesystem;

constexpr const char* entry_name = "entry.html";

constexpr const char* head =
    "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Pictures that differ</title>\n"
    "<style>body{font:15px sans-serif;margin:2em}pre{background:#f2f2f2;padding:.6em;overflow:auto}"
    "figure{display:inline-block;width:32%;margin:0 .3em 0 0}img{width:100%;border:1px solid #bbb}"
    "h2{margin-top:2em}</style>\n<h1>Pictures that differ, the worst first</h1>\n";

struct Entry {
    double score = 0.0;
    std::string name, html;
};

std::string escaped(const std::string& text) {
    std::string html;
    for (const char c : text) html += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    return html;
}

// Reads an entry, whose first line is the score.
Entry read_entry(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    Entry entry;
    std::string score;
    std::getline(stream, score);
    std::getline(stream, entry.name);
    entry.score = std::strtod(score.c_str(), nullptr);  // "inf" too
    entry.html.assign(std::istreambuf_iterator<char>(stream), {});
    return entry;
}

}  // namespace

ReportLock::ReportLock(const fs::path& report) : file_(-1) {
    fs::create_directories(report);
    const fs::path file = report / "lock";
    file_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (file_ < 0 || ::flock(file_, LOCK_EX) != 0) throw std::runtime_error(file.string() + ": cannot be locked");
}

ReportLock::~ReportLock() { ::close(file_); }

void write_entry(const fs::path& folder, const std::string& name, double score, const std::vector<Finding>& findings) {
    std::string html =
        fmt::format("<h2>{}</h2>\n<p>{:.3g} times what is allowed in its worst image</p>\n", escaped(name), score);
    for (const Finding& finding : findings)
        html += fmt::format("<pre><b>{}</b>: {}</pre>\n", escaped(finding.file), escaped(finding.what));
    std::vector<std::pair<std::string, fs::path>> images;  // sorted by layer, then before, now, difference
    for (const auto& entry : fs::directory_iterator(folder)) {
        const fs::path image = entry.path().filename(), of = image.stem().stem();
        const fs::path kind = image.stem().extension();
        const int order = kind == ".golden" ? 0 : kind == ".actual" ? 1 : 2;
        if (image.extension() == ".png") images.emplace_back(fmt::format("{} {}", of.string(), order), image);
    }
    std::sort(images.begin(), images.end());
    for (const auto& [order, image] : images)
        html += fmt::format(
            "<figure><a href=\"{0}/{1}\"><img src=\"{0}/{1}\" alt=\"\"></a><figcaption>{1}</figcaption>"
            "</figure>\n",
            name, image.string());
    std::ofstream(folder / entry_name, std::ios::binary) << score << '\n' << name << '\n' << html;
}

void write_page(const fs::path& report) {
    std::vector<Entry> entries;
    for (const auto& file : fs::recursive_directory_iterator(report))
        if (file.path().filename() == entry_name) entries.push_back(read_entry(file.path()));
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.score != b.score ? a.score > b.score : a.name < b.name; });
    const fs::path page = report / "index.html";
    if (entries.empty()) {
        fs::remove(page);
        return;
    }
    std::string html = head;
    for (const Entry& entry : entries) html += entry.html;
    std::ofstream(page, std::ios::binary) << html;
}

}  // namespace achilles::golden
