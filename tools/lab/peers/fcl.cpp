// FCL's broad-phase managers as searchers: registers all objects at once, then runs collide() once. 2D boxes
// become slabs of one thickness.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_collision_manager.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_spatialhash.h>
#include <fcl/broadphase/detail/sparse_hash_table.h>
#include <fcl/broadphase/detail/spatial_hash.h>
#include <fcl/config.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include "broadside/algorithm.hpp"

#include "lab/peers/callback_sink.hpp"
#include "lab/peers/peer_follower.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/tear_down.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {
namespace {

/// The depth of a 2D box. Not 0, because the trees' Morton codes divide by the extent of all boxes.
constexpr double slab = 1;

/// An object with bounds but no geometry.
class FclObject final : public fcl::CollisionObjectd {
 public:
  /// An object without geometry may be in a manager but must not be queried itself.
  explicit FclObject(BoxId id, const std::shared_ptr<fcl::CollisionGeometryd>& geometry = nullptr)
      : fcl::CollisionObject<double>(geometry), id_(id) {}

  BoxId id() const { return id_; }

  /// A 2D box becomes a slab of this depth.
  template <int D>
  void set(const Box<D>& box, double depth) {
    for (int axis = 0; axis < D; ++axis) {
      aabb.min_[axis] = box.min[axis];
      aabb.max_[axis] = box.max[axis];
    }
    if constexpr (D == 2) {
      aabb.min_[2] = 0;
      aabb.max_[2] = depth;
    }
  }

  /// Enlarges the bounds by less than the distance between floats.
  void widen() {
    const auto gap = [](double at) { return std::abs(at) * 0x1p-45 + 0x1p-300; };
    for (int axis = 0; axis < 3; ++axis) {
      aabb.min_[axis] -= gap(aabb.min_[axis]);
      aabb.max_[axis] += gap(aabb.max_[axis]);
    }
  }

 private:
  BoxId id_;
};

/// The context of a search's callback, which drops reported pairs that do not overlap.
template <int D>
struct FclSearch {
  std::span<const Box<D>> boxes;
  CallbackSink pairs;

  static bool take(fcl::CollisionObjectd* first, fcl::CollisionObjectd* second, void* data) {
    auto& search = *static_cast<FclSearch*>(data);
    const BoxId a = static_cast<FclObject*>(first)->id();
    const BoxId b = static_cast<FclObject*>(second)->id();
    constexpr bool stop = true;
    if (overlap(search.boxes[index(a)], search.boxes[index(b)]) && !search.pairs.add(a, b)) return stop;
    return !stop;
  }
};

using FclManager = std::unique_ptr<fcl::BroadPhaseCollisionManagerd>;
/// Makes an empty manager that suits `boxes`.
template <int D>
using MakeManager = FclManager (*)(std::span<const Box<D>> boxes);

template <int D>
class FclSearcher final : public Searcher<D>, public TearDown {
 public:
  FclSearcher(MakeManager<D> make, bool widened, double depth)
      : make_(make), widened_(widened), depth_(depth) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    const std::span<const Box<D>> boxes = input.boxes;
    tear_down();
    objects_.reserve(boxes.size());
    for (std::size_t i = objects_.size(); i < boxes.size(); ++i) objects_.emplace_back(BoxId(i), geometry_);
    pointers_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      objects_[i].set(boxes[i], depth_);
      if (widened_) objects_[i].widen();
      pointers_.push_back(&objects_[i]);
    }
    FclSearch<D> search{boxes, CallbackSink(pairs)};
    if (input.left_count == 0) {
      manager_ = filled(boxes, pointers_);
      manager_->collide(&search, FclSearch<D>::take);
    } else {
      const auto right = pointers_.begin() + static_cast<std::ptrdiff_t>(input.left_count);
      manager_ = filled(boxes, {right, pointers_.end()});
      left_manager_ = filled(boxes, {pointers_.begin(), right});
      left_manager_->collide(manager_.get(), &search, FclSearch<D>::take);
    }
    search.pairs.finish();
    return std::nullopt;
  }

  void tear_down() override {
    manager_.reset();
    left_manager_.reset();
  }

 private:
  FclManager filled(std::span<const Box<D>> boxes, const std::vector<fcl::CollisionObjectd*>& objects) const {
    FclManager manager = make_(boxes);
    manager->registerObjects(objects);
    manager->setup();
    return manager;
  }

  MakeManager<D> make_;
  bool widened_;
  double depth_;
  // An object must have a geometry to be queried itself, as in joins of two sets; its size is irrelevant.
  std::shared_ptr<fcl::CollisionGeometryd> geometry_ = std::make_shared<fcl::Sphered>(1);
  std::vector<FclObject> objects_;  // by place; may have more elements than there are boxes
  std::vector<fcl::CollisionObjectd*> pointers_;
  FclManager manager_;       // of the last search; points into objects_
  FclManager left_manager_;  // of the left set, if there are two
};

