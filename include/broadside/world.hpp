// World: for game and physics engines. Boxes are added, moved and removed by stable handles, and each update
// reports the pairs that began and ended.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/box_view.hpp"
#include "broadside/error.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/finder.hpp"
#include "broadside/index.hpp"
#include "broadside/spec.hpp"
#include "broadside/tracker.hpp"

namespace broadside {

/// Names one box of a world for as long as it lives. A slot is used again, under another generation; one
/// whose generations are used up is not, so that no handle ever names a second box.
struct Handle {
  std::uint32_t slot = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t generation = 0;

  friend constexpr auto operator<=>(const Handle&, const Handle&) = default;
};

/// Two boxes of a world; first.slot < second.slot. Where two worlds are joined, a box of each.
struct HandlePair {
  Handle first;
  Handle second;

  friend constexpr auto operator<=>(const HandlePair&, const HandlePair&) = default;
};

/// The user data of a pair's boxes.
struct UserDataPair {
  std::uint64_t first;
  std::uint64_t second;

  friend constexpr bool operator==(const UserDataPair&, const UserDataPair&) = default;
};

/// What one update brought, sorted by slots. Valid until the next update of the world it came from.
struct Events {
  std::span<const HandlePair> begun;
  std::span<const HandlePair> ended;

  /// The user data of these pairs' boxes, one for each; empty in a world whose boxes never had any.
  std::span<const UserDataPair> begun_data{};
  std::span<const UserDataPair> ended_data{};
};

namespace detail {
/// Every bit of the handle changes about half the bits of the result: the finaliser of SplitMix64 (Steele,
/// Lea and Flood 2014). Without it the low bits would be the slot's alone, whatever the generation. `seed`
/// sets what is hashed before the handle.
constexpr std::uint64_t hash(const Handle& handle, std::uint64_t seed = 0) noexcept {
  std::uint64_t bits = seed ^ (std::uint64_t{handle.generation} << 32 | handle.slot);
  bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ bits >> 27) * 0x94d049bb133111eb;
  return bits ^ bits >> 31;
}
}  // namespace detail

}  // namespace broadside

/// Handles and pairs of them as keys of std::unordered_map and std::unordered_set.
template <>
struct std::hash<broadside::Handle> {
  std::size_t operator()(const broadside::Handle& handle) const noexcept {
    return static_cast<std::size_t>(broadside::detail::hash(handle));
  }
};

template <>
struct std::hash<broadside::HandlePair> {
  std::size_t operator()(const broadside::HandlePair& pair) const noexcept {
    using broadside::detail::hash;
    return static_cast<std::size_t>(hash(pair.second, hash(pair.first)));
  }
};

namespace broadside {

/// What comes with a box when it is added.
struct BoxOptions {
  Filter filter{};              ///< which boxes it may pair with, and whether it is static
  std::uint64_t user_data = 0;  ///< the caller's; the world only keeps it
};

/// Which boxes make the pairs of a world: the boxes themselves, or the enlarged ones that it keeps around
/// them.
enum class WorldEvents : std::uint8_t { exact, enlarged };

/// How a world works.
struct WorldOptions {
  /// The algorithm that finds the pairs, such as "grid:cell=2.5" or GridOptions{.cell = 2.5}.
  Spec algorithm{};

  /// Whether the world knows its current pairs: pairs() and persisting(). Without them it saves 16 bytes a
  /// pair and some ten nanoseconds an event, and a predicate can only be set before the first update.
  bool keep_pairs = true;

  /// How far a box is enlarged on every side: by `margin`, or by its longest side times `relative_margin`, or
  /// by the lesser of the two where both are greater than 0. Where either is, or `predicted_frames`, the
  /// tracker sees enlarged boxes, and a new one only when the box has left it, or has become far smaller. The
  /// enlarged boxes are part of the world: of its snapshots, too.
  double margin = 0;
  double relative_margin = 0;

  /// For how many frames ahead an enlarged box also covers the way of its box, where move() is given a
  /// velocity.
  double predicted_frames = 0;

