// WorldTracker: the tracker of a world, which restore() leads to another frame.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/debug/shadow.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "world/pair_events.hpp"

namespace broadside::world {

/// A frame that a tracker has taken, without its lists of changes.
template <int D, typename Real>
struct TakenFrame {
  std::vector<Box<D, Real>> boxes{};
  std::vector<Filter> filters{};
  IgnoredPairs ignored{};
  bool has_ignored = false;

  TakenFrame() = default;
  explicit TakenFrame(const Frame<D, Real>& frame)
      : boxes(frame.boxes.begin(), frame.boxes.end()),
        filters(frame.filters.begin(), frame.filters.end()),
        has_ignored(frame.ignored != nullptr) {
    if (has_ignored) ignored = *frame.ignored;
  }

  Frame<D, Real> frame() const noexcept { return {boxes, {}, filters, has_ignored ? &ignored : nullptr, {}}; }
};

/// Follows the frames of a world, by an algorithm of the library or by the caller's tracker.
template <int D, typename Real>
class WorldTracker {
 public:
  using Taken = TakenFrame<D, Real>;

  /// A tracker by options.algorithm, or the caller's; with options.shadow brute force checks it. Throws
  /// InvalidSpec.
  explicit WorldTracker(const WorldOptions& options);
  WorldTracker(Tracker<D, Real> tracker, const WorldOptions& options);

  /// Whether it was made by options.algorithm, so that another one can be made.
  bool is_own() const noexcept { return is_own_; }

  /// The canonical spec, the same for equivalent specs; the default spec if the tracker is the caller's.
  const Spec& spec() const noexcept { return spec_; }

  /// Takes the next frame and appends its events. If it throws, it appends none.
  void update(const Frame<D, Real>& frame, PairEvents& events);

  /// The frame from which the next events start.
  Frame<D, Real> last_frame() const noexcept;

  /// Replaces the tracker, unless it is the caller's, by a new one that has taken `frame` and holds no spare
  /// memory.
  void renew(const Frame<D, Real>& frame);

  /// A new tracker by `spec`, with the same workers, that has taken no frame. Throws InvalidSpec.
  WorldTracker remade(const Spec& spec) const;

  /// Leads the tracker to a frame, and passes the pairs that hold there, sorted, to `check`. `known` are the
  /// pairs that hold in last_frame(), if they are known. If anything throws, the tracker goes back where it
  /// was: now or, if memory is too short for that, at the next update.
  void lead_to(const Taken& frame, std::optional<std::vector<Pair>> known,
               const std::function<void(const std::vector<Pair>&)>& check);

  /// The tracker's index of the boxes that it took last; null if it has none or is yet to be led back.
  const BoxIndex<D, Real>* box_index() const noexcept {
    return way_back_ != nullptr ? nullptr : tracker().box_index();
  }

  /// What the last update did.
  const std::optional<Statistics>& statistics() const noexcept { return statistics_; }

  std::string explanation() const { return tracker().explanation(); }
  std::size_t bytes() const noexcept { return tracker().bytes(); }
  const Workers& workers() const noexcept { return tracker().workers(); }
  void set_workers(const Workers& workers) { tracker().set_workers(workers); }

 private:
  using Plain = Tracker<D, Real>;
  using Shadowed = ShadowTracker<D, Real>;
  using Either = std::variant<Plain, Shadowed>;

  template <typename Source>
  static Either make(Source&& source, bool is_shadowed) {
    if (is_shadowed) return Shadowed(std::forward<Source>(source));
    return Plain(std::forward<Source>(source));
  }

  const Plain& tracker() const noexcept {
    if (const auto* const shadowed = std::get_if<Shadowed>(&tracker_)) return shadowed->tracker();
    return *std::get_if<Plain>(&tracker_);
  }
  Plain& tracker() noexcept { return const_cast<Plain&>(std::as_const(*this).tracker()); }
  void take(const Frame<D, Real>& frame, PairSink& begun, PairSink& ended);
  void lead_back();
  std::vector<Pair> lead(const Taken& to);

  bool is_own_;
  Spec spec_;
  Either tracker_;
  std::optional<Statistics> statistics_;

  /// The frame from which the next events start, if the tracker is at another one: restore() failed, and so
  /// did the way back. Null otherwise.
  std::unique_ptr<Taken> way_back_;
};

}  // namespace broadside::world
