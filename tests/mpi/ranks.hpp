// This rank, the others, and boxes shared out among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include <mpi.h>

namespace broadside {

inline int rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

inline int ranks() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// How boxes are shared out.
enum class Share { evenly, all_to_the_last, some_have_none };

/// Where the boxes of `rank` begin; those of ranks() are at the end.
inline std::size_t begin_of(Share share, std::size_t count, int of_rank) {
  const auto number = static_cast<std::size_t>(of_rank);
  const auto all = static_cast<std::size_t>(ranks());
  if (number == all) return count;
  if (share == Share::evenly) return count * number / all;
  if (share == Share::all_to_the_last) return 0;
  // Each second one, and the later ones more.
  const std::size_t pair_of_ranks = number / 2 * 2;
  return count * pair_of_ranks * pair_of_ranks / (all * all);
}

template <typename Box>
std::vector<Box> own_of(Share share, const std::vector<Box>& boxes) {
  const auto begin = [&](int of_rank) {
    return boxes.begin() + static_cast<std::ptrdiff_t>(begin_of(share, boxes.size(), of_rank));
  };
  return {begin(rank()), begin(rank() + 1)};
}

/// The message of what `work` throws as an Error; empty, or that of another exception, where it throws none
/// such.
template <typename Error, typename Work>
std::string thrown(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("another exception: ") + error.what();
  }
  return {};
}

}  // namespace broadside
