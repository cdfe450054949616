// Runs the program as a user does: by a shell, in a temporary folder, and returns status and output.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace achilles::test {

// A small system file.
inline const std::string drop_text = R"(title = "A ball dropped on the floor"
[[coordinate]]
name = "y"
start = 1.0
[lagrangian]
kinetic = "y'^2/2"
potential = "9.81*y"
[[constraint]]
gap = "y"
restitution = 0.5
)";

struct Answer {
    int status = -1;
    std::string out, err;
};

inline std::string content(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// A temporary folder, removed with this object; programs run in it.
class Folder {
 public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "achilles_XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) std::abort();
        path_ = name;
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_)) names.push_back(entry.path().filename());
        return names;
    }

    void put(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }

    // `arguments` in shell syntax; `before`: variables to set.
    Answer run(const std::string& arguments, const std::string& before = {}) const {
        const Folder answers;
        const std::string command =
            "cd '" + path_.string() + "' && " + before + " timeout 60 '" ACHILLES_BINARY_DIR "/achilles' " + arguments +
            " >'" + (answers.path() / "out").string() + "' 2>'" + (answers.path() / "err").string() + "' </dev/null";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(answers.path() / "out"),
                content(answers.path() / "err")};
    }

 private:
    std::filesystem::path path_;
};

}  // namespace achilles::test
