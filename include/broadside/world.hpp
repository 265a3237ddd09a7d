// World: boxes with stable handles, for game and physics engines. Each update reports the pairs that began
// and ended.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
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

/// Identifies a box of a world for as long as the box exists. A reused slot gets a new generation and is
/// retired when its generations are used up, so no handle ever identifies a second box.
struct Handle {
  std::uint32_t slot = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t generation = 0;

  friend constexpr auto operator<=>(const Handle&, const Handle&) = default;
};

/// Two boxes of a world, with first.slot < second.slot; or, in a join of two worlds, a box of each.
struct HandlePair {
  Handle first;
  Handle second;

  friend constexpr auto operator<=>(const HandlePair&, const HandlePair&) = default;
};

/// The user data of the two boxes of a pair.
struct UserDataPair {
  std::uint64_t first;
  std::uint64_t second;

  friend constexpr bool operator==(const UserDataPair&, const UserDataPair&) = default;
};

/// The events of an update, sorted by slots. Valid until the next update of the same world.
struct Events {
  std::span<const HandlePair> begun;
  std::span<const HandlePair> ended;

  /// The user data of each pair's boxes; empty if no box of the world ever had any.
  std::span<const UserDataPair> begun_data{};
  std::span<const UserDataPair> ended_data{};
};

namespace detail {
/// Mixes the bits, since otherwise the low ones would depend on the slot alone. `seed` is the hash of what
/// comes before the handle.
constexpr std::uint64_t hash(const Handle& handle, std::uint64_t seed = 0) noexcept {
  return mixed(seed ^ (std::uint64_t{handle.generation} << 32 | handle.slot));
}
}  // namespace detail

}  // namespace broadside

/// Handles and pairs of handles can be keys of std::unordered_map and std::unordered_set.
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

/// Settings of a box that is added.
struct BoxOptions {
  Filter filter{};              ///< which boxes it may pair with, and whether it is static
  std::uint64_t user_data = 0;  ///< yours; the world only keeps it
};

/// Which boxes form the pairs of a world: the boxes themselves, or the enlarged boxes around them.
enum class WorldEvents : std::uint8_t { exact, enlarged };

/// Settings of a world.
struct WorldOptions {
  /// The algorithm that finds the pairs, such as "grid:cell=2.5" or GridOptions{.cell = 2.5}.
  Spec algorithm{};

  /// Whether the world keeps its current pairs, for pairs() and persisting(). Without them it saves 16 bytes
  /// per pair and some ten nanoseconds per event, and a predicate can only be set before the first update.
  bool keep_pairs = true;

  /// How far a box is enlarged on each side (a fat AABB): by `margin`, by `relative_margin` times its longest
  /// side, or by the smaller of the two if both are above 0. If either of them or `predicted_frames` is above
  /// 0, the tracker sees enlarged boxes. An enlarged box is replaced only when its box has left it or become
  /// far smaller. Enlarged boxes are part of the world and of its snapshots.
  double margin = 0;
  double relative_margin = 0;

  /// The number of frames of motion that an enlarged box covers if move() is given a velocity.
  double predicted_frames = 0;

  /// Which boxes form the pairs that update() and pairs() report and that a predicate decides.
  ///
  /// `exact`: a pair begins and ends in the update in which the boxes themselves meet and part, whatever the
  /// margin. Each pair of enlarged boxes takes some 50 bytes, and is tested when one of its boxes moves.
  ///
  /// `enlarged`: a pair begins when the enlarged boxes meet, and ends when they part. This suits engines,
  /// which test the pairs closely anyway. Pairs of jittering bodies do not begin and end again and again, and
  /// a move within the enlarged box costs a comparison and a store. overlaps() tells which boxes overlap.
  WorldEvents events = WorldEvents::exact;

