// A program of which the last rank is killed in the middle of a join, as by a machine that fails; what others
// say then is looked at by program_test.cpp.
#include <csignal>
#include <cstdio>
#include <span>
#include <vector>

#include <mpi.h>

#include "broadside/mpi.hpp"

int main(int count, char** values) {
  MPI_Init(&count, &values);
  int rank = 0;
  int ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const std::vector<broadside::Box2> boxes(3);
  broadside::mpi::find_pairs(MPI_COMM_WORLD, boxes, [&](std::span<const broadside::LargePair>) {
    if (rank == ranks - 1) std::raise(SIGKILL);
  });
  std::puts("came to the end");
  MPI_Finalize();
  return 0;
}
