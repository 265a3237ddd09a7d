// The tests as an MPI program: each rank runs all of them, in the same order. A failure on any rank fails the
// program.
#include <gtest/gtest.h>
#include <mpi.h>

int main(int count, char** values) {
  int provided = MPI_THREAD_SINGLE;  // more is needed: a rank searches by several threads
  MPI_Init_thread(&count, &values, MPI_THREAD_FUNNELED, &provided);
  testing::InitGoogleTest(&count, values);
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  MPI_Finalize();
  return failed;
}
