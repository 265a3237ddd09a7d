// Components: the connected components of pairs, without keeping these.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "broadside/export.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// Finds the connected components of a graph whose nodes are the boxes of one set and whose edges are the
/// pairs that it is given, in any order and any number of times. Takes 4 bytes per box and thread, and
/// nothing per pair.
///
/// A union-find with path halving (Tarjan and van Leeuwen 1984). The root of a component is its least id, so
/// labels do not depend on the order of pairs.
class BROADSIDE_PUBLIC Components final : public PairSink {
 public:
  /// Every box is a component of its own. Throws InvalidFrame for more than 2^32 - 1 boxes.
  explicit Components(std::size_t boxes);

  /// For each box, the least id of the boxes in its component. Flushes the sink.
  ///
  /// Throws InvalidFrame, as the sink does when it is flushed, if a pair has an id that is not below the
  /// number of boxes.
  [[nodiscard]] std::vector<BoxId> labels();

  [[nodiscard]] std::unique_ptr<PairSink> empty_clone() const override;
  void merge(PairSink& clone) override;

 private:
  void consume(std::span<const Pair> pairs) override;
  BoxId root(BoxId box) noexcept;
  void unite(BoxId a, BoxId b) noexcept;

  std::vector<BoxId> parents_;  // never greater than the box itself
};

/// For each box, the least index in its connected component. The edges are the pairs of find_pairs(). Each
/// absent box is a component of its own. Throws what find_pairs() throws.
///
///     const std::vector<BoxId> cluster = components(boxes);
template <BoxRange Boxes>
[[nodiscard]] std::vector<BoxId> components(const Boxes& boxes, const FindOptions& options = {}) {
  Components found(detail::box_count(boxes));
  find_pairs(boxes, static_cast<PairSink&>(found), options);
  return found.labels();
}

}  // namespace broadside
