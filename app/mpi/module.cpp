#include "mpi/module.hpp"

#include <mpi.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <list>
#include <vector>

// MPI reports its errors itself and ends all processes.

namespace {

// An equal share of the cores that the processes on this machine may use, but not more than this process may use:
// mpirun may have bound each process to some cores.
int share_of_cores() {
    cpu_set_t own, all;
    CPU_ZERO(&own);
    CPU_ZERO(&all);
    sched_getaffinity(0, sizeof own, &own);
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    int processes = 1;
    MPI_Comm_size(machine, &processes);
    MPI_Allreduce(&own, &all, static_cast<int>(sizeof own), MPI_BYTE, MPI_BOR, machine);
    MPI_Comm_free(&machine);
    return std::max(1, std::min(CPU_COUNT(&own), CPU_COUNT(&all) / processes));
}

void begin(int* rank, int* size, int* cores) {
    // Open MPI searches for fast networks for 0.25 s, which a few messages per second do not need. A user setting takes
    // precedence.
    ::setenv("OMPI_MCA_pml", "ob1", 0);
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, rank);
    MPI_Comm_size(MPI_COMM_WORLD, size);
    *cores = share_of_cores();
}

void send(int to, const void* bytes, int size) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Isend(bytes, size, MPI_BYTE, to, 0, MPI_COMM_WORLD, &request);
    for (int has_gone = 0;;) {
        MPI_Test(&request, &has_gone, MPI_STATUS_IGNORE);
        if (has_gone != 0) return;  // NOLINT: MPI_Test has completed it
        ::usleep(200);
    }
}

// A message being received. If its sender is killed, the rest never arrives; nothing waits for that.
struct PendingMessage {
    std::vector<char> bytes;
    int from = 0;
    MPI_Request request = MPI_REQUEST_NULL;
};
std::list<PendingMessage> coming;
std::list<PendingMessage>::iterator come;  // the complete one

int next(int* from) {
    int is_there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &is_there, &status);
    if (is_there != 0) {
        int size = 0;
        MPI_Get_count(&status, MPI_BYTE, &size);
        PendingMessage& one = coming.emplace_back();
        one.bytes.resize(static_cast<std::size_t>(size));
        one.from = status.MPI_SOURCE;
        MPI_Irecv(one.bytes.data(), size, MPI_BYTE, one.from, 0, MPI_COMM_WORLD, &one.request);
    }
    for (come = coming.begin(); come != coming.end(); ++come) {  // NOLINT: MPI_Test completes it
        int is_all = 0;
        MPI_Test(&come->request, &is_all, MPI_STATUS_IGNORE);
        if (is_all == 0) continue;
        *from = come->from;
        return static_cast<int>(come->bytes.size());
    }
    return -1;
}

void receive(void* bytes) {
    std::copy(come->bytes.begin(), come->bytes.end(), static_cast<char*>(bytes));
    coming.erase(come);
}

void end() { MPI_Finalize(); }

}  // namespace

const AchillesMpi* achilles_mpi() {
    static const AchillesMpi functions{achilles_mpi_version, begin, send, next, receive, end};
    return &functions;
}
