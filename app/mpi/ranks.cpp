#include "mpi/ranks.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "mpi/module.hpp"
#include "system/description.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

std::optional<int> number_in(const char* variable) {
    const char* const text = std::getenv(variable);
    if (text == nullptr || *text == '\0') return {};
    char* end = nullptr;
    const long number = std::strtol(text, &end, 10);
    if (*end != '\0' || number < 0 || number > std::numeric_limits<int>::max()) return {};
    return static_cast<int>(number);
}

[[noreturn]] void cannot_share(const Launch& launch, const std::string& why) {
    throw InputError(
        {}, {},
        fmt::format("{} processes were started, but they cannot share a sweep: {}",
                    launch.size > 0 ? std::to_string(launch.size) : "several", why),
        "a single process uses all cores of a machine; with ACHILLES_MPI=0 each process runs the whole sweep");
}

const AchillesMpi* load(const Launch& launch) {
    constexpr const char* name = "libachilles_mpi.so";
    std::error_code problem;
    const fs::path folder = fs::read_symlink("/proc/self/exe", problem).parent_path();
    const fs::path installed = folder.parent_path() / ACHILLES_MODULE_FOLDER / name;
    const fs::path file = fs::exists(folder / name, problem) ? folder / name : installed;
    if (!fs::exists(file, problem))
        cannot_share(launch, fmt::format("{} is missing (it is built if libopenmpi-dev is installed)", file.string()));
    // RTLD_GLOBAL: MPI's plug-ins need its symbols.
    void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (module == nullptr) cannot_share(launch, dlerror());
    const auto functions = reinterpret_cast<decltype(&achilles_mpi)>(dlsym(module, "achilles_mpi"));
    if (functions == nullptr || functions()->version != achilles_mpi_version)
        cannot_share(launch, file.string() + " is of another version");
    return functions();
}

}  // namespace

std::optional<Launch> find_launch() {
    if (number_in("ACHILLES_MPI") == 0) return {};
    struct Variables {
        const char *rank, *size;
        bool has_mpi;
    };
    // In this order: Open MPI; MPICH, Intel MPI and srun --mpi=pmi2; srun --mpi=pmix; srun without a connection.
    constexpr std::array<Variables, 4> known{{{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", true},
                                              {"PMI_RANK", "PMI_SIZE", true},
                                              {"PMIX_RANK", "SLURM_STEP_NUM_TASKS", true},
                                              {"SLURM_PROCID", "SLURM_STEP_NUM_TASKS", false}}};
    for (const Variables& variables : known) {
        const std::optional<int> rank = number_in(variables.rank), size = number_in(variables.size);
        if (!rank || (!size && !variables.has_mpi)) continue;
        if (size == 1) return {};
        return Launch{*rank, size.value_or(0), variables.has_mpi};
    }
    return {};
}

Ranks::Ranks(const Launch& launch) {
    if (!launch.has_mpi)
        cannot_share(launch, "the processes cannot reach each other; start them with: srun --mpi=pmix");
    mpi_ = load(launch);
    mpi_->begin(&rank_, &size_, &cores_);
    if (launch.size > 0 && launch.size != size_) {
        mpi_->end();
        cannot_share(
            launch,
            fmt::format(
                "each process finds {} through MPI; use the mpirun of the MPI that ldd libachilles_mpi.so names",
                size_));
    }
}

Ranks::~Ranks() {
    if (rank_ == 0) dismiss(*this);
    if (!is_left_) mpi_->end();  // waits for all ranks
}

void Ranks::send(int to, std::string_view bytes) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw std::runtime_error("the results of a chunk exceed 2 GB, the most that MPI can send");
    mpi_->send(to, bytes.data(), static_cast<int>(bytes.size()));
}

std::optional<Messages::RankMessage> Ranks::receive() {
    RankMessage letter;
    const int size = mpi_->next(&letter.from);
    if (size < 0) return {};
    letter.bytes.resize(static_cast<std::size_t>(size));
    mpi_->receive(letter.bytes.data());
    return letter;
}

}  // namespace achilles
