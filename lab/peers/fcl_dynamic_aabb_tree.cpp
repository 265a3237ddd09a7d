// FCL's DynamicAABBTreeCollisionManager: a binary tree of boxes, built at once and kept up to date.
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>

#include "lab/peers/fcl_boxes.hpp"
#include "lab/peers/peer_tracker.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab::peers {
namespace {

std::unique_ptr<fcl::DynamicAABBTreeCollisionManagerd> make_tree() {
  auto tree = std::make_unique<fcl::DynamicAABBTreeCollisionManagerd>();
  tree->tree_init_level = 2;  // sorted by Morton codes: as in FCL's own tests
  return tree;
}

class FclTreeTracker final : public PeerTracker<3> {
 private:
  void build(std::span<const Box3> boxes, std::span<const Box3>) override {
    tree_ = make_tree();
    objects_.clear();
    pointers_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (is_present(boxes[i])) pointers_.push_back(&put(BoxId(i), boxes[i]));
    }
    tree_->registerObjects(pointers_);
    tree_->setup();
  }

  void move(const Change<3>& change) override {
    pointers_.clear();
    std::vector<fcl::CollisionObjectd*> added;
    for (const BoxId id : change.changed) {
      const bool before = is_present(change.before[index(id)]);
      const bool now = is_present(change.now[index(id)]);
      if (before && !now) tree_->unregisterObject(&objects_[index(id)]);
      if (now) (before ? pointers_ : added).push_back(&put(id, change.now[index(id)]));
    }
    tree_->registerObjects(added);
    tree_->update(pointers_);
  }

  void collide(const Change<3>& change, PairSink& pairs) override {
    FclSearch search{change.now, CallbackSink(pairs)};
    // One by one where few changed: all against each other takes time for those that rest as well.
    constexpr std::size_t few = 4;
    if (change.changed.size() < change.now.size() / few) {
      Query query{&search, change.flags};
      for (const BoxId id : change.changed) {
        if (is_present(change.now[index(id)])) tree_->collide(&objects_[index(id)], &query, Query::take);
      }
    } else {
      tree_->collide(&search, FclSearch::take);
    }
    search.pairs.finish();
  }

  /// The search for the pairs of one object that changed.
  struct Query {
    FclSearch* search;
    std::span<const std::uint8_t> changed;

    static bool take(fcl::CollisionObjectd* other, fcl::CollisionObjectd* asked, void* data) {
      const auto& query = *static_cast<Query*>(data);
      const BoxId a = static_cast<FclObject*>(other)->id();
      const BoxId b = static_cast<FclObject*>(asked)->id();
      // It finds itself, and another one that changed will find it in turn.
      constexpr bool stop = true;
      if (a == b || (query.changed[index(a)] != 0 && a < b)) return !stop;
      return FclSearch::take(other, asked, query.search);
    }
  };

  FclObject& put(BoxId id, const Box3& box) {
    while (objects_.size() <= index(id)) objects_.emplace_back(BoxId(objects_.size()), geometry_);
    objects_[index(id)].set(box);
    return objects_[index(id)];
  }

  // What an object must have to be asked for by itself; its size is of no interest.
  std::shared_ptr<fcl::CollisionGeometryd> geometry_ = std::make_shared<fcl::Sphered>(1);
  std::deque<FclObject> objects_;  // by place
  std::vector<fcl::CollisionObjectd*> pointers_;
  std::unique_ptr<fcl::DynamicAABBTreeCollisionManagerd> tree_;  // points into them
};

}  // namespace

Algorithm fcl_dynamic_aabb_tree() {
  Algorithm algorithm = fcl_manager([](std::span<const Box3>) -> FclManager { return make_tree(); });
  algorithm.name = "fcl_dynamic_aabb_tree";
  algorithm.summary = "FCL's dynamic tree of boxes, built at once in the order of Morton codes";
  algorithm.source = "FCL, DynamicAABBTreeCollisionManager";
  algorithm.tracker_3d = [](const Settings&) { return std::make_unique<FclTreeTracker>(); };
  return algorithm;
}

}  // namespace broadside::lab::peers