/// The description of a manager: a searcher that fills a new one in each call. `widened` if it fails on equal
/// bounds; `depth` is that of 2D boxes.
Algorithm fcl_manager(MakeManager<2> make_2d, MakeManager<3> make_3d, bool widened = false,
                      double depth = slab) {
  return {
      .name = {},
      .summary = {},
      .source = {},
      .kind = AlgorithmKind::peer,
      .version = "FCL " FCL_VERSION,
      .in_2d = {.searcher =
                    [=](const Settings&) {
                      return std::make_unique<FclSearcher<2>>(make_2d, widened, depth);
                    }},
      .in_3d = {.searcher =
                    [=](const Settings&) {
                      return std::make_unique<FclSearcher<3>>(make_3d, widened, depth);
                    }},
      .limits = {.infinite_boxes = false},
  };
}

template <typename Manager, int D>
FclManager make_plain(std::span<const Box<D>>) {
  return std::make_unique<Manager>();
}

/// FCL's two trees of boxes, whose nodes are allocated one by one or are in an array.
using Tree = fcl::DynamicAABBTreeCollisionManagerd;
using ArrayTree = fcl::DynamicAABBTreeCollisionManager_Array<double>;

template <typename Manager>
std::unique_ptr<Manager> make_tree() {
  auto tree = std::make_unique<Manager>();
  tree->tree_init_level = 2;  // sorted by Morton codes, as in FCL's own tests
  return tree;
}

template <typename Manager, int D>
FclManager make_tree_for(std::span<const Box<D>>) {
  return make_tree<Manager>();
}

template <int D>
class FclTreeFollower final : public PeerFollower<D> {
 private:
  void build(std::span<const Box<D>> boxes, std::span<const Box<D>>) override {
    tree_ = make_tree<Tree>();
    objects_.clear();
    pointers_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (is_present(boxes[i])) pointers_.push_back(&put(BoxId(i), boxes[i]));
    }
    tree_->registerObjects(pointers_);
    tree_->setup();
  }

  void move(const Change<D>& change) override {
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

  void collide(const Change<D>& change, PairSink& pairs) override {
    FclSearch<D> search{change.now, CallbackSink(pairs)};
    // One by one if few changed: a full search takes time for resting boxes as well.
    constexpr std::size_t few = 4;
    if (change.changed.size() < change.now.size() / few) {
      ChangedQuery query{&search, change.flags};
      for (const BoxId id : change.changed) {
        if (is_present(change.now[index(id)]))
          tree_->collide(&objects_[index(id)], &query, ChangedQuery::take);
      }
    } else {
      tree_->collide(&search, FclSearch<D>::take);
    }
    search.pairs.finish();
  }

  /// The search for the pairs of one changed object.
  struct ChangedQuery {
    FclSearch<D>* search;
    std::span<const std::uint8_t> changed;

    static bool take(fcl::CollisionObjectd* other, fcl::CollisionObjectd* asked, void* data) {
      const auto& query = *static_cast<ChangedQuery*>(data);
      const BoxId a = static_cast<FclObject*>(other)->id();
      const BoxId b = static_cast<FclObject*>(asked)->id();
      // The object finds itself; another changed object will find it in turn.
      constexpr bool stop = true;
      if (a == b || (query.changed[index(a)] != 0 && a < b)) return !stop;
      return FclSearch<D>::take(other, asked, query.search);
    }
  };

  FclObject& put(BoxId id, const Box<D>& box) {
    while (objects_.size() <= index(id)) objects_.emplace_back(BoxId(objects_.size()), geometry_);
    objects_[index(id)].set(box, slab);
    return objects_[index(id)];
  }

  // An object must have a geometry to be queried itself; its size is irrelevant.
  std::shared_ptr<fcl::CollisionGeometryd> geometry_ = std::make_shared<fcl::Sphered>(1);
  std::deque<FclObject> objects_;  // by place
  std::vector<fcl::CollisionObjectd*> pointers_;
  std::unique_ptr<Tree> tree_;  // points into objects_
};

