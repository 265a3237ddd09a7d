// Measures how well results are checked: corruptions [COUNT] (default: 10,000). Corrupts the output of
// searches and trackers at random (a pair dropped, duplicated or swapped in one search or frame) and counts
// how many corruptions `compare` detects: when it checks by definition, when it cross-checks, and when the
// reference has the same fault. Exits with 1 if a fault of an algorithm alone is missed.
#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/corrupted.hpp"
#include "bench/guarded.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"

namespace broadside::bench {
namespace {

constexpr std::size_t at_once = 25;

/// Distributes `count` corruptions over algorithms, dimensions and scenes.
CorruptionCounts corrupt_own(std::size_t count, bool moves, std::size_t definition_boxes) {
  const std::vector<std::string> algorithms = {"grid", "bvh", "sweep_and_prune", "quadtree", "brute_force"};
  const std::vector<std::string> scenes = {"uniform", "clustered"};
  CorruptionCounts all;
  // Some corruptions find no pair or event to corrupt, or no later frame to repeat one in.
  for (std::size_t done = 0, turn = 0; all.applied < count; ++turn) {
    const std::size_t some = std::min(at_once, count - all.applied);
    lab::CaseRequest request{.scene = scenes[turn % 2], .dimension = turn / 2 % 2 == 0 ? 2 : 3, .boxes = 300};
    if (moves) {
      request.moving = 0.5;
      request.frames = 6;
    }
    all.add(
        compare_corrupted(algorithms[turn / 4 % algorithms.size()], request, done, some, definition_boxes));
    done += some;
  }
  return all;
}

int run(std::size_t count) {
  lab::AlignedColumns columns("<>>>");
  columns.add({"what was corrupted", "corruptions", "caught", ""});
  bool all_caught = true;
  const auto add = [&](const std::string& what, const CorruptionCounts& caught) {
    columns.add({what, lab::grouped(caught.applied), lab::grouped(caught.caught),
                 fmt::format("{:.1f} %", 100.0 * static_cast<double>(caught.caught) /
                                             static_cast<double>(std::max<std::size_t>(caught.applied, 1)))});
    return caught.applied > 0 && caught.caught == caught.applied;
  };
  for (const bool moves : {false, true}) {
    const std::string where = moves ? "a tracker's events" : "a finder's pairs";
    for (const bool by_definition : {true, false}) {
      const std::string how = by_definition ? "checked by definition" : "cross-checked";
      all_caught &= add(where + ", " + how, corrupt_own(count / 2, moves, by_definition ? 20'000 : 0));
    }
    lab::CaseRequest request{.scene = "uniform", .dimension = 2, .boxes = 2'000};
    if (moves) {
      request.moving = 0.5;
      request.frames = 6;
    }
    add(where + " and the reference's alike, cross-checked",
        compare_with_corrupted_reference(request, 0, std::max<std::size_t>(count / 50, 1)));
  }
  fmt::print("{}", columns.text(""));
  return all_caught ? 0 : 1;
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("corruptions", 2, [&] {
    const std::size_t corruptions = number_at(count, arguments, 1, 10'000);
    if (count > 2 || corruptions < 2)
      throw std::runtime_error(
          fmt::format("{} arguments; expected one, a number of corruptions from 2", count - 1));
    return run(corruptions);
  });
}