  /// Which boxes make the pairs that update() and pairs() tell, and that a predicate is asked about.
  ///
  /// `exact`: pairs begin and end where the boxes themselves do, exactly and in the same update, whatever the
  /// margin. Each pair of enlarged boxes takes some 50 bytes, and is tested when one of its boxes moves.
  ///
  /// `enlarged`: pairs begin where enlarged boxes meet and end where they part, as in engines, which test
  /// the pairs closely anyway: among bodies that tremble no pair begins and ends again and again, and a move
  /// within the enlarged box costs a comparison and a store. overlaps() tells which pairs' boxes overlap.
  WorldEvents events = WorldEvents::exact;

  /// The generation of the first handles. Worlds that begin far apart refuse each other's handles.
  std::uint32_t first_generation = 0;

  /// What add() and move() do about invalid boxes: they throw, or take them in as absent ones, which pair
  /// with nothing until they are moved to valid ones, and which quarantined() names.
  BadInput bad_input = BadInput::reject;

  /// Whether brute force runs beside the tracker: update() then throws a DivergenceOf<D, Real> where the two
  /// first differ. For looking for faults; n^2 / 2 tests an update. See ShadowTracker.
  bool shadow = false;
};

/// Whether two boxes that overlap and accept each other by their filters count as a pair;
/// first.slot < second.slot.
using PairPredicate = std::function<bool(Handle first, Handle second)>;

/// The bytes a world holds, by purpose; what it has reserved counts.
struct WorldBytes {
  std::size_t boxes = 0;    ///< boxes, also enlarged ones and those removed that can still be read
  std::size_t slots = 0;    ///< generations and states of slots, user data, lists of what changed
  std::size_t filters = 0;  ///< filters and ignored pairs
  std::size_t pairs = 0;    ///< current pairs and events; those of enlarged boxes and a predicate's answers
  std::size_t tracker = 0;  ///< what the tracker says: its copies of boxes and filters, and its structure
  std::size_t queries = 0;  ///< the index that queries are asked of, where it is not the tracker's

  [[nodiscard]] std::size_t total() const noexcept {
    return boxes + slots + filters + pairs + tracker + queries;
  }
};

/// What World::statistics() tells.
struct WorldStatistics {
  std::size_t boxes = 0;  ///< in the world
  std::size_t slots = 0;  ///< that there are, used or free
  std::size_t pairs = 0;  ///< that hold since the last update
  std::size_t begun = 0;  ///< events of the last update
  std::size_t ended = 0;
  std::size_t enlarged_pairs = 0;  ///< pairs of enlarged boxes, which boxes or a predicate decide about
  std::size_t ignored_pairs = 0;   ///< that ignore() was called for

  /// What the tracker counted in the last update: tests, hits (the other tests are false positives),
  /// references, cells or nodes. Empty where it does not count.
  std::optional<Statistics> tracker;

  /// What the tracker chose for the last update and why; empty where it is not one that chooses.
  std::string explanation;

  WorldBytes bytes;
};

/// A box that a ray or a cast box meets, and the parameter at which it does so first.
template <typename Real>
struct HandleHit {
  Handle handle;
  Real t_enter;

  friend constexpr bool operator==(const HandleHit&, const HandleHit&) = default;
};

/// A box and the square of its distance from a point.
template <typename Real>
struct HandleNeighbour {
  Handle handle;
  Real distance_squared;

  friend constexpr bool operator==(const HandleNeighbour&, const HandleNeighbour&) = default;
};

/// A set of boxes that changes, and its overlapping pairs.
///
/// Of boxes of floats or of doubles. What is done to boxes and filters shows its effect on pairs at the next
/// update(). One thread at a time; between updates, while nothing is changed, several may call the const
/// members. A call that throws has changed nothing, and a failed update can be tried again. A world that was
/// moved from may only be assigned to or destroyed.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC World {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  /// A world whose pairs are found by one of the library's algorithms. Throws InvalidSpec, and
  /// std::invalid_argument if a margin or `predicted_frames` is negative or not finite.
  explicit World(const Spec& spec = {});
  explicit World(const WorldOptions& options);

