// IncrementalTracker: what trackers share that keep a structure from frame to frame, or find all pairs anew
// where that costs less.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "broadside/tracker.hpp"

#include "core/sample.hpp"

namespace broadside::core {

/// A tracker with two ways: the algorithm's own, follow(), and a DiffTracker over its finder.
template <int D>
class IncrementalTracker : public PairTracker<D> {
 public:
  enum class Way { follow, rebuild, choose };

  std::string explanation() const override;

 protected:
  /// `worthwhile` is the fraction of boxes that may change before finding all pairs anew costs less.
  IncrementalTracker(Way way, double worthwhile, std::unique_ptr<PairFinder<D>> finder);

  /// Whether the last update followed: what follow() keeps is of the last frame.
  bool is_following() const noexcept { return has_kept_ && !is_rebuilding_; }

  void set_worthwhile(double worthwhile) noexcept { worthwhile_ = worthwhile; }

  /// Whether the filters of a changed box are not what they were.
  static bool is_refiltered(const Change<D>& change, BoxId id) {
    return !change.filters_now.empty() && change.filters_before[index(id)] != change.filters_now[index(id)];
  }

  /// Samples those of the boxes that are present; about how many there are in all. `sampled` is for its use.
  static std::size_t take_sample(std::span<const Box<D>> boxes, Sample<D>& sample,
                                 std::vector<Box<D>>& sampled);

  /// Writes the event, if it is one, of a changed box and one whose overlap with it a step changed. Any box
  /// that has changed itself may have done so before the step or not yet: whoever takes the changed boxes one
  /// after the other meets each event at least once.
  static void report_toggle(const Change<D>& change, BoxId mover, BoxId other, bool overlaps, PairSink& begun,
                            PairSink& ended) {
    if (change.filters_now.empty() && change.flags[index(other)] == 0)
      (overlaps ? begun : ended).add(mover, other);
    else
      change.report(mover, other, begun, ended);
  }

 private:
  /// As update_valid(): `change.rebuild` is also set if the frames before were not followed.
  virtual void follow(const Change<D>& change, PairSink& begun, PairSink& ended) = 0;

  /// The bytes of what follow() keeps.
  virtual std::size_t structure_bytes() const noexcept = 0;

  void update_valid(const Change<D>& change, PairSink& begun, PairSink& ended) final;
  void choose(const Change<D>& change);
  std::size_t algorithm_bytes() const noexcept final {
    return structure_bytes() + PairTracker<D>::kept_bytes(rebuilt_);
  }

  Way way_;
  double worthwhile_;
  DiffTracker<D> rebuilt_;
  bool is_rebuilding_ = false;  // the way of the last update
  bool has_kept_ = false;       // the way of the last update knows its boxes
  double debt_ = 0;             // what the other way would have saved, in searches
  std::size_t changed_ = 0;     // of the last update, for explanation()
  std::size_t count_ = 0;
};

}  // namespace broadside::core
