// Chipmunk's spatial indexes as finders and trackers: filled one by one, then asked for all pairs at once.
#include "lab/peers/chipmunk_index.hpp"

#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include "lab/peers/callback_sink.hpp"
#include "lab/peers/peer_tracker.hpp"

namespace broadside::lab::peers {
namespace {

ChipmunkObject object_of(const Box2& box, BoxId id) {
  return {cpBBNew(box.min[0], box.min[1], box.max[0], box.max[1]), cpvzero, id};
}

cpHashValue hash_of(const ChipmunkObject& object) { return index(object.id); }

/// What a search hands through to its callback: margins and cells tell more than the overlapping pairs.
struct Search {
  std::span<const Box2> boxes;
  CallbackSink pairs;

  static cpCollisionID take(void* first, void* second, cpCollisionID id, void* data) {
    auto& search = *static_cast<Search*>(data);
    const BoxId a = static_cast<ChipmunkObject*>(first)->id;
    const BoxId b = static_cast<ChipmunkObject*>(second)->id;
    if (overlap(search.boxes[index(a)], search.boxes[index(b)])) search.pairs.add(a, b);
    return id;
  }
};

void find_all(cpSpatialIndex* spatial_index, std::span<const Box2> boxes, PairSink& pairs) {
  Search search{boxes, CallbackSink(pairs)};
  cpSpatialIndexReindexQuery(spatial_index, Search::take, &search);
  search.pairs.finish();
}

class ChipmunkFinder final : public PairFinder<2> {
 public:
  explicit ChipmunkFinder(MakeIndex make) : make_(make) {}

 private:
  void find_valid(std::span<const Box2> boxes, PairSink& pairs) override {
    objects_.clear();
    objects_.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) objects_.push_back(object_of(boxes[i], BoxId(i)));
    const ChipmunkIndex spatial_index = make_(boxes, false);
    for (ChipmunkObject& object : objects_)
      cpSpatialIndexInsert(spatial_index.get(), &object, hash_of(object));
    find_all(spatial_index.get(), boxes, pairs);
  }

  MakeIndex make_;
  std::vector<ChipmunkObject> objects_;
};

class ChipmunkTracker final : public PeerTracker<2> {
 public:
  explicit ChipmunkTracker(MakeIndex make) : make_(make) {}

 private:
  void build(std::span<const Box2> boxes, std::span<const Box2> now) override {
    index_ = make_(now, true);
    objects_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (is_present(boxes[i])) insert(object_of(boxes[i], BoxId(i)));
    }
  }

  void move(const Change<2>& change) override {
    for (const BoxId id : change.changed) {
      const Box2& before = change.before[index(id)];
      const Box2& now = change.now[index(id)];
      if (is_present(before) && !is_present(now)) {
        ChipmunkObject& object = objects_[index(id)];
        cpSpatialIndexRemove(index_.get(), &object, hash_of(object));
      } else if (is_present(before)) {
        ChipmunkObject& object = objects_[index(id)];
        object.bounds = object_of(now, id).bounds;
        object.velocity = velocity(before, now);
      } else if (is_present(now)) {
        insert(object_of(now, id));
      }
    }
  }

  void collide(const Change<2>& change, PairSink& pairs) override {
    find_all(index_.get(), change.now, pairs);
  }

  void insert(const ChipmunkObject& object) {
    if (objects_.size() <= index(object.id)) objects_.resize(index(object.id) + std::size_t{1});
    objects_[index(object.id)] = object;
    cpSpatialIndexInsert(index_.get(), &objects_[index(object.id)], hash_of(object));
  }

  /// The velocity that makes the tree's margin last for some frames: a game has 60 frames a second. What
  /// moves farther than its own size was put elsewhere and has no velocity.
  static cpVect velocity(const Box2& before, const Box2& now) {
    constexpr double frames_a_second = 60;
    const auto centre = [](const Box2& box, int axis) { return (double{box.min[axis]} + box.max[axis]) / 2; };
    const cpVect step = cpv(centre(now, 0) - centre(before, 0), centre(now, 1) - centre(before, 1));
    for (int axis = 0; axis < 2; ++axis) {
      if (std::abs(axis == 0 ? step.x : step.y) > double{now.max[axis]} - now.min[axis]) return cpvzero;
    }
    return cpvmult(step, frames_a_second);
  }

  MakeIndex make_;
  std::deque<ChipmunkObject> objects_;  // by place
  ChipmunkIndex index_;                 // points into them
};

}  // namespace

cpBB bounds_of(void* object) { return static_cast<ChipmunkObject*>(object)->bounds; }

Algorithm chipmunk_index(MakeIndex make) {
  return {
      .name = {},
      .summary = {},
      .source = {},
      .kind = AlgorithmKind::peer,
      .version = "Chipmunk " + std::string(cpVersionString),
      .finder_2d = [make](const Settings&) { return std::make_unique<ChipmunkFinder>(make); },
      .tracker_2d = [make](const Settings&) { return std::make_unique<ChipmunkTracker>(make); },
      .infinite_boxes = false,
      .own_allocator = true,
  };
}

}  // namespace broadside::lab::peers