  /// A world over a tracker of the caller's, which no frame was handed to; options.algorithm is not used.
  explicit World(Tracker<D, Real> tracker, const WorldOptions& options = {});

  World(World&& other) noexcept;
  World& operator=(World&& other) noexcept;
  ~World();

  /// Adds a box and names it. O(1). Throws InvalidInput if the box has a NaN or min > max.
  Handle add(const Box<D, Real>& box, const BoxOptions& options = {});

  /// Replaces a box. O(1). Throws InvalidHandle if it is not in the world, InvalidInput as add() does.
  ///
  /// `velocity` is how far the box is expected to go in a frame, for WorldOptions::predicted_frames; throws
  /// InvalidInput if a coordinate of it is not finite, std::logic_error where no frames are predicted.
  void move(Handle handle, const Box<D, Real>& box) { move_to(handle, box, nullptr); }
  void move(Handle handle, const Box<D, Real>& box, const Point<D, Real>& velocity) {
    move_to(handle, box, &velocity);
  }

  /// Takes a box out, and forgets what was ignored of it. O(1). Its pairs end at the next update. Throws
  /// InvalidHandle if it is not in the world.
  void remove(Handle handle) { remove(std::span<const Handle>(&handle, 1)); }

  /// The same for many at once: all of them or, if one is wrong, none. `handles` takes the names of the
  /// boxes; `options` and `velocities` are one for each box, or none. Adding a million boxes to an empty
  /// world is one build at the next update. Throws std::invalid_argument if the lengths differ; of a handle
  /// given twice, the last move counts and the second removal is refused.
  void add(BoxView<D, Real> boxes, std::span<Handle> handles, std::span<const BoxOptions> options = {});
  void move(std::span<const Handle> handles, BoxView<D, Real> boxes,
            std::span<const Point<D, Real>> velocities = {});
  void remove(std::span<const Handle> handles);

  /// Makes `origin` the new origin: subtracts it from all coordinates. O(slots), and the next update has
  /// everything changed. Pairs that rounding makes or parts begin or end there. Throws
  /// std::invalid_argument if a coordinate of `origin` is not finite.
  void shift_origin(const Point<D, Real>& origin);

  /// Replaces a box's filter. O(1), but the first one other than the standard one makes the next update take
  /// all boxes for changed. Throws InvalidHandle.
  void set_filter(Handle handle, const Filter& filter);

  /// Lets two boxes never count as a pair, as those that a joint connects, or lets them again; what was so
  /// already stays so. Forgotten when one of the boxes is removed. O(1), some 100 bytes a pair. Throws
  /// InvalidHandle, and std::invalid_argument for a box with itself.
  void ignore(Handle a, Handle b);
  void unignore(Handle a, Handle b);
  [[nodiscard]] bool is_ignored(Handle a, Handle b) const;

  /// Has update() ask `predicate` about each pair before it begins, in the order of the slots, and in this
  /// thread; from the next update on, and then about all current pairs as well. It may read the world and
  /// must not change it; what it throws is thrown by update(). An empty one lets all pairs count. Without
  /// `keep_pairs` it must be set before the first update, else std::logic_error is thrown. Some 50 bytes for
  /// each pair of boxes that overlap.
  void set_predicate(PairPredicate predicate);

  /// Has the next update ask the predicate again: about the pairs of one box, or about all. Without a
  /// predicate nothing happens; set_filter() needs no such call. Throws InvalidHandle.
  void refilter(Handle handle);
  void refilter();

  /// Brings the pairs up to date. Cost: the tracker's, O(changed) for the boxes, and some ten nanoseconds an
  /// event; never O(boxes) or O(pairs), but that memory no longer needed is given back now and then.
  Events update();

  /// The pairs that hold since the last update, sorted by slots, and those of them that did not begin in it.
  /// Valid until the next update. O(events since it was last asked), and one pass over the pairs if there
  /// were any. Throws std::logic_error in a world without `keep_pairs`.
  [[nodiscard]] std::span<const HandlePair> pairs() const;
  [[nodiscard]] std::span<const HandlePair> persisting() const;

