// A user's MPI program: docs/distributed.md has it.
#include <cstdio>
#include <vector>

#include <broadside/distributed_world.hpp>
#include <broadside/mpi.hpp>

int main(int count, char** values) {
  MPI_Init(&count, &values);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  {
    const auto x = static_cast<float>(rank);
    const std::vector<broadside::Box2> boxes = {{{x, 0}, {x + 1, 1}}};  // one a rank, in a row
    for (const auto& [a, b] : broadside::mpi::find_pairs(MPI_COMM_WORLD, boxes))
      std::printf("%d has %d and %d\n", rank, int(a), int(b));

    broadside::mpi::DistributedWorld<2> world(MPI_COMM_WORLD);
    world.add(static_cast<std::uint64_t>(rank), boxes[0]);
    for (const auto& [a, b] : world.update().begun) std::printf("%d touches %d\n", int(a), int(b));
  }
  MPI_Finalize();
  return 0;
}
