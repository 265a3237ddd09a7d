// Chipmunk's two spatial indexes: a tree of bounding boxes and a spatial hash.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <chipmunk/chipmunk.h>

#include "broadside/algorithm.hpp"

#include "lab/peers/callback_sink.hpp"
#include "lab/peers/peer_follower.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/tear_down.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {
namespace {

struct FreeIndex {
  void operator()(cpSpatialIndex* spatial_index) const { cpSpatialIndexFree(spatial_index); }
};
using ChipmunkIndex = std::unique_ptr<cpSpatialIndex, FreeIndex>;

/// An object in an index. Must not move in memory while it is there.
struct ChipmunkObject {
  cpBB bounds;
  cpVect velocity;  ///< per second
  BoxId id;
  std::uint32_t moved = 0;  ///< the last frame in which it moved
  bool awake = false;       ///< whether it is in the index of moving objects
  bool listed = false;      ///< whether it is in the list of awake objects
};

/// The cpSpatialIndexBBFunc of a ChipmunkObject.
cpBB bounds_of(void* object) { return static_cast<ChipmunkObject*>(object)->bounds; }

/// Makes an empty index that suits `boxes`, for moving objects or for one search. If there is an index of
/// resting objects, which must outlive it, moving objects are also searched for there.
using MakeIndex = ChipmunkIndex (*)(std::span<const Box2> boxes, bool moving, cpSpatialIndex* resting);

ChipmunkObject object_of(const Box2& box, BoxId id) {
  return {.bounds = cpBBNew(box.min[0], box.min[1], box.max[0], box.max[1]), .velocity = cpvzero, .id = id};
}

cpHashValue hash_of(const ChipmunkObject& object) { return index(object.id); }

/// The context of a search's callback: margins and cells give more than the overlapping pairs.
struct PairQuery {
  std::span<const Box2> boxes;
  CallbackSink pairs;

  static cpCollisionID take(void* first, void* second, cpCollisionID id, void* data) {
    auto& search = *static_cast<PairQuery*>(data);
    const BoxId a = static_cast<ChipmunkObject*>(first)->id;
    const BoxId b = static_cast<ChipmunkObject*>(second)->id;
    if (overlap(search.boxes[index(a)], search.boxes[index(b)])) search.pairs.add(a, b);
    return id;
  }

  /// Likewise for one query per box, which reports every pair twice.
  static cpCollisionID take_once(void* first, void* second, cpCollisionID id, void* data) {
    const bool once = static_cast<ChipmunkObject*>(first)->id < static_cast<ChipmunkObject*>(second)->id;
    return once ? take(first, second, id, data) : id;
  }
};

void find_all(cpSpatialIndex* spatial_index, std::span<const Box2> boxes, PairSink& pairs) {
  PairQuery search{boxes, CallbackSink(pairs)};
  cpSpatialIndexReindexQuery(spatial_index, PairQuery::take, &search);
  search.pairs.finish();
}

class ChipmunkSearcher final : public Searcher<2>, public TearDown {
 public:
  explicit ChipmunkSearcher(MakeIndex make) : make_(make) {}

  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& pairs) override {
    const std::span<const Box2> boxes = input.boxes;
    tear_down();
    objects_.clear();
    objects_.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) objects_.push_back(object_of(boxes[i], BoxId(i)));
    index_ = make_(boxes, false, nullptr);
    for (ChipmunkObject& object : objects_) cpSpatialIndexInsert(index_.get(), &object, hash_of(object));
    find_all(index_.get(), boxes, pairs);
    return std::nullopt;
  }

  void tear_down() override { index_.reset(); }

 private:
  MakeIndex make_;
  std::vector<ChipmunkObject> objects_;
  ChipmunkIndex index_;  // of the last search; points into objects_
};

/// Works like cpSpace, with one index for moving and one for resting objects: shapes go to the latter when
/// their body has slept for a while, and only the former is updated and searched.
class ChipmunkFollower final : public PeerFollower<2> {
 public:
  explicit ChipmunkFollower(MakeIndex make) : make_(make) {}

 private:
  static constexpr std::uint32_t frames_until_sleep = 30;  // half a second

