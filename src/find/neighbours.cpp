// Neighbour lists of pairs, in CSR form.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "broadside/error.hpp"
#include "broadside/within.hpp"

#include "core/message.hpp"
#include "find/deliver.hpp"

namespace broadside {

void detail::check_neighbour_count(std::size_t boxes) {
  // On a 32-bit system, boxes + 1 must fit into a std::size_t.
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() - 1;
  if (std::uint64_t{boxes} > most)
    throw InvalidFrame(core::message({"neighbour lists of ", boxes, " boxes; expected at most 4294967294"}));
}

void detail::set_neighbours(std::span<const Pair> sorted, bool is_full, std::span<std::size_t> offsets,
                            std::span<BoxId> neighbours) {
  const std::size_t boxes = offsets.size() - 1;
  find::check_ids(sorted, boxes, is_full ? boxes : std::numeric_limits<std::size_t>::max());
  // offsets[i + 1] becomes the begin of box i, and, as its neighbours are written, its end.
  std::fill(offsets.begin(), offsets.end(), 0);
  const auto count = [&](BoxId box) {
    if (index(box) + std::size_t{2} < offsets.size()) ++offsets[index(box) + std::size_t{2}];
  };
  for (const Pair pair : sorted) {
    count(pair.first);
    if (is_full) count(pair.second);
  }
  for (std::size_t i = 2; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  // A box's lesser neighbours come before its greater ones, in the order of the pairs.
  for (const Pair pair : sorted) {
    neighbours[offsets[index(pair.first) + std::size_t{1}]++] = pair.second;
    if (is_full) neighbours[offsets[index(pair.second) + std::size_t{1}]++] = pair.first;
  }
}

}  // namespace broadside
