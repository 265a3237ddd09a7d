// Speedup, communication and balance of MPI ranks: mpirun -n RANKS ranks [BOXES [ROUNDS [SCENE ...]]]. For
// 1, 2, 4, 8 ... ranks in turns, it prints the hash of the pairs, which must be the same, the bytes sent per
// box, the largest work of a rank over the mean, and the speedup over one rank.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>

#include "broadside/mpi.hpp"

#include "bench/guarded.hpp"
#include "lab/measure/benchmark.hpp"
#include "lab/numbers.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::bench {
namespace {

int rank_in(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

int size_of(MPI_Comm comm) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  return size;
}

/// Idle ranks wait here without using a core; MPI's own barriers would spin.
void wait_for_all() {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &request);
  for (int is_done = 0; is_done == 0;) {
    MPI_Test(&request, &is_done, MPI_STATUS_IGNORE);
    if (is_done == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

/// A communicator of the first ranks of the program.
struct Group {
  int ranks = 1;
  MPI_Comm comm = MPI_COMM_NULL;  ///< on the other ranks: their own communicator
  std::uint64_t pairs = 0;
  std::uint64_t hash = 0;
  mpi::Summary summary{};
  std::vector<double> milliseconds{};

  bool is_member() const { return rank_in(MPI_COMM_WORLD) < ranks; }
};

std::vector<Group> groups() {
  std::vector<Group> groups;
  for (int ranks = 1; ranks <= size_of(MPI_COMM_WORLD); ranks *= 2) {
    Group group{.ranks = ranks};
    MPI_Comm_split(MPI_COMM_WORLD, group.is_member() ? 0 : 1, rank_in(MPI_COMM_WORLD), &group.comm);
    groups.push_back(std::move(group));
  }
  return groups;
}

template <typename Box>
std::span<const Box> own_of(const Group& group, const std::vector<Box>& boxes) {
  const auto place = [&](int rank) {
    return boxes.size() * static_cast<std::size_t>(rank) / static_cast<std::size_t>(group.ranks);
  };
  const int rank = rank_in(group.comm);
  return std::span(boxes).subspan(place(rank), place(rank + 1) - place(rank));
}

/// Joins once, untimed, for the counts.
template <typename Box>
void look(Group& group, const std::vector<Box>& boxes) {
  if (group.is_member()) {
    std::uint64_t sum = 0;
    const mpi::RankStatistics statistics =
        mpi::find_pairs(group.comm, own_of(group, boxes), [&](std::span<const LargePair> pairs) {
          for (const LargePair& pair : pairs) sum += hash(pair);
        });
    MPI_Allreduce(&sum, &group.hash, 1, MPI_UINT64_T, MPI_SUM, group.comm);
    group.summary = mpi::summary(group.comm, statistics);
    group.pairs = group.summary.all.pairs;
  }
  wait_for_all();
}

/// Times one join, from the common start until the last rank has its pairs.
template <typename Box>
void measure(Group& group, const std::vector<Box>& boxes) {
  if (group.is_member()) {
    MPI_Barrier(group.comm);
    const lab::Stopwatch watch;
    std::uint64_t pairs = 0;
    mpi::find_pairs(group.comm, own_of(group, boxes),
                    [&](std::span<const LargePair> some) { pairs += some.size(); });
    MPI_Allreduce(MPI_IN_PLACE, &pairs, 1, MPI_UINT64_T, MPI_SUM, group.comm);
    group.milliseconds.push_back(watch.milliseconds());
    if (pairs != group.pairs)
      throw std::runtime_error(fmt::format("{} pairs; expected {}, as before", pairs, group.pairs));
  }
  wait_for_all();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Speedup over one rank, round by round.
std::vector<double> gains(const Group& one, const Group& several) {
  std::vector<double> gains;
  for (std::size_t round = 0; round < several.milliseconds.size(); ++round)
    gains.push_back(one.milliseconds[round] / several.milliseconds[round]);
  return gains;
}

void print(const std::vector<Group>& groups, const std::string& scene, int dimension, std::size_t boxes) {
  if (rank_in(MPI_COMM_WORLD) != 0) return;
  for (const Group& group : groups) {
    if (group.hash != groups.front().hash)
      throw std::runtime_error(fmt::format("{} ranks: hash {:016x}; expected {:016x}, as of one rank",
                                           group.ranks, group.hash, groups.front().hash));
    const double count = static_cast<double>(boxes);
    fmt::print(
        "| {} {}D | {} | {} | {:016x} | {:.2f} | {:.2f} | {:.3f} |", scene, dimension, group.ranks,
        lab::grouped(group.pairs), group.hash, static_cast<double>(group.summary.all.box_bytes) / count,
        static_cast<double>(group.summary.all.pair_bytes) / count, group.summary.largest_over_mean_work);
    if (group.milliseconds.empty()) {
      fmt::print(" | |\n");
    } else {
      const std::vector<double> all = gains(groups.front(), group);
      fmt::print(" {:.0f} | {:.2f} ({:.2f} to {:.2f}) |\n", median(group.milliseconds), median(all),
                 std::ranges::min(all), std::ranges::max(all));
    }
  }
}

template <int D>
void run(std::vector<Group>& groups, const std::string& spec, std::size_t count, std::size_t rounds) {
  const lab::NamedScene scene = lab::find_scene(spec);
  const std::vector<Box<D>> boxes = lab::make_history<D>(scene.scene, scene.spec, {.boxes = count}).boxes;
  for (Group& group : groups) {
    group.milliseconds.clear();
    look(group, boxes);
  }
  for (std::size_t round = 0; round < rounds; ++round)
    for (Group& group : groups) measure(group, boxes);
  print(groups, spec, D, boxes.size());
}

int run_all(int count, char** arguments) {
  const std::size_t boxes = number_at(count, arguments, 1, 2'000'000);
  const std::size_t rounds = number_at(count, arguments, 2, 5);
  std::vector<std::string> scenes;
  for (int i = 3; i < count; ++i) scenes.emplace_back(arguments[i]);
  if (scenes.empty()) scenes = {"uniform", "clustered"};
  std::vector<Group> all = groups();
  if (rank_in(MPI_COMM_WORLD) == 0) {
    const lab::Machine machine = lab::this_machine();
    fmt::print("{} boxes; {} rounds; revision {}; {}, {} cores; {}\n\n", lab::grouped(boxes), rounds,
               lab::this_build().revision, machine.cpu, machine.cores, lab::today());
    fmt::print(
        "| boxes | ranks | pairs | hash | bytes a box | for pairs | largest over mean | ms | times as fast "
        "|\n");
    fmt::print("| --- | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |\n");
  }
  for (const std::string& scene : scenes) {
    run<2>(all, scene, boxes, rounds);
    run<3>(all, scene, boxes, rounds);
  }
  for (Group& group : all) MPI_Comm_free(&group.comm);
  return 0;
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  int provided = MPI_THREAD_SINGLE;  // not enough: a rank searches with several threads
  MPI_Init_thread(&count, &arguments, MPI_THREAD_FUNNELED, &provided);
  const int status = guarded("ranks", 3, [&] { return run_all(count, arguments); });
  if (status != 0) MPI_Abort(MPI_COMM_WORLD, status);
  MPI_Finalize();
  return status;
}