  /// The first boxes rest until they move, like the ground.
  void build(std::span<const Box2> boxes, std::span<const Box2> now) override {
    moving_.reset();
    resting_ = make_(now, true, nullptr);
    moving_ = make_(now, true, resting_.get());
    objects_.clear();
    awake_.clear();
    starts_ = true;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (is_present(boxes[i])) insert(object_of(boxes[i], BoxId(i)));
    }
  }

  void move(const Change<2>& change) override {
    starts_ = std::ranges::none_of(change.before, is_present<2, float>);
    ++frame_;
    for (const BoxId id : change.changed) {
      const Box2& before = change.before[index(id)];
      const Box2& now = change.now[index(id)];
      if (is_present(before)) {
        ChipmunkObject& object = objects_[index(id)];
        if (object.awake && is_present(now)) {
          object.bounds = object_of(now, id).bounds;
          object.velocity = velocity(before, now);
          object.moved = frame_;
          continue;
        }
        cpSpatialIndexRemove(index_of(object), &object, hash_of(object));
      }
      if (!is_present(now)) continue;
      ChipmunkObject object = object_of(now, id);
      if (is_present(before)) object.velocity = velocity(before, now);
      insert(object);
    }
    std::erase_if(awake_, [&](BoxId id) { return falls_asleep(id, change.now); });
  }

  void collide(const Change<2>& change, PairSink& pairs) override {
    if (starts_)
      find_resting(change.now, pairs);
    else
      find_all(moving_.get(), change.now, pairs);
    starts_ = false;
  }

  /// The index of resting objects cannot report its own pairs: looks up each box.
  void find_resting(std::span<const Box2> boxes, PairSink& pairs) {
    PairQuery search{boxes, CallbackSink(pairs)};
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (is_present(boxes[i]))
        cpSpatialIndexQuery(resting_.get(), &objects_[i], objects_[i].bounds, PairQuery::take_once, &search);
    }
    search.pairs.finish();
  }

  /// Whether the object no longer belongs to the awake ones.
  bool falls_asleep(BoxId id, std::span<const Box2> boxes) {
    ChipmunkObject& object = objects_[index(id)];
    if (!is_present(boxes[index(id)])) return !(object.listed = false);
    if (frame_ - object.moved < frames_until_sleep) return false;
    cpSpatialIndexRemove(moving_.get(), &object, hash_of(object));
    object.awake = object.listed = false;
    cpSpatialIndexInsert(resting_.get(), &object, hash_of(object));
    return true;
  }

  void insert(ChipmunkObject object) {
    if (objects_.size() <= index(object.id)) objects_.resize(index(object.id) + std::size_t{1});
    ChipmunkObject& there = objects_[index(object.id)];
    object.awake = !starts_;
    object.moved = frame_;
    object.listed = there.listed;
    if (object.awake && !object.listed) {
      awake_.push_back(object.id);
      object.listed = true;
    }
    there = object;
    cpSpatialIndexInsert(index_of(there), &there, hash_of(there));
  }

  cpSpatialIndex* index_of(const ChipmunkObject& object) const {
    return object.awake ? moving_.get() : resting_.get();
  }

  /// The velocity that makes the tree's margin last for some frames, at 60 frames per second. A box that
  /// moves farther than its own size was placed there, and has no velocity.
  static cpVect velocity(const Box2& before, const Box2& now) {
    constexpr double frames_per_second = 60;
    const auto centre = [](const Box2& box, int axis) { return (double{box.min[axis]} + box.max[axis]) / 2; };
    const cpVect step = cpv(centre(now, 0) - centre(before, 0), centre(now, 1) - centre(before, 1));
    for (int axis = 0; axis < 2; ++axis) {
      if (std::abs(axis == 0 ? step.x : step.y) > double{now.max[axis]} - now.min[axis]) return cpvzero;
    }
    return cpvmult(step, frames_per_second);
  }

  MakeIndex make_;
  std::deque<ChipmunkObject> objects_;  // by place
  ChipmunkIndex resting_;               // points into objects_
  ChipmunkIndex moving_;                // points into objects_ and resting_
  std::vector<BoxId> awake_;            // objects in moving_, and some that were removed from it
  std::uint32_t frame_ = 0;
  bool starts_ = true;  // there was nothing before: all boxes are in resting_
};

/// The description of an index that `make` makes: a searcher that fills a new one in each call, and a
/// follower that keeps one.
Algorithm chipmunk_index(MakeIndex make) {
  return {
      .name = {},
      .summary = {},
      .source = {},
      .kind = AlgorithmKind::peer,
      .version = "Chipmunk " + std::string(cpVersionString),
      .in_2d = {.searcher = [make](const Settings&) { return std::make_unique<ChipmunkSearcher>(make); },
                .followers =
                    {{.name = "cpSpace",
                      .make = [make](const Settings&) { return std::make_unique<ChipmunkFollower>(make); }}}},
      .limits = {.infinite_boxes = false},
      .own_allocator = true,
  };
}

ChipmunkIndex make_tree(std::span<const Box2>, bool moving, cpSpatialIndex* resting) {
  ChipmunkIndex tree(cpBBTreeNew(bounds_of, resting));
  // Margins are for moving boxes.
  if (moving)
    cpBBTreeSetVelocityFunc(tree.get(),
                            [](void* object) { return static_cast<ChipmunkObject*>(object)->velocity; });
  return tree;
}

}  // namespace

Algorithm chipmunk_bb_tree() {
  Algorithm algorithm = chipmunk_index(make_tree);
  algorithm.name = "chipmunk_bb_tree";
  algorithm.summary = "Chipmunk's bounding box tree, filled one by one, which keeps its leaves' pairs";
  algorithm.source = "Chipmunk, cpBBTree in cpSpatialIndex.h";
  return algorithm;
}

namespace {

ChipmunkIndex make_hash(std::span<const Box2> boxes, bool, cpSpatialIndex* resting) {
  // From its manual: cells about as large as the objects, and ten times as many cells as objects.
  constexpr std::size_t cells_per_box = 10;
  constexpr std::size_t max_cells = 100'000'000;
  const std::size_t cells = std::min(cells_per_box * std::max<std::size_t>(boxes.size(), 1), max_cells);
  return ChipmunkIndex(cpSpaceHashNew(cell_size(boxes, 1), static_cast<int>(cells), bounds_of, resting));
}

}  // namespace

Algorithm chipmunk_space_hash() {
  Algorithm algorithm = chipmunk_index(make_hash);
  algorithm.name = "chipmunk_space_hash";
  algorithm.summary =
      "Chipmunk's spatial hash: boxes in every cell they touch, in a table by the cell's hash";
  algorithm.source = "Chipmunk, cpSpaceHash in cpSpatialIndex.h";
  return algorithm;
}

}  // namespace broadside::lab::peers
