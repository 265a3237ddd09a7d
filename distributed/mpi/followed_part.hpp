// Follows the boxes of one part of space with a tracker, and reports which pairs of the whole world begin and
// end there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/large_pair.hpp"
#include "broadside/partition.hpp"
#include "broadside/tracker.hpp"

namespace broadside::mpi {

/// A changed box that touched the part at the last update.
template <int D, typename Real>
struct ChangedPartBox {
  Box<D, Real> now;
  std::uint64_t id;
};

/// A box that touches the part now, and did not at the last update.
template <int D, typename Real>
struct EnteringBox {
  Box<D, Real> before;
  Box<D, Real> now;
  std::uint64_t id;
};

/// Not thread-safe. After an exception, only the destructor may be called.
///
/// The tracker sees a box while it touches the part. It therefore also reports pairs that only cross the
/// part's bounds, and pairs that belong to another part that both boxes touch. The boxes before and now tell
/// whether a pair is an event of the whole world. A pair begins if it did not overlap before; the part to
/// which it belongs now reports it. A pair ends if it does not overlap now; the part to which it belonged
/// before reports it.
template <int D, typename Real>
class FollowedPart {
 public:
  using Region = typename Partition<D, Real>::Region;

  /// Events, grouped by the rank that owns the first box.
  struct PartEvents {
    std::vector<std::vector<LargePair>> begun;
    std::vector<std::vector<LargePair>> ended;
  };

  FollowedPart(const Region& region, Tracker<D, Real> tracker)
      : region_(region), tracker_(std::move(tracker)) {}

  /// Updates a box of the part; `owner` is the rank that owns it.
  void change(const ChangedPartBox<D, Real>& box, std::uint32_t owner) {
    change_slot(slots_.at(box.id), box.now, owner);
  }

  /// Adds a box to the part.
  void change(const EnteringBox<D, Real>& box, std::uint32_t owner) {
    const std::uint32_t slot = new_slot();
    slots_.emplace(box.id, slot);
    ids_[slot] = box.id;
    before_[slot] = box.before;
    change_slot(slot, box.now, owner);
  }

  /// Passes the changes to the tracker.
  PartEvents follow(std::size_t ranks) {
    PartEvents events{std::vector<std::vector<LargePair>>(ranks), std::vector<std::vector<LargePair>>(ranks)};
    free_.reserve(free_.size() + changed_.size());
    EventSink begun(*this, now_, before_, events.begun);
    EventSink ended(*this, before_, now_, events.ended);
    tracker_.update({shown_, changed_}, begun, ended);
    pairs_ += begun.count() - ended.count();
    return events;
  }

  /// Makes the current boxes the previous ones, and forgets boxes that have left.
  void commit() noexcept {
    for (const BoxId id : changed_) {
      const std::uint32_t slot = index(id);
      before_[slot] = now_[slot];
      if (is_present(shown_[slot])) continue;
      slots_.erase(ids_[slot]);
      free_.push_back(slot);
    }
    changed_.clear();
  }

  std::size_t boxes() const noexcept { return slots_.size(); }
  std::uint64_t pairs() const noexcept { return pairs_; }

 private:
  /// Receives the tracker's pairs of slots. Keeps pairs that overlap and belong to the part according to
  /// `here`, and do not overlap according to `elsewhere`.
  class EventSink final : public PairSink {
   public:
    EventSink(const FollowedPart& part, const std::vector<Box<D, Real>>& here,
              const std::vector<Box<D, Real>>& elsewhere, std::vector<std::vector<LargePair>>& events)
        : part_(part), here_(here), elsewhere_(elsewhere), events_(events) {}

    std::uint64_t count() const noexcept { return count_; }

   private:
    void consume(std::span<const Pair> pairs) override {
      count_ += pairs.size();
      for (const Pair pair : pairs) {
        std::uint32_t first = index(pair.first);
        std::uint32_t second = index(pair.second);
        const bool belongs =
            (part_.region_.begins_before(here_[first]) & part_.region_.begins_before(here_[second])) == 0;
        const Box<D, Real>& a = elsewhere_[first];
        const Box<D, Real>& b = elsewhere_[second];
        if (!belongs || (is_present(a) && is_present(b) && overlap(a, b))) continue;
        if (part_.ids_[second] < part_.ids_[first]) std::swap(first, second);
        events_[part_.owners_[first]].push_back({part_.ids_[first], part_.ids_[second]});
      }
    }

    const FollowedPart& part_;
    const std::vector<Box<D, Real>>& here_;
    const std::vector<Box<D, Real>>& elsewhere_;
    std::vector<std::vector<LargePair>>& events_;
    std::uint64_t count_ = 0;
  };

  std::uint32_t new_slot() {
    if (!free_.empty()) {
      const std::uint32_t slot = free_.back();
      free_.pop_back();
      return slot;
    }
    const auto slot = static_cast<std::uint32_t>(ids_.size());
    ids_.push_back(0);
    owners_.push_back(0);
    before_.push_back(absent_box<D, Real>());
    now_.push_back(absent_box<D, Real>());
    shown_.push_back(absent_box<D, Real>());
    return slot;
  }

  void change_slot(std::uint32_t slot, const Box<D, Real>& box, std::uint32_t owner) {
    owners_[slot] = owner;
    now_[slot] = box;
    shown_[slot] = is_present(box) && region_.touches(box) ? box : absent_box<D, Real>();
    changed_.push_back(BoxId(slot));
  }

  Region region_;
  Tracker<D, Real> tracker_;
  std::unordered_map<std::uint64_t, std::uint32_t> slots_;  // by id
  std::vector<std::uint64_t> ids_;                          // by slot, like the arrays below
  std::vector<std::uint32_t> owners_;
  std::vector<Box<D, Real>> before_;  // at the last update
  std::vector<Box<D, Real>> now_;     // current bounds, also outside the part
  std::vector<Box<D, Real>> shown_;   // as shown to the tracker: absent if it does not touch the part
  std::vector<std::uint32_t> free_;
  std::vector<BoxId> changed_;
  std::uint64_t pairs_ = 0;  // overlapping in shown_
};

}  // namespace broadside::mpi