  /// Sets each flag to 1 if the pair's boxes themselves overlap, as they are now, else to 0; a pair with a
  /// box that is not in the world does not. Filters and ignored pairs count for nothing. Some nanoseconds a
  /// pair. Throws std::invalid_argument if the lengths differ.
  void overlaps(std::span<const HandlePair> pairs, std::span<std::uint8_t> flags) const;

  /// Puts into `pairs` those of a box of this world and an overlapping one of `other`, if their filters
  /// accept each other, sorted by slots; of the boxes as they are now, without margin and predicate. Found
  /// by this world's algorithm, or by the standard one where the tracker is the caller's. Cost: one search
  /// between two sets, whose memory is kept for the next join.
  BROADSIDE_HIDDEN void join(const World& other, std::vector<HandlePair>& pairs) const {
    detail::OutputTo output(pairs);
    join_into(other, output);
  }

  using QueryOptions = broadside::QueryOptions<Handle>;
  using NearestOptions = broadside::NearestOptions<Handle, Real>;

  /// Queries, about the boxes as they are now, without margin, ignored pairs and predicate: see BoxIndex,
  /// whose costs and exceptions they have. `function` takes a Handle, or a Handle and its t_enter; the search
  /// ends when it returns false. If `except` is a handle that is not in the world, no box is left out. Rays
  /// and cast boxes are Ray and BoxCast.
  ///
  /// Where the algorithm's own index has the boxes as they are now (`bvh` while it follows them, after an
  /// update, and does not enlarge them), the queries use it. Otherwise the first query builds an index, which
  /// follows the boxes from then on, and each query updates it with the changes since the last one.
  template <typename Function>
  bool overlapping(const Box<D, Real>& box, Function&& function, const QueryOptions& options = {}) const {
    return box_index().overlapping(box, [&](BoxId id) { return function(handle_of(id)); },
                                   {options.filter, slot_of(options.except)});
  }
  template <typename Function>
  bool containing(const Point<D, Real>& point, Function&& function, const QueryOptions& options = {}) const {
    return overlapping({point, point}, function, options);
  }
  template <typename Shape, typename Function>
  bool hits(const Shape& ray_or_cast, Function&& function, const QueryOptions& options = {}) const {
    const auto call = [&](const Hit<Real>& hit) { return function(handle_of(hit.box), hit.t_enter); };
    return box_index().hits(ray_or_cast, call, {options.filter, slot_of(options.except)});
  }
  template <typename Shape>
  [[nodiscard]] std::optional<HandleHit<Real>> first_hit(const Shape& ray_or_cast,
                                                         const QueryOptions& options = {}) const {
    const std::optional<Hit<Real>> hit =
        box_index().first_hit(ray_or_cast, {options.filter, slot_of(options.except)});
    if (!hit) return std::nullopt;
    return HandleHit<Real>{handle_of(hit->box), hit->t_enter};
  }

  /// The `count` nearest boxes, or all if there are fewer, as BoxIndex::nearest() finds them: ordered by
  /// distance and then by slot. In a new vector, or in `found`, which is cleared first.
  BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<HandleNeighbour<Real>> nearest(
      const Point<D, Real>& point, std::size_t count, const NearestOptions& options = {}) const {
    std::vector<HandleNeighbour<Real>> found;
    nearest(point, count, found, options);
    return found;
  }
  BROADSIDE_HIDDEN void nearest(const Point<D, Real>& point, std::size_t count,
                                std::vector<HandleNeighbour<Real>>& found,
                                const NearestOptions& options = {}) const {
    found.clear();
    const auto add = [&](const Neighbour<Real>& one) {
      found.push_back({handle_of(one.box), one.distance_squared});
    };
    box_index().nearest(point, count, add, {options.filter, slot_of(options.except), options.max_distance});
  }

  /// What the queries ask, brought up to date; ids are slots, whose handles handle_of() gives. Valid until
  /// the world changes.
  [[nodiscard]] const BoxIndex<D, Real>& box_index() const;
  [[nodiscard]] Handle handle_of(BoxId slot) const noexcept;

