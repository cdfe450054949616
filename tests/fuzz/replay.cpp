// Runs a fuzz target without libFuzzer: every file of the folders unchanged, then COUNT mutated ones. A fixed seed
// gives the same inputs on every machine. The random engine is used directly, since the distributions of the standard
// library may differ.
// usage: fuzz_TARGET COUNT DICTIONARY FOLDER...
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
// A target may define its own mutator, as for libFuzzer.
extern "C" std::size_t LLVMFuzzerCustomMutator
    [[gnu::weak]] (std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);

namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t largest_growth = 64;  // of an input by one mutation, bytes

std::mt19937 engine(1);
std::vector<Bytes> words;   // of the dictionary
std::vector<Bytes> inputs;  // the files of the folders

// A random number in 0 .. n - 1.
std::size_t random_below(std::size_t n) { return engine() % n; }

std::span<const std::uint8_t> piece_of_any_input(std::size_t length) {
    const std::span<const std::uint8_t> input = inputs[random_below(inputs.size())];
    const std::size_t at = random_below(input.size() + 1);
    return input.subspan(at, std::min(length, input.size() - at));
}

Bytes bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// The words of a libFuzzer dictionary: one per line, in quotes, with the escapes \xAB, \" and \\.
std::vector<Bytes> words_of(const fs::path& dictionary) {
    std::vector<Bytes> result;
    std::ifstream file(dictionary);
    for (std::string line; std::getline(file, line);) {
        const std::size_t open = line.find('"'), close = line.rfind('"');
        if (line.starts_with('#') || open == close) continue;
        Bytes word;
        for (std::size_t i = open + 1; i < close; ++i) {
            if (line[i] == '\\' && line[i + 1] == 'x') {
                word.push_back(static_cast<std::uint8_t>(std::stoi(line.substr(i + 2, 2), nullptr, 16)));
                i += 3;
            } else {
                word.push_back(static_cast<std::uint8_t>(line[i] == '\\' ? line[++i] : line[i]));
            }
        }
        result.push_back(word);
    }
    if (result.empty()) throw std::runtime_error("no words in " + dictionary.string());
    return result;
}

std::vector<Bytes> inputs_in(const fs::path& folder) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file()) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<Bytes> result;
    for (const fs::path& path : paths) result.push_back(bytes_of(path));
    return result;
}

// Writes the current input to a file, so that it remains if the process ends. The file stays open, since some file
// systems write to the disk whenever a truncated file is closed.
class Attempt {
 public:
    explicit Attempt(const fs::path& program)
        : path_(program.string() + ".input"), file_(path_, std::ios::binary | std::ios::trunc) {}

    void operator()(const Bytes& input) {
        file_.seekp(0);
        file_.write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size())).flush();
        if (!file_) throw std::runtime_error("cannot write " + path_.string());
        fs::resize_file(path_, input.size());
        LLVMFuzzerTestOneInput(input.data(), input.size());
        ++count_;
    }
    std::size_t count() const { return count_; }
    void clear() const { fs::remove(path_); }

 private:
    fs::path path_;
    std::ofstream file_;
    std::size_t count_ = 0;
};

Bytes mutated(Bytes input) {
    const std::size_t size = input.size();
    input.resize(size + largest_growth);
    const auto seed = static_cast<unsigned>(engine());
    input.resize(LLVMFuzzerCustomMutator != nullptr ? LLVMFuzzerCustomMutator(input.data(), size, input.size(), seed)
                                                    : LLVMFuzzerMutate(input.data(), size, input.size()));
    return input;
}

}  // namespace

// One small change: a flipped bit, or a few bytes replaced by as many, by none, by a word, or by a piece of any input.
// Returns the new size. Bytes are taken from the inputs, since few of all 256 would be accepted.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) {
    Bytes bytes(data, data + size);
    const std::size_t at = random_below(size + 1), length = std::min(size - at, random_below(5));
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    const auto put = [&](std::span<const std::uint8_t> piece) {
        bytes.insert(bytes.erase(first, first + static_cast<std::ptrdiff_t>(length)), piece.begin(), piece.end());
    };
    switch (random_below(5)) {
        case 0:
            if (at < size) bytes[at] ^= static_cast<std::uint8_t>(1u << random_below(8));
            break;
        case 1:
            put({});
            break;
        case 2:
            put(words[random_below(words.size())]);
            break;
        case 3:
            put(piece_of_any_input(length));
            break;
        default:
            put(piece_of_any_input(1 + random_below(32)));
    }
    bytes.resize(std::min(bytes.size(), most));
    std::copy(bytes.begin(), bytes.end(), data);
    return bytes.size();
}

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr, "usage: %s COUNT DICTIONARY FOLDER...\n", argv[0]);
        return 2;
    }
    words = words_of(argv[2]);
    for (int i = 3; i < argc; ++i)
        for (Bytes& input : inputs_in(argv[i])) inputs.push_back(std::move(input));
    if (inputs.empty()) throw std::runtime_error("no inputs");
    Attempt attempt(argv[0]);
    for (const Bytes& input : inputs) attempt(input);
    // Up to four changes of one input. A changed input is not kept for the next attempt, since without coverage data
    // nothing shows which are useful.
    for (int left = std::stoi(argv[1]); left > 0; --left) {
        Bytes input = inputs[random_below(inputs.size())];
        for (std::size_t changes = 1 + random_below(4); changes > 0; --changes) input = mutated(std::move(input));
        attempt(input);
    }
    attempt.clear();
    std::printf("%zu inputs of %zu files\n", attempt.count(), inputs.size());
}