  /// The most boxes that the world may hold; 0: no limit. add() throws InvalidFrame and restore()
  /// InvalidSnapshot if there would be more, and change nothing. Removed boxes do not count; their memory is
  /// reused after two updates.
  std::uint32_t max_boxes = 0;

  /// The first handles' generation. Give each world another, such as a multiple of 1 << 20, so that a handle
  /// used in the wrong world throws; with equal ones it may name a box there.
  std::uint32_t first_generation = 0;

  /// Whether boxes that only touch overlap. If false, the world stores half_open(box), so box() returns the
  /// lowered maxima: move() would lower them again. overlapping() treats its query box in the same way.
  bool touching = true;

  /// Whether add() and move() reject invalid boxes or quarantine them. A quarantined box counts as absent
  /// until it is moved to a valid box; quarantined() lists these boxes.
  BadInput bad_input = BadInput::reject;

  /// Whether brute force checks the tracker: update() throws a DivergenceOf<D, Real> when their events first
  /// differ. For debugging; n^2 / 2 tests per update. See ShadowTracker.
  bool shadow = false;
};

/// The options of a world but for its algorithm: name, summary, default value and range of each. Bindings and
/// programs offer these.
[[nodiscard]] BROADSIDE_PUBLIC std::span<const Tunable> world_tunables();

/// The options that a text names, such as "world:margin=0.1:events=enlarged"; the others have their default
/// values. Throws InvalidSpec for an unknown name, a value out of range or another word than "world".
[[nodiscard]] BROADSIDE_PUBLIC WorldOptions world_options(const Spec& spec);

/// Whether two boxes count as a pair. They overlap, their filters accept each other, and
/// first.slot < second.slot.
using PairPredicate = std::function<bool(Handle first, Handle second)>;

/// The bytes that a world has reserved, by purpose.
struct WorldBytes {
  std::size_t boxes = 0;    ///< boxes, enlarged boxes, and removed boxes that can still be read
  std::size_t slots = 0;    ///< generations and states of slots, user data, lists of what changed
  std::size_t filters = 0;  ///< filters and ignored pairs
  std::size_t pairs = 0;    ///< current pairs, events, pairs of enlarged boxes, a predicate's answers
  std::size_t tracker = 0;  ///< the tracker's copies of boxes and filters, and its structure
  std::size_t queries = 0;  ///< the index for queries, unless it is the tracker's

  [[nodiscard]] std::size_t total() const noexcept {
    return boxes + slots + filters + pairs + tracker + queries;
  }
};

/// What World::statistics() returns.
struct WorldStatistics {
  std::size_t boxes = 0;           ///< in the world
  std::size_t slots = 0;           ///< used and free
  std::size_t pairs = 0;           ///< that hold since the last update
  std::size_t begun = 0;           ///< events of the last update
  std::size_t ended = 0;           ///< likewise
  std::size_t enlarged_pairs = 0;  ///< pairs of enlarged boxes; the boxes or a predicate decide about them
  std::size_t ignored_pairs = 0;   ///< by ignore()

  /// What the tracker counted in the last update, if it counts: tests, hits (the other tests are false
  /// positives), references, cells or nodes.
  std::optional<Statistics> tracker;

  /// What the tracker chose for the last update and why; empty if it does not choose.
  std::string explanation;

  WorldBytes bytes;
};

/// A box that a ray or a cast box hits, and the t of the first contact.
template <typename Real>
struct HandleHit {
  Handle handle;
  Real t_enter;

  friend constexpr bool operator==(const HandleHit&, const HandleHit&) = default;
};

/// A box and its squared distance from a query's box or point.
struct HandleNeighbour {
  Handle handle;
  double distance_squared;

  friend constexpr bool operator==(const HandleNeighbour&, const HandleNeighbour&) = default;
};