  /// Whether the box is in the world: added and not removed.
  [[nodiscard]] bool contains(Handle handle) const noexcept;

  /// The box as it was last set. A removed one stays readable until the update after the one that reported
  /// its removal, so that the code that handles its ended pairs can look at it; so do its filter and user
  /// data. The reference holds until the next add(), remove() or update(). Throws InvalidHandle.
  [[nodiscard]] const Box<D, Real>& box(Handle handle) const;

  /// The enlarged box that the tracker sees; the box itself where boxes are not enlarged. Throws
  /// InvalidHandle if it is not in the world.
  [[nodiscard]] const Box<D, Real>& enlarged_box(Handle handle) const;
  [[nodiscard]] Filter filter(Handle handle) const;
  std::uint64_t user_data(Handle handle) const;
  void set_user_data(Handle handle, std::uint64_t user_data);

  /// The boxes whose values were invalid when they were last set, by slot: where WorldOptions::bad_input is
  /// to quarantine them. box() gives the absent box for them. O(slots).
  [[nodiscard]] BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<Handle> quarantined() const {
    std::vector<Handle> handles;
    detail::OutputTo output(handles);
    list_quarantined(output);
    return handles;
  }

  /// The number of boxes in the world.
  [[nodiscard]] std::size_t size() const noexcept;

  /// The number of slots, free ones among them: the slot of each handle of a box in the world is below it, so
  /// that arrays of your own by slot need no more places.
  [[nodiscard]] std::size_t slots() const noexcept;

  /// What the world holds and what the last update did. O(1), but for what the tracker says of itself.
  [[nodiscard]] WorldStatistics statistics() const;

  /// Gives memory back that the boxes there are do not need. It costs one build; update() does it by itself
  /// when some three quarters of the slots are gone. A tracker of the caller's keeps what it has.
  void shrink_to_fit();

  /// The world as bytes: all that its future depends on but the predicate, the workers, a tracker of the
  /// caller's and the options bad_input, shadow and first_generation, which stay those of the world that
  /// restores. At any time, also between changes and the update that tells of them. O(slots + pairs).
  /// docs/snapshot-format.md describes the bytes, which are the same on every machine.
  [[nodiscard]] BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<std::byte> snapshot() const {
    std::vector<std::byte> bytes;
    detail::OutputTo output(bytes);
    write_snapshot(output);
    return bytes;
  }

  /// Makes the world what it was when the snapshot was taken, of this world or of another one; from then on,
  /// the same calls bring the same handles, events and pairs. Spans and references handed out end. Throws
  /// InvalidSnapshot, and changes nothing, if the bytes are not a whole snapshot of the same dimension, type
  /// of coordinate and version, or if just one of the two worlds has a predicate.
  ///
  /// Cost: O(slots + pairs) for reading, and the tracker's for an update from the boxes it has now to those
  /// it had then: little for a rollback of few frames, and one build where the worlds have nothing in common.
  void restore(std::span<const std::byte> snapshot);

  /// The threads of update(): one, unless the spec or set_workers() says otherwise.
  [[nodiscard]] const Workers& workers() const noexcept;
  void set_workers(const Workers& workers);

 private:
  void move_to(Handle handle, const Box<D, Real>& box, const Point<D, Real>* velocity);
  void join_into(const World& other, detail::Output<HandlePair>& pairs) const;
  void list_quarantined(detail::Output<Handle>& handles) const;
  void write_snapshot(detail::Output<std::byte>& bytes) const;

  /// The slot of a box that is in the world.
  std::optional<BoxId> slot_of(const std::optional<Handle>& handle) const noexcept {
    return handle && contains(*handle) ? std::optional(BoxId{handle->slot}) : std::nullopt;
  }

  struct State;
  std::unique_ptr<State> state_;
};

using World2 = World<2>;
using World3 = World<3>;
using DoubleWorld2 = World<2, double>;
using DoubleWorld3 = World<3, double>;

}  // namespace broadside
