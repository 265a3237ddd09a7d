// ODE's spaces as searchers and followers. Geoms of a custom class, whose bounds are exactly the boxes, are
// added one by one; then dSpaceCollide() runs once.
#include "lab/peers/ode_space.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/peers/callback_sink.hpp"
#include "lab/peers/peer_follower.hpp"
#include "lab/peers/tear_down.hpp"

namespace broadside::lab::peers {
namespace {

/// A box in a space. Must not move in memory while it is there.
struct Item {
  Box3 box;
  BoxId id;
  double shift;
};

void bounds_of(dGeomID geom, dReal bounds[6]) {
  const auto& item = *static_cast<const Item*>(dGeomGetData(geom));
  for (int axis = 0; axis < 3; ++axis) {
    bounds[2 * axis] = item.box.min[axis] + item.shift;
    bounds[2 * axis + 1] = item.box.max[axis] + item.shift;
  }
}

/// The number of our geom class. ODE is started by the first call and stopped when the program ends.
int geom_class() {
  struct Ode {
    Ode() {
      dInitODE2(0);
      dGeomClass box{};
      box.bytes = 1;  // unused, but must not be 0
      box.collider = [](int) -> dColliderFn* { return nullptr; };
      box.aabb = bounds_of;
      number = dCreateGeomClass(&box);
    }
    ~Ode() { dCloseODE(); }
    int number = 0;
  };
  static const Ode ode;
  dAllocateODEDataForThread(dAllocateMaskAll);
  return ode.number;
}

struct DestroyGeom {
  void operator()(dGeomID geom) const { dGeomDestroy(geom); }
};
using Geom = std::unique_ptr<dxGeom, DestroyGeom>;

/// The context of a search's callback. A space reports boxes that reach to infinity without a test.
struct SpaceQuery {
  std::span<const Box3> boxes;
  CallbackSink& pairs;

  static void take(void* data, dGeomID first, dGeomID second) {
    auto& search = *static_cast<SpaceQuery*>(data);
    const BoxId a = static_cast<const Item*>(dGeomGetData(first))->id;
    const BoxId b = static_cast<const Item*>(dGeomGetData(second))->id;
    if (overlap(search.boxes[index(a)], search.boxes[index(b)])) search.pairs.add(a, b);
  }
};

void find_all(dSpaceID space, std::span<const Box3> boxes, CallbackSink& pairs) {
  SpaceQuery search{boxes, pairs};
  dSpaceCollide(space, &search, SpaceQuery::take);
}

/// Items and their geoms, which are kept for the next search.
class Geoms {
 public:
  std::size_t size() const { return geoms_.size(); }
  dGeomID operator[](std::size_t place) const { return geoms_[place].get(); }

  /// Sets the box of a place, and marks the geom as moved.
  void put(std::size_t place, const Box3& box, double shift = 0) {
    while (geoms_.size() <= place) {
      items_.push_back({{}, BoxId(items_.size()), 0});
      geoms_.emplace_back(dCreateGeom(geom_class()));
      dGeomSetData(geoms_.back().get(), &items_.back());
    }
    items_[place].box = box;
    items_[place].shift = shift;
    dGeomSetPosition(geoms_[place].get(), 0, 0, 0);
  }

  /// Adds a geom that is in no space. Computes its bounds first, so that a tree files it by the new ones.
  void add_to(dSpaceID space, std::size_t place) const {
    dReal bounds[6];
    dGeomGetAABB(geoms_[place].get(), bounds);
    dSpaceAdd(space, geoms_[place].get());
  }

 private:
  std::deque<Item> items_;  // by place
  std::deque<Geom> geoms_;  // point into items_
};

class OdeSearcher final : public Searcher<3>, public TearDown {
 public:
  explicit OdeSearcher(const OdeSpaceKind& kind) : kind_(kind) {}
  ~OdeSearcher() override { OdeSearcher::tear_down(); }