/// A set of boxes that changes, and its overlapping pairs. Coordinates are floats or doubles.
///
/// Changes of boxes and filters take effect on the pairs at the next update(). Use a world from one thread at
/// a time; between changes, several threads may call const members. A call that throws has changed nothing,
/// and a failed update can be tried again. A world that was moved from may only be assigned to or destroyed.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC World {
  static_assert(detail::SupportedBox<D, Real>::value);

 public:
  /// A world that finds its pairs by an algorithm of the library. Throws InvalidSpec, and
  /// std::invalid_argument if a margin or `predicted_frames` is negative or not finite, or if `events` is
  /// `enlarged` and all of these are 0.
  explicit World(const Spec& spec = {});
  explicit World(const WorldOptions& options);

  /// A world that uses your own tracker, which must not have taken a frame yet. Ignores options.algorithm.
  explicit World(Tracker<D, Real> tracker, const WorldOptions& options = {});

  World(World&& other) noexcept;
  World& operator=(World&& other) noexcept;
  ~World();

  /// Adds a box. O(1). Throws InvalidInput if it has a NaN or min > max, InvalidFrame if there would be more
  /// boxes than WorldOptions::max_boxes.
  Handle add(const Box<D, Real>& box, const BoxOptions& options = {});

  /// Replaces a box. O(1). Throws InvalidHandle if it is not in the world, InvalidInput as add() does.
  ///
  /// `velocity` is the expected motion per frame, for WorldOptions::predicted_frames. Throws InvalidInput if
  /// a coordinate of it is not finite, std::logic_error if the world predicts no frames.
  void move(Handle handle, const Box<D, Real>& box) { move_to(handle, box, nullptr); }
  void move(Handle handle, const Box<D, Real>& box, const Point<D, Real>& velocity) {
    move_to(handle, box, &velocity);
  }

  /// Removes a box and its ignored pairs. O(1). Its pairs end at the next update. Throws InvalidHandle if it
  /// is not in the world.
  void remove(Handle handle) { remove(std::span<const Handle>(&handle, 1)); }

  /// The same for many boxes: for all of them or, if one is refused, for none. `handles` receives the handles
  /// of the boxes; `options` and `velocities` have one element for each box, or none. Adding a million boxes
  /// to an empty world costs one build at the next update. If a handle is given twice, its last move counts,
  /// and its second removal is refused. Throws std::invalid_argument if the lengths differ.
  void add(BoxView<D, Real> boxes, std::span<Handle> handles, std::span<const BoxOptions> options = {});
  void move(std::span<const Handle> handles, BoxView<D, Real> boxes,
            std::span<const Point<D, Real>> velocities = {});
  void remove(std::span<const Handle> handles);

  /// Subtracts `origin` from all coordinates. O(slots). The next update treats all boxes as changed; pairs
  /// that rounding joins or separates begin or end in it. Throws std::invalid_argument if a coordinate of
  /// `origin` is not finite.
  void shift_origin(const Point<D, Real>& origin);

  /// Replaces a box's filter. O(1). A world's first filter other than the default makes the next update treat
  /// all boxes as changed. Throws InvalidHandle.
  void set_filter(Handle handle, const Filter& filter);

  /// Ignores a pair, such as two bodies that a joint connects: it does not count until unignore() is called
  /// or one of its boxes is removed. O(1), some 100 bytes per pair. Throws InvalidHandle, and
  /// std::invalid_argument for a box with itself.
  void ignore(Handle a, Handle b);
  void unignore(Handle a, Handle b);
  [[nodiscard]] bool is_ignored(Handle a, Handle b) const;

  /// Makes update() ask `predicate` about each pair before it begins, in the order of slots and in the
  /// calling thread. The next update also asks about all current pairs. The predicate may read the world, but
  /// calls that would change it throw std::logic_error; update() lets its exceptions through. An empty
  /// predicate accepts all pairs. Takes some 50 bytes for each pair of boxes that overlap. Throws
  /// std::logic_error after the first update of a world without `keep_pairs`.
  void set_predicate(PairPredicate predicate);

  /// Makes the next update ask the predicate again, about the pairs of one box or about all. No effect
  /// without a predicate. set_filter() needs no such call. Throws InvalidHandle.
  void refilter(Handle handle);
  void refilter();

  /// Brings the pairs up to date. Cost: the tracker's, O(changed boxes), and some ten nanoseconds per event.
  /// It is never O(boxes) or O(pairs), except when it releases memory that is no longer needed.
  Events update();

  /// pairs() returns the pairs that hold since the last update, sorted by slots; persisting() leaves out
  /// those that began in it. Valid until the next update. O(events since the last call), and one pass over
  /// the pairs if there were any. Throws std::logic_error in a world without `keep_pairs`.
  [[nodiscard]] std::span<const HandlePair> pairs() const;
  [[nodiscard]] std::span<const HandlePair> persisting() const;

  /// Sets each flag to 1 if both boxes of the pair are in the world and overlap as they are now, else to 0.
  /// Filters and ignored pairs have no effect. Some nanoseconds per pair. Throws std::invalid_argument if the
  /// lengths differ.
  void overlaps(std::span<const HandlePair> pairs, std::span<std::uint8_t> flags) const;

  /// Finds the pairs of a box of this world and a box of `other` that overlap as they are now and whose
  /// filters accept each other, sorted by slots. Margins and predicates have no effect. Uses the world's
  /// algorithm, or the default one if the tracker is yours. Cost: one search between two sets; its memory is
  /// kept for the next join.
  BROADSIDE_HIDDEN void join(const World& other, std::vector<HandlePair>& pairs) const {
    detail::OutputTo output(pairs);
    join_into(other, output);
  }

  using QueryOptions = broadside::QueryOptions<Handle>;
  using NearestOptions = broadside::NearestOptions<Handle>;

  /// Queries about the boxes as they are now, with the costs and exceptions of BoxIndex. Margins, ignored
  /// pairs and predicates have no effect. `function` takes a Handle, or a Handle and its t_enter; it may
  /// return a bool, and false ends the search. `except` has no effect if it is not in the world. Rays and
  /// cast boxes are Ray and BoxCast.
  ///
  /// If the algorithm has an index of these boxes, as `bvh` has after an update of boxes that are not
  /// enlarged, queries use it. Otherwise the first query builds one, and each later query updates it with the
  /// changes since the query before.
  template <typename Function>
  bool overlapping(const Box<D, Real>& box, Function&& function, const QueryOptions& options = {}) const {
    return box_index().overlapping(as_kept(box), [&](BoxId id) { return function(handle_of(id)); },
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

  /// Finds the `count` boxes nearest to a point or a box, or all if there are fewer, ordered by distance and
  /// then by slot: see BoxIndex::nearest(). Returns them, or puts them into `found`, which is cleared first.
  template <typename PointOrBox = Point<D, Real>>
  BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<HandleNeighbour> nearest(
      const PointOrBox& from, std::size_t count, const NearestOptions& options = {}) const {
    std::vector<HandleNeighbour> found;
    nearest(from, count, found, options);
    return found;
  }
  template <typename PointOrBox = Point<D, Real>>
  BROADSIDE_HIDDEN void nearest(const PointOrBox& from, std::size_t count,
                                std::vector<HandleNeighbour>& found,
                                const NearestOptions& options = {}) const {
    found.clear();
    const auto add = [&](const Neighbour& one) {
      found.push_back({handle_of(one.box), one.distance_squared});
    };
    const auto find = [&](const auto& kept) {
      box_index().nearest(kept, count, add, {options.filter, slot_of(options.except), options.max_distance});
    };
    if constexpr (std::is_same_v<PointOrBox, Box<D, Real>>)
      find(as_kept(from));
    else
      find(from);
  }

  /// The index that queries use, brought up to date; valid until the world changes. Its ids are slots:
  /// handle_of() gives their handles. as_kept() gives the box that queries ask it for: the box itself,
  /// or half_open(box) without WorldOptions::touching.
  [[nodiscard]] const BoxIndex<D, Real>& box_index() const;
  [[nodiscard]] Handle handle_of(BoxId slot) const noexcept;
  [[nodiscard]] Box<D, Real> as_kept(const Box<D, Real>& box) const noexcept;

  /// Whether the box is in the world.
  [[nodiscard]] bool contains(Handle handle) const noexcept;

  /// The box as it was last set. A removed box, its filter and its user data stay readable until the update
  /// after the one that reports its removal, for code that handles its ended pairs. The reference is valid
  /// until the next add(), remove() or update(). Throws InvalidHandle.
  [[nodiscard]] const Box<D, Real>& box(Handle handle) const;

  /// The enlarged box that the tracker sees, or the box itself if boxes are not enlarged. Throws
  /// InvalidHandle if it is not in the world.
  [[nodiscard]] const Box<D, Real>& enlarged_box(Handle handle) const;
  [[nodiscard]] Filter filter(Handle handle) const;
  [[nodiscard]] std::uint64_t user_data(Handle handle) const;
  void set_user_data(Handle handle, std::uint64_t user_data);

  /// The boxes quarantined by WorldOptions::bad_input, by slot. box() gives the absent box for them.
  /// O(slots).
  [[nodiscard]] BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<Handle> quarantined() const {
    std::vector<Handle> handles;
    detail::OutputTo output(handles);
    list_quarantined(output);
    return handles;
  }

  /// The number of boxes in the world.
  [[nodiscard]] std::size_t size() const noexcept;

  /// The number of slots, used and free; the size for your own arrays by slot.
  [[nodiscard]] std::size_t slots() const noexcept;

  /// What the world holds, and what the last update did. O(1), except for the tracker's explanation.
  [[nodiscard]] WorldStatistics statistics() const;

  /// Releases memory that the boxes in the world do not need. Costs one build. update() does so by itself
  /// when some three quarters of the slots are gone. Your own tracker keeps its memory.
  void shrink_to_fit();

  /// The world as bytes; may be called at any time, also between changes and their update. The bytes hold all
  /// that the world's future depends on, except the predicate, the workers, your own tracker, and the options
  /// bad_input, max_boxes, shadow and first_generation: a world that restores them keeps its own. O(slots +
  /// pairs). The bytes are the same on every machine: see docs/snapshot-format.md.
  [[nodiscard]] BROADSIDE_HIDDEN BROADSIDE_CALLERS_VECTOR std::vector<std::byte> snapshot() const {
    std::vector<std::byte> bytes;
    detail::OutputTo output(bytes);
    write_snapshot(output);
    return bytes;
  }

  /// Makes the world what it was when the snapshot was taken, of this world or of another one. From then on,
  /// the same calls give the same handles, events and pairs. Spans and references become invalid. Throws
  /// InvalidSnapshot, and changes nothing, if the bytes are not a whole snapshot of a known version and of
  /// the same dimension and type of coordinate, or if only one of the two worlds has a predicate.
  ///
  /// Cost: O(slots + pairs), and the tracker's for an update from the current boxes to those of the snapshot:
  /// little for a rollback of a few frames, one build if the worlds have nothing in common.
  void restore(std::span<const std::byte> snapshot);

  /// The threads of update(): one, unless the spec or set_workers() says otherwise.
  [[nodiscard]] const Workers& workers() const noexcept;
  void set_workers(const Workers& workers);

 private:
  void move_to(Handle handle, const Box<D, Real>& box, const Point<D, Real>* velocity);
  void join_into(const World& other, detail::Output<HandlePair>& pairs) const;
  void list_quarantined(detail::Output<Handle>& handles) const;
  void write_snapshot(detail::Output<std::byte>& bytes) const;

  /// The slot; nothing if the box is not in the world.
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
