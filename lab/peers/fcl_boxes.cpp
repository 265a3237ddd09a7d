// FCL's broad-phase managers as finders: all objects registered at once, then one collide() among themselves.
#include "lab/peers/fcl_boxes.hpp"

#include <cmath>

#include <fcl/config.h>

namespace broadside::lab::peers {
namespace {

class FclFinder final : public PairFinder<3> {
 public:
  FclFinder(MakeManager make, bool widened) : make_(make), widened_(widened) {}

 private:
  void find_valid(std::span<const Box3> boxes, PairSink& pairs) override {
    objects_.reserve(boxes.size());
    for (std::size_t i = objects_.size(); i < boxes.size(); ++i) objects_.emplace_back(BoxId(i));
    pointers_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      objects_[i].set(boxes[i]);
      if (widened_) objects_[i].widen();
      pointers_.push_back(&objects_[i]);
    }
    const FclManager manager = make_(boxes);
    manager->registerObjects(pointers_);
    manager->setup();
    FclSearch search{boxes, CallbackSink(pairs)};
    manager->collide(&search, FclSearch::take);
    search.pairs.finish();
  }

  MakeManager make_;
  bool widened_;
  std::vector<FclObject> objects_;  // by place; more than there are boxes, once there were more
  std::vector<fcl::CollisionObjectd*> pointers_;
};

}  // namespace

void FclObject::widen() {
  const auto gap = [](double at) { return std::abs(at) * 0x1p-45 + 0x1p-300; };
  for (int axis = 0; axis < 3; ++axis) {
    aabb.min_[axis] -= gap(aabb.min_[axis]);
    aabb.max_[axis] += gap(aabb.max_[axis]);
  }
}

bool FclSearch::take(fcl::CollisionObjectd* first, fcl::CollisionObjectd* second, void* data) {
  auto& search = *static_cast<FclSearch*>(data);
  const BoxId a = static_cast<FclObject*>(first)->id();
  const BoxId b = static_cast<FclObject*>(second)->id();
  constexpr bool stop = true;
  if (overlap(search.boxes[index(a)], search.boxes[index(b)]) && !search.pairs.add(a, b)) return stop;
  return !stop;
}

Algorithm fcl_manager(MakeManager make, bool widened) {
  return {
      .name = {},
      .summary = {},
      .source = {},
      .kind = AlgorithmKind::peer,
      .version = "FCL " FCL_VERSION,
      .finder_3d = [=](const Settings&) { return std::make_unique<FclFinder>(make, widened); },
      .infinite_boxes = false,
  };
}

}  // namespace broadside::lab::peers
