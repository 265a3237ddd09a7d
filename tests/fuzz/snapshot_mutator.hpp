// Changes a snapshot's fields by their meaning: one pair more, a box elsewhere, a slot in another state. What
// it makes has the right shape, so it is the contradictions that a reader has to find.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "history_bytes.hpp"
#include "snapshot_fields.hpp"

namespace broadside::fuzz {

/// Takes what it does from `bytes`. Both outlive it.
template <int D, typename Real>
class SnapshotMutator {
 public:
  using Fields = SnapshotFields<D, Real>;

  SnapshotMutator(Fields& fields, Bytes& bytes) : fields_(fields), bytes_(bytes) {}

  /// Changes one thing.
  void mutate();

 private:
  using Pairs = std::vector<Pair>;

  std::array<Pairs*, 12> pair_lists();
  std::size_t slots() const;
  /// Mostly one that there is; now and then the first behind the end, or one far off.
  std::uint32_t slot();
  Pair pair();
  template <typename T>
  typename std::vector<T>::iterator any(std::vector<T>& list);
  /// Mostly sorted and without duplicates, as a reader wants it.
  template <typename T>
  void tidy(std::vector<T>& list);
  void change_pairs();
  void change_slots();
  Box<D, Real> box();
  void change_box();
  /// Mostly with what goes with the state.
  void change_state();
  void change_generation();
  void change_filter();
  /// With the arrays that they ask for.
  void change_flags();
  void change_options();
  /// One more, or one less.
  void change_slot_count();
  void change_last_frame();
  void change_mark();
  /// Makes what can be counted agree again.
  void agree();

  Fields& fields_;
  Bytes& bytes_;
};

}  // namespace broadside::fuzz
