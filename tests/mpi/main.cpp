// The tests as an MPI program: each rank runs all of them, in the same order. A failure on any rank fails the
// program.
#include <gtest/gtest.h>
#include <mpi.h>

int main(int count, char** values) {
  MPI_Init(&count, &values);
  testing::InitGoogleTest(&count, values);
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  MPI_Finalize();
  return failed;
}
