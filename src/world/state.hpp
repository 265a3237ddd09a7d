// The state of a World. Its member functions are in members/, a header for each concern.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "broadside/world.hpp"

#include "core/lean.hpp"
#include "interface/input_check.hpp"
#include "interface/margins.hpp"
#include "world/current_pairs.hpp"
#include "world/pair_graph.hpp"
#include "world/query_index.hpp"
#include "world/slot_set.hpp"

namespace broadside {
namespace core {
class ByteReader;
class ByteWriter;
}  // namespace core

/// Arrays by slot are all as long as `slots`; filters, user data and enlarged boxes are empty until needed.
template <int D, typename Real>
struct BROADSIDE_HIDDEN World<D, Real>::State {
  /// A slot is free, live, removed (no update has told yet), reported (the last update told, and the box can
  /// still be read), and free again; or retired, if its generations are used up.
  enum class SlotState : std::uint8_t { free, live, removed, reported, retired };

  struct Slot {
    std::uint32_t place = 0;  ///< in `removed` or `reported`
    SlotState state = SlotState::free;
    bool is_changed = false;   ///< is in `changed`
    bool is_moved = false;     ///< is in `moved`
    bool is_refilter = false;  ///< is in `refiltered`
  };

  struct Removed {
    std::uint32_t slot;
    Box<D, Real> box;
  };

  struct PairEvents {
    std::vector<Pair> begun;
    std::vector<Pair> ended;

    bool empty() const noexcept { return begun.empty() && ended.empty(); }
    void clear() noexcept { begun.clear(), ended.clear(); }

    /// Sorted, without what both have: an update that ran out of memory may not have come to that.
    PairEvents netted() const;
  };

  /// An edge that an update looks at, and what it makes of it.
  struct Touched {
    core::PairGraph::EdgeId edge;
    bool overlaps;
    bool accepted;
  };

  struct Question {
    Pair pair;
    std::size_t touched;  ///< its place there
  };

  State(std::unique_ptr<PairTracker<D, Real>> tracker, const WorldOptions& options, bool is_own_tracker);

  /// The tracker that these options ask for.
  static std::unique_ptr<PairTracker<D, Real>> make_own_tracker(const WorldOptions& options);

  // boxes.hpp.
  bool is_live(Handle handle) const noexcept;
  std::uint32_t live_slot(Handle handle, const char* action) const;
  std::uint32_t readable_slot(Handle handle) const;
  [[noreturn]] void refuse(Handle handle, const char* action) const;
  void check_box(const Box<D, Real>& box, std::size_t index, const char* whose, std::size_t number) const;
  void check_velocity(const Point<D, Real>& velocity, std::size_t index, const char* whose,
                      std::size_t number) const;
  void reserve(std::size_t boxes, bool with_filters, bool with_user_data);
  std::uint32_t next_slot() const noexcept;
  Handle add_valid(const Box<D, Real>& box, const BoxOptions& options) noexcept;
  void reserve_moves(std::size_t boxes);
  void set_box(std::uint32_t slot, const Box<D, Real>& box,
               const Point<D, Real>* velocity = nullptr) noexcept;
  void set_boxes(std::span<const Handle> handles, BoxView<D, Real> given) noexcept;
  void set_outside(std::uint32_t slot, const Box<D, Real>& box, const Point<D, Real>* velocity) noexcept;
  void reserve_removals(std::size_t boxes, std::size_t ignored);
  void list_removed(std::uint32_t slot) noexcept;
  void clear_removed(std::uint32_t slot) noexcept;
  void mark_changed(std::uint32_t slot) noexcept;
  void mark_moved(std::uint32_t slot) noexcept;

  // queries.hpp.
  const BoxIndex<D, Real>* trackers_index() const noexcept;
  void mark_differences(const State& other);

  // update.hpp.
  Frame<D, Real> frame() const noexcept;
  void ask_tracker();
  void apply_candidates();
  void refine();
  void touch(core::PairGraph::EdgeId edge, bool overlaps);
  void touch_once(core::PairGraph::EdgeId edge);
  void touch_of(BoxId id);
  void touch_all();
  void deliver(PairEvents& events);
  void recycle() noexcept;
  void settle() noexcept;
  bool uses_predicate() const noexcept { return !core::is_lean && predicate; }
  bool keeps_user_data() const noexcept { return !core::is_lean && uses_user_data; }
  bool quarantines() const noexcept { return !core::is_lean && options.bad_input == BadInput::quarantine; }
  Handle handle(BoxId id) const noexcept { return {index(id), generations[index(id)]}; }

  /// A frame that a tracker has taken.
  struct LastFrame {
    std::vector<Box<D, Real>> boxes{};
    std::vector<Filter> filters{};
    IgnoredPairs ignored{};
    bool has_ignored = false;

    Frame<D, Real> frame() const noexcept;
    void get(core::ByteReader& in, const Frame<D, Real>& now);
  };

