// C interface of the MPI module. Only the library libachilles_mpi.so includes <mpi.h> and is linked with MPI. It is
// loaded only if the program was started by mpirun.
#pragma once

extern "C" {

struct AchillesMpi {
    int version;  // of this interface
    // Call once, from the thread that makes all later calls. cores: this process's share of the available cores.
    void (*begin)(int* rank, int* size, int* cores);
    // Returns when `bytes` may be reused. Sleeps while it waits, to leave the processor to computations.
    void (*send)(int to, const void* bytes, int size);
    // Size and sender of a message that has arrived; -1: none. receive() then returns its bytes.
    int (*next)(int* from);
    void (*receive)(void* bytes);
    void (*end)();
};
constexpr int achilles_mpi_version = 1;

const AchillesMpi* achilles_mpi();
}
