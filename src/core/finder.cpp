// PairFinder: what every finder does before its algorithm sees the boxes.
#include <algorithm>

#include "broadside/broad_phase.hpp"
#include "broadside/error.hpp"

#include "core/input_check.hpp"

namespace broadside {
namespace {

/// Passes pairs on under other ids. The ids must rise with the places they stand for, so that pairs stay
/// ordered.
class RenamingSink final : public PairSink {
 public:
  RenamingSink(std::span<const BoxId> ids, PairSink& target) : ids_(ids), target_(&target) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    while (!pairs.empty()) {
      const std::size_t count = std::min(pairs.size(), max_room);
      Pair* const out = target_->room(count);
      for (std::size_t i = 0; i < count; ++i)
        out[i] = {ids_[index(pairs[i].first)], ids_[index(pairs[i].second)]};
      target_->commit(count);
      pairs = pairs.subspan(count);
    }
  }

  std::span<const BoxId> ids_;
  PairSink* target_;
};

}  // namespace

template <int D>
void PairFinder<D>::find(std::span<const Box<D>> boxes, PairSink& pairs) {
  core::check_count(boxes.size());
  const std::size_t absent = core::check_boxes(boxes);
  statistics_.reset();
  try {
    if (absent == 0) {
      find_valid(boxes, pairs);
    } else {
      present_.clear();
      ids_.clear();
      present_.reserve(boxes.size() - absent);
      ids_.reserve(boxes.size() - absent);
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!is_present(boxes[i])) continue;
        present_.push_back(boxes[i]);
        ids_.push_back(BoxId(i));
      }
      RenamingSink renamed(ids_, pairs);
      find_valid(present_, renamed);
      renamed.flush();
    }
    pairs.flush();
  } catch (...) {
    pairs.discard();
    throw;
  }
}

template class PairFinder<2>;
template class PairFinder<3>;

}  // namespace broadside