  std::optional<Statistics> search(const SearchInput<3>& input, PairSink& pairs) override {
    const std::span<const Box3> boxes = input.boxes;
    if (boxes.size() > kind_.max_boxes)
      throw std::length_error(std::to_string(boxes.size()) + " boxes in ODE's hash space; expected at most " +
                              std::to_string(kind_.max_boxes) + ", as it counts pairs of boxes in an int");
    tear_down();
    const double shift = kind_.shift != nullptr ? kind_.shift(boxes) : 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) geoms_.put(i, boxes[i], shift);
    if (input.left_count > 0) left_space_ = kind_.make(boxes.first(input.left_count));
    space_ = kind_.make(boxes.subspan(input.left_count));
    for (; in_space_ < boxes.size(); ++in_space_)
      geoms_.add_to((in_space_ < input.left_count ? left_space_ : space_).get(), in_space_);
    CallbackSink sink(pairs);
    if (left_space_ == nullptr) {
      find_all(space_.get(), boxes, sink);
    } else {
      SpaceQuery search{boxes, sink};
      // A space is a geom.
      dSpaceCollide2(reinterpret_cast<dGeomID>(left_space_.get()), reinterpret_cast<dGeomID>(space_.get()),
                     &search, SpaceQuery::take);
    }
    sink.finish();
    return std::nullopt;
  }

  void tear_down() override {
    // The last one first: a removal searches the list from there.
    for (; in_space_ > 0; --in_space_) {
      const dGeomID geom = geoms_[in_space_ - 1];
      dSpaceRemove(dGeomGetSpace(geom), geom);
    }
    space_.reset();
    left_space_.reset();
  }

 private:
  OdeSpaceKind kind_;
  Geoms geoms_;
  OdeSpace space_;            // of the last search
  OdeSpace left_space_;       // of the left set, if there are two
  std::size_t in_space_ = 0;  // geoms before this one are in the space
};

class OdeFollower final : public PeerFollower<3> {
 public:
  explicit OdeFollower(const OdeSpaceKind& kind) : kind_(kind) {}
  ~OdeFollower() override { clear(); }

 private:
  void build(std::span<const Box3> boxes, std::span<const Box3> now) override {
    clear();
    space_ = kind_.make(now);
    for (std::size_t i = 0; i < boxes.size(); ++i) set(i, boxes[i]);
  }

  void move(const Change<3>& change) override {
    for (const BoxId id : change.changed) set(index(id), change.now[index(id)]);
  }

  void collide(const Change<3>& change, PairSink& pairs) override {
    CallbackSink sink(pairs);
    find_all(space_.get(), change.now, sink);
    sink.finish();
  }

  /// An absent box is a disabled geom: removing it would make a tree search lists.
  void set(std::size_t place, const Box3& box) {
    if (!is_present(box)) {
      if (place < geoms_.size()) dGeomDisable(geoms_[place]);
      return;
    }
    const std::size_t known = geoms_.size();
    geoms_.put(place, box);
    for (std::size_t i = known; i < geoms_.size(); ++i) {
      geoms_.add_to(space_.get(), i);
      if (i < place) dGeomDisable(geoms_[i]);
    }
    dGeomEnable(geoms_[place]);
  }

  void clear() {
    if (space_ != nullptr) {
      for (std::size_t i = geoms_.size(); i > 0; --i) dSpaceRemove(space_.get(), geoms_[i - 1]);
    }
    geoms_ = {};
    space_.reset();
  }

  OdeSpaceKind kind_;
  Geoms geoms_;
  OdeSpace space_;
};

}  // namespace

Algorithm ode_space(const OdeSpaceKind& kind) {
  Algorithm algorithm{
      .name = {},
      .summary = {},
      .source = {},
      .kind = AlgorithmKind::peer,
      .version = "ODE " dODE_VERSION,
      .in_3d = {.searcher = [kind](const Settings&) { return std::make_unique<OdeSearcher>(kind); }},
      .limits = {.max_boxes = kind.max_boxes},
      .own_allocator = true,
  };
  if (kind.tracks) {
    algorithm.in_3d.followers = {{.name = "dSpaceCollide", .make = [kind](const Settings&) {
                                    return std::make_unique<OdeFollower>(kind);
                                  }}};
  }
  return algorithm;
}

}  // namespace broadside::lab::peers