// As in FCL's own tests: a table that grows, over the bounds of all objects.
using Table = fcl::detail::SparseHashTable<fcl::AABBd, fcl::CollisionObjectd*, fcl::detail::SpatialHashd>;
using HashManager = fcl::SpatialHashingCollisionManager<double, Table>;

template <int D>
FclManager make_hash(std::span<const Box<D>> boxes) {
  const double cell = std::exp2(std::ceil(std::log2(cell_size(boxes, 1))));
  // A box that ends on a cell's border is not inserted into the next cell, where a box that touches it
  // begins. If cells have a power of two as size and begin at an odd multiple of 2^-30 cells, no float is on
  // a border.
  constexpr double offset = 0.40625 + 0x1p-30;
  fcl::Vector3d min = fcl::Vector3d::Zero();
  fcl::Vector3d max = fcl::Vector3d::Zero();
  for (int axis = 0; axis < D; ++axis) {
    const auto [low, high] = range_on(axis, boxes);
    min[axis] = (std::floor(low / cell) - 1 + offset) * cell;
    max[axis] = (std::ceil(high / cell) + 1 + offset) * cell;
  }
  if constexpr (D == 2) {
    // One layer of cells around flat boxes.
    min[2] = (offset - 1) * cell;
    max[2] = offset * cell;
  }
  return std::make_unique<HashManager>(cell, min, max);
}

}  // namespace

Algorithm fcl_dynamic_aabb_tree() {
  Algorithm algorithm = fcl_manager(make_tree_for<Tree, 2>, make_tree_for<Tree, 3>);
  algorithm.name = "fcl_dynamic_aabb_tree";
  algorithm.summary = "FCL's dynamic tree of boxes, built at once in the order of Morton codes";
  algorithm.source = "FCL, DynamicAABBTreeCollisionManager";
  algorithm.in_2d.followers = {{"DynamicAABBTreeCollisionManager", make_strategy<FclTreeFollower<2>>}};
  algorithm.in_3d.followers = {{"DynamicAABBTreeCollisionManager", make_strategy<FclTreeFollower<3>>}};
  return algorithm;
}

// Its update() terminates the program on some histories of the equivalence test, so all objects are
// registered again for each frame.
Algorithm fcl_dynamic_aabb_tree_array() {
  Algorithm algorithm = fcl_manager(make_tree_for<ArrayTree, 2>, make_tree_for<ArrayTree, 3>);
  algorithm.name = "fcl_dynamic_aabb_tree_array";
  algorithm.summary = "FCL's dynamic tree of boxes with its nodes in one array, built likewise";
  algorithm.source = "FCL, DynamicAABBTreeCollisionManager_Array";
  return algorithm;
}

// It finds pairs when objects are registered, and loses pairs that only touch, since it does not order equal
// end points: hence the widened bounds. Its update() searches the list of all pairs for each pair, and
// removing an object reads erased data, so all objects are registered again for each frame.
Algorithm fcl_sap() {
  using Manager = fcl::SaPCollisionManagerd;
  constexpr bool widened = true;
  Algorithm algorithm = fcl_manager(make_plain<Manager, 2>, make_plain<Manager, 3>, widened);
  algorithm.name = "fcl_sap";
  algorithm.summary = "FCL's sweep and prune: sorted lists of end points, from which the pairs are kept";
  algorithm.source = "FCL, SaPCollisionManager, after I-COLLIDE";
  return algorithm;
}

Algorithm fcl_ssap() {
  using Manager = fcl::SSaPCollisionManagerd;
  Algorithm algorithm = fcl_manager(make_plain<Manager, 2>, make_plain<Manager, 3>);
  algorithm.name = "fcl_ssap";
  algorithm.summary =
      "FCL's simple sweep and prune: lists of the boxes sorted on each axis, a sweep along one";
  algorithm.source = "FCL, SSaPCollisionManager";
  return algorithm;
}

Algorithm fcl_spatial_hash() {
  constexpr bool widened = false;
  constexpr double flat = 0;  // a slab may be many cells deep
  Algorithm algorithm = fcl_manager(make_hash<2>, make_hash<3>, widened, flat);
  algorithm.name = "fcl_spatial_hash";
  algorithm.summary =
      "FCL's spatial hashing: boxes in every cell they touch, each box looked up in all its cells";
  algorithm.source = "FCL, SpatialHashingCollisionManager";
  return algorithm;
}

}  // namespace broadside::lab::peers
