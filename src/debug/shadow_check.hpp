// ShadowCheck: compares the events of a tracker with those of brute force, by the definition, frame by frame.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "broadside/debug/shadow.hpp"
#include "broadside/tracker.hpp"

#include "debug/frame_log.hpp"
#include "debug/tracker_fault.hpp"

namespace broadside::core {

/// What ShadowTracker does beside its tracker.
template <int D, typename Real>
class ShadowCheck {
 public:
  using Make = std::function<Tracker<D, Real>()>;

  /// `name`: of the tracker, in messages. `make` makes another one on which to try histories; it may be
  /// empty.
  ShadowCheck(std::string name, Make make, const ShadowOptions& options)
      : name_(std::move(name)),
        make_(std::move(make)),
        options_(options),
        log_(options.frames, options.bytes) {}

  /// Has the tracker take a frame, and writes its events. What the first frame lists, and one after a frame
  /// that failed, does not count: everything may have changed.
  ///
  /// Throws, besides what Tracker::update() throws: DivergenceOf, and from then on the same each time; and,
  /// before the tracker is asked, InvalidFrame if a box, a filter or an ignored pair has changed and is not
  /// listed.
  std::optional<Statistics> update(Tracker<D, Real>& tracker, const Frame<D, Real>& frame, PairSink& begun,
                                   PairSink& ended);

  std::size_t bytes() const noexcept { return log_.bytes() + pairs_.capacity() * sizeof(Pair); }

 private:
  void list_all(std::size_t size);
  void list_changed(const Frame<D, Real>& last, const Frame<D, Real>& frame);
  [[noreturn]] void diverge(const Fault& fault, const std::vector<Pair>& now);
  DivergenceOf<D, Real> explained(const Fault& fault, const std::vector<Pair>& now) const;

  std::string name_;
  Make make_;
  ShadowOptions options_;
  FrameLog<D, Real> log_;
  std::vector<Pair> pairs_;          // that hold since the last update, by the definition; sorted
  std::vector<Box<D, Real>> boxes_;  // of the frame, as the tracker sees them
  std::vector<BoxId> changed_;       // likewise
  bool is_whole_ = false;            // whether the last update ended
  std::optional<Fault> fault_;       // in the last frame of the log
  std::vector<Pair> faulty_;         // the pairs of that frame
  std::exception_ptr divergence_;    // which tells all about it
};

}  // namespace broadside::core