  // snapshot.hpp, snapshot_restore.hpp and snapshot_tracker.hpp.
  void put(core::ByteWriter& out, std::span<const HandlePair> pairs_now) const;
  static std::unique_ptr<State> get(core::ByteReader& in, const State& like, LastFrame& last);
  void get_slots(core::ByteReader& in);
  void get_lists(core::ByteReader& in);
  void get_pairs_and_events(core::ByteReader& in);
  std::vector<Pair> graph_pairs(bool (*is_wanted)(const core::PairGraph::Mark&)) const;
  bool knows_candidates() const noexcept;
  std::vector<Pair> known_candidates() const;
  Frame<D, Real> last_frame() const noexcept;
  static std::vector<Pair> lead(PairTracker<D, Real>& tracker, const LastFrame& to);
  void lead_back();
  void take_tracker(State& other, const LastFrame& last);

  // snapshot_check.hpp.
  bool is_paired(std::uint32_t slot) const noexcept;
  void expect_paired(Pair pair) const;
  void check_last_frame(const LastFrame& last) const;
  void check_pending(bool asks_predicate) const;
  void check_marks(bool asks_predicate) const;
  void check_pairs(const std::vector<Pair>& tracked) const;

  // memory.hpp.
  void trim() noexcept;
  void release_unneeded() noexcept;
  void release();

  /// Whether the tracker sees enlarged boxes, and whether the boxes themselves decide about its pairs.
  bool has_margin() const noexcept { return margins.any(); }
  bool refines_by_boxes() const noexcept { return has_margin() && options.events == WorldEvents::exact; }

  WorldOptions options;
  core::Margins<D, Real> margins;
  bool is_own_tracker;  // made from options.algorithm, so that another one can be made
  std::unique_ptr<PairTracker<D, Real>> tracker;

  /// The frame from which the next events start, if the tracker is at another one: restore() failed, and so
  /// did the tracker's way back. Null otherwise.
  std::unique_ptr<LastFrame> way_back;

  std::vector<Box<D, Real>> boxes;     // absent where nothing lives
  std::vector<Box<D, Real>> enlarged;  // what the tracker sees; empty without a margin
  std::vector<std::uint32_t> generations;
  std::vector<Slot> slots;
  std::vector<Filter> filters;           // empty until one is not the standard one
  std::vector<std::uint64_t> user_data;  // empty until one is not 0
  bool uses_filters = false;
  bool uses_user_data = false;
  core::SlotSet free;
  std::uint32_t first_generation;  // of slots that there are not yet: above that of any that was dropped
  std::size_t size = 0;
  std::size_t most_slots = 0;  // since memory was last given back

  std::vector<BoxId> changed;     // boxes and filters, since the last update
  std::vector<BoxId> moved;       // likewise enlarged boxes; unused where there are none
  std::vector<Removed> removed;   // since the last update
  std::vector<Removed> reported;  // whose removal the last update told
  bool is_settled = true;         // nothing was changed since the last update, and that one did not fail
  bool wants_release = false;     // by the next update
  bool has_updated = false;

  IgnoredPairs ignored;
  core::PairGraph ignored_edges;  // the same, by box
  std::vector<Pair> ignored_changed;

  // Where there is a margin or a predicate, the tracker's pairs are candidates, kept in a graph, and what
  // holds is told by the boxes themselves and the predicate.
  PairPredicate predicate;
  bool is_refining = false;
  bool refilters_all = false;
  std::vector<std::uint32_t> refiltered;  // slots
  core::PairGraph graph;
  std::uint32_t stamp = 0;
  std::vector<Touched> touched;
  std::vector<Question> questions;
  std::vector<Pair> fresh;  // candidates that are new in the graph

  // Events that no update has delivered yet; after one that failed they wait for the next.
  PairEvents candidates;  // the tracker's
  PairEvents refined;     // and what became of them
  std::vector<Pair> sorting;

  std::vector<HandlePair> begun;  // by the last update
  std::vector<HandlePair> ended;
  std::vector<UserDataPair> begun_data;  // of their boxes; empty without user data
  std::vector<UserDataPair> ended_data;
  std::size_t pair_count = 0;

  // The first reader that needs these brings them up to date; there may be several readers.
  mutable std::mutex reading;
  mutable core::CurrentPairs current;
  mutable std::atomic<bool> is_current = true;
  mutable std::vector<HandlePair> persisting;
  mutable std::atomic<bool> is_persisting = false;
  mutable std::mutex join_in_progress;
  mutable std::unique_ptr<PairFinder<D, Real>> join_finder;  // null until worlds are joined
  mutable core::QueryIndex<D, Real> query_index;
};

/// Makes room for `extra` more elements, at least doubling, so that appending them does not throw.
template <typename T>
void make_room(std::vector<T>& vector, std::size_t extra) {
  if (vector.capacity() - vector.size() < extra)
    vector.reserve(std::max(vector.size() + extra, 2 * vector.capacity()));
}

}  // namespace broadside
