// Partitions space into a part for each rank, from a sample of all ranks' boxes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/partition.hpp"

#include "communicator.hpp"

namespace broadside::mpi {

/// Default sample size over all ranks: with 4,096 boxes per part, the number of boxes in a part is off by
/// about 2 %.
inline std::size_t default_sample(std::size_t ranks) {
  return std::max<std::size_t>(std::size_t{1} << 14, (std::size_t{1} << 12) * ranks);
}

/// Appends about `wanted` of `count` boxes by stratified sampling: a random one from each stretch. With a
/// regular step, boxes in rows and columns could all come from the same column.
template <typename Real, int D, typename BoxAt>
void add_sample(std::size_t count, std::size_t wanted, const BoxAt& box_at,
                std::vector<Box<D, Real>>& sample) {
  wanted = std::min(wanted, count);
  std::uint64_t random = 0x9e3779b97f4a7c15;
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t begin = i * count / wanted;
    const std::size_t end = (i + 1) * count / wanted;
    random = random * 0x5851f42d4c957f2d + 0x14057b7ef767814f;
    const Box<D, Real> box = box_at(begin + static_cast<std::size_t>((random >> 33) % (end - begin)));
    if (is_present(box)) sample.push_back(box);
  }
}

/// The number of sampled boxes of a rank with `mine` of `all` boxes.
inline std::size_t share_of_sample(std::size_t sample, std::uint64_t mine, std::uint64_t all) {
  if (mine == 0) return 0;
  return static_cast<std::size_t>(static_cast<double>(sample) * static_cast<double>(mine) /
                                  static_cast<double>(all)) +
         1;
}

/// Partitions space into at most one part per rank, the same on all ranks, from this rank's share of a sample
/// of `all` boxes. Rank 0 chooses the cuts, so that they agree even if ranks round differently.
template <int D, typename Real>
Partition<D, Real> cut_space(Communicator& comm, std::vector<Box<D, Real>> share, std::uint64_t all) {
  if (comm.size() == 1) return {};
  std::vector<std::vector<Box<D, Real>>> to;
  comm.together([&] {
    to.resize(comm.size());
    to[0] = std::move(share);
  });
  const std::vector<Box<D, Real>> sample = comm.exchange(std::move(to)).values;
  std::vector<typename Partition<D, Real>::Cut> cuts;
  comm.together([&] {
    if (comm.rank() != 0) return;
    const Partition<D, Real> partition(sample, comm.size(), all);
    cuts.assign(partition.cuts().begin(), partition.cuts().end());
  });
  comm.broadcast(cuts);
  Partition<D, Real> partition;
  comm.together([&] { partition = Partition<D, Real>(std::move(cuts)); });
  return partition;
}

}  // namespace broadside::mpi
