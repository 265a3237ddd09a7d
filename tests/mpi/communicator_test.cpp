// A communicator whose MPI fails in the middle of an exchange: no request is left pending, since the caller
// frees the buffers. The two calls below stand before those of MPI, as its profiling interface allows.
#include "distributed/mpi/communicator.hpp"

#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mpi/ranks.hpp"

namespace {

bool do_sends_fail = false;
std::vector<MPI_Request> waited_for;

}  // namespace

extern "C" int MPI_Isend(const void* bytes, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
                         MPI_Request* request) {
  return do_sends_fail ? MPI_ERR_OTHER : PMPI_Isend(bytes, count, type, to, tag, comm, request);
}

extern "C" int MPI_Waitall(int count, MPI_Request* requests, MPI_Status* statuses) {
  waited_for.assign(requests, requests + count);
  return PMPI_Waitall(count, requests, statuses);
}

namespace broadside {
namespace {

TEST(Communicator, LeavesNoReceivePendingWhereASendFails) {
  if (ranks() == 1) return;
  mpi::Communicator comm(MPI_COMM_WORLD);
  const std::vector<std::vector<int>> to(comm.size(), std::vector<int>(1000, rank()));
  waited_for.clear();
  do_sends_fail = true;
  EXPECT_THAT(thrown<std::runtime_error>([&] { comm.exchange(to); }), testing::HasSubstr("MPI_Isend failed"));
  do_sends_fail = false;
  std::erase(waited_for, MPI_REQUEST_NULL);
  EXPECT_EQ(waited_for.size(), comm.size() - 1) << "one from each other rank";
  // What was cancelled takes nothing of what comes next.
  const mpi::Communicator::Received<int> received = comm.exchange(to);
  received.for_each(rank(), [](int value, std::uint32_t from) { ASSERT_EQ(value, static_cast<int>(from)); });
}

}  // namespace
}  // namespace broadside
