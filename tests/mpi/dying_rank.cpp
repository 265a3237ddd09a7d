// A program of which the last rank is killed while it searches its part, as by a machine that fails: the
// others wait for its pairs. program_test.cpp looks at what they say.
#include <csignal>
#include <cstdio>
#include <optional>
#include <span>
#include <vector>

#include <mpi.h>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/mpi.hpp"

namespace broadside {
namespace {

/// Kills the last rank as it searches.
class DyingSearcher final : public Searcher<2> {
 public:
  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& pairs) override {
    int rank = 0;
    int ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (rank == ranks - 1) std::raise(SIGKILL);
    return finder_.find(input.boxes, pairs);
  }

 private:
  Finder<2> finder_{"brute_force"};
};

void join() {
  register_algorithm({.name = "dying",
                      .summary = "kills the last rank",
                      .source = "this test",
                      .in_2d = {.searcher = make_strategy<DyingSearcher>}});
  const std::vector<Box2> boxes(3);
  mpi::find_pairs(
      MPI_COMM_WORLD, boxes, [](std::span<const LargePair>) { std::puts("was given pairs"); },
      mpi::Options{.algorithm = "dying"});
}

}  // namespace
}  // namespace broadside

int main(int count, char** values) {
  int provided = MPI_THREAD_SINGLE;  // more is needed: a rank searches by several threads
  MPI_Init_thread(&count, &values, MPI_THREAD_FUNNELED, &provided);
  broadside::join();
  std::puts("came to the end");
  MPI_Finalize();
  return 0;
}
