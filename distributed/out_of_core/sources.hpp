// The boxes that a join reads: from one source or from two, validated, and sampled for the first cuts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/out_of_core.hpp"

namespace broadside::out_of_core {

template <int D, typename Real>
class Sources {
 public:
  explicit Sources(std::vector<detail::BoxPieces<D, Real>*> sources) : sources_(std::move(sources)) {}

  std::size_t size() const noexcept { return sources_.size(); }

  /// The approximate total number of boxes; 0 if unknown.
  std::uint64_t estimated_boxes() const {
    std::uint64_t estimated = 0;
    for (const detail::BoxPieces<D, Real>* const source : sources_) estimated += source->estimated_size();
    return estimated;
  }

  /// Calls visit(boxes, first) for all boxes of a source, in pieces; `first` is the id of boxes[0]. Returns
  /// the number of boxes.
  template <typename Visit>
  std::uint64_t for_each_piece(std::size_t source, const Visit& visit) const {
    std::uint64_t first = 0;
    sources_[source]->visit([&](std::span<const Box<D, Real>> piece) {
      visit(piece, first);
      first += piece.size();
      return true;
    });
    return first;
  }

  /// The first boxes of both sources.
  struct SampledBoxes {
    std::vector<Box<D, Real>> boxes;
    bool is_all = true;  ///< whether these are all boxes
  };
  SampledBoxes sample(std::size_t max_boxes) const {
    SampledBoxes sample;
    for (std::size_t source = 0; source < sources_.size(); ++source) {
      const std::size_t max_yet = max_boxes * (source + 1) / sources_.size();
      sources_[source]->visit([&](std::span<const Box<D, Real>> piece) {
        if (sample.boxes.size() < max_yet)
          sample.boxes.insert(sample.boxes.end(), piece.begin(), piece.end());
        return sample.boxes.size() < max_yet;
      });
      if (sample.boxes.size() >= max_yet) sample.is_all = false;
    }
    return sample;
  }

  /// Throws InvalidInput unless each box is valid or absent; `first` is the id of boxes[0].
  void check(std::span<const Box<D, Real>> boxes, std::uint64_t first, std::size_t source) const {
    const char* const set = sources_.size() == 1 ? "box " : source == 0 ? "left box " : "right box ";
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (is_present(boxes[i]) || is_absent(boxes[i])) continue;
      const std::uint64_t id = first + i;
      throw InvalidInput(
          static_cast<std::size_t>(id),
          set + std::to_string(id) + " has a NaN or min > max; expected min <= max, or the absent box");
    }
  }

 private:
  std::vector<detail::BoxPieces<D, Real>*> sources_;
};

}  // namespace broadside::out_of_core
