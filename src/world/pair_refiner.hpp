// PairRefiner: derives a world's pairs from its tracker's pairs, by the boxes themselves and a predicate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/pair.hpp"
#include "broadside/world.hpp"

#include "world/box_table.hpp"
#include "world/pair_events.hpp"
#include "world/pair_graph.hpp"
#include "world/slot_table.hpp"

namespace broadside::world {

/// The marks of candidates: bits, as in snapshots. A pair holds if its boxes themselves overlap and the
/// predicate has accepted it since they began to. Without a predicate, overlapping pairs are accepted.
inline constexpr std::uint8_t edge_overlaps = 1;
inline constexpr std::uint8_t edge_accepted = 2;
inline constexpr std::uint8_t edge_holds = edge_overlaps | edge_accepted;

/// The part of a PairRefiner that a world's future depends on.
struct RefinerState {
  bool is_refining = false;  ///< whether the tracker's pairs are candidates; else they are the world's
  bool asks_about_all = false;
  std::vector<BoxId> asked_slots{};  ///< slots to ask the predicate about again
  PairGraph graph{};                 ///< the candidates, if it is refining
  PairEvents candidates{};           ///< the tracker's events that no step has taken yet
  PairEvents refined{};              ///< events that are refined and not delivered
  std::vector<Pair> fresh{};         ///< candidates that are new in the graph
};

/// If a world enlarges boxes and reports exact pairs, or if it has a predicate, the pairs of its tracker are
/// only candidates. A graph keeps them. Each update reviews the candidates of the boxes that changed. Cost:
/// O(reviewed candidates).
///
/// Each step first does all that can fail and then changes something, so that an update that throws can be
/// tried again: what its steps had done by then waits in `candidates`, `fresh` and `refined`.
class PairRefiner {
 public:
  /// `by_boxes`: whether the boxes themselves decide about pairs of enlarged ones.
  explicit PairRefiner(bool by_boxes) noexcept : by_boxes_(by_boxes) { state_.is_refining = by_boxes; }

  const RefinerState& state() const noexcept { return state_; }
  bool is_refining() const noexcept { return state_.is_refining; }
  bool has_predicate() const noexcept { return predicate_ != nullptr; }

  /// Whether the predicate is to be asked about all pairs of the slot again.
  bool asks_about(std::uint32_t slot) const noexcept {
    return state_.asks_about_all || (slot < asked_marks_.size() && asked_marks_[slot] != 0);
  }

  /// The tracker's events, for the tracker to append to.
  PairEvents& candidates() noexcept { return state_.candidates; }

  /// Before a first predicate: takes the pairs that hold as accepted candidates.
  void adopt(std::span<const Pair> pairs, std::size_t slots);

  /// Refines from now on, by `predicate`, which it swaps with the previous one. The next update asks it about
  /// all pairs.
  void swap_predicate(PairPredicate& predicate) noexcept;

  /// Takes over the predicate of another refiner.
  void take_predicate(PairRefiner& other) noexcept { predicate_.swap(other.predicate_); }

  /// Has the next update ask the predicate again: about the pairs of one of `slots` slots, or about all.
  void ask_again(std::uint32_t slot, std::size_t slots);
  void ask_again() noexcept { state_.asks_about_all |= has_predicate(); }

  /// Turns the candidates' events into the world's, which it returns, sorted. Clear them when delivered.
  template <int D, typename Real>
  PairEvents& refine(const BoxTable<D, Real>& boxes, Generations generations);

  /// At the end of an update.
  void settle() noexcept;

  /// Gives back the memory that the candidates do not need. O(candidates).
  void shrink_to_fit();

  std::size_t bytes() const noexcept;

  /// The pairs of the tracker's last complete update, sorted. If nothing is refined, they follow from
  /// `current`, the sorted pairs that hold.
  std::vector<Pair> tracked(std::vector<Pair> current) const;

  /// All candidates in the graph, and the candidates that hold; sorted.
  std::vector<Pair> edges() const;
  std::vector<Pair> held_edges() const;

  /// Takes the state of a snapshot, of a world with `slots` slots.
  void restore(RefinerState state, std::size_t slots);

 private:
  /// A candidate that an update reviews, and its new mark.
  struct ReviewedEdge {
    PairGraph::EdgeId edge;
    std::uint8_t new_mark;
  };

  /// A pair that the predicate is asked about.
  struct Question {
    Pair pair;
    std::size_t place;  ///< in reviewed_
  };

  void take_candidates(std::size_t slots);
  template <int D, typename Real>
  void review_changes(const BoxTable<D, Real>& boxes);
  template <int D, typename Real>
  void review_all(std::span<const Box<D, Real>> boxes);
  void review(PairGraph::EdgeId edge, bool overlaps);
  void answer(Generations generations);
  void tell();

  RefinerState state_;
  PairPredicate predicate_;
  bool by_boxes_;
  std::vector<std::uint8_t> asked_marks_;  // by slot, as far as slots were asked about
  std::uint32_t stamp_ = 0;                // of this update
  std::vector<ReviewedEdge> reviewed_;
  std::vector<Question> questions_;
  std::vector<Pair> sorting_;
  std::size_t taken_ = 0;  // candidates' events in this update
  BufferWatch watch_;
};

}  // namespace broadside::world
