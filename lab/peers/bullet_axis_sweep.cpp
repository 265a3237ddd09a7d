// Bullet's bt32BitAxisSweep3: sorted ends of boxes on three axes, kept from frame to frame.
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>

#include "lab/peers/bullet_volume.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/proxies.hpp"

namespace broadside::lab::peers {
namespace {

template <int D>
class AxisSweepProxies final : public Proxies<D> {
 public:
  void clear(std::span<const Box<D>> boxes) override {
    btVector3 min(0, 0, 0);
    btVector3 max(0, 0, 0);
    bool any = false;
    for (const Box<D>& box : boxes) {
      if (!is_present(box)) continue;
      if (!any) {
        min = bullet_point(box.min);
        max = bullet_point(box.max);
      }
      any = true;
      min.setMin(bullet_point(box.min));
      max.setMax(bullet_point(box.max));
    }
    // Room to move in; what leaves it is still found, though at a higher cost. No axis may be without extent.
    const btVector3 room = (max - min) * btScalar(0.25) + btVector3(1, 1, 1);
    capacity_ = static_cast<unsigned>(boxes.size()) * 2 + 16;
    constexpr bool no_rays = true;
    sweep_.reset();
    sweep_ = std::make_unique<bt32BitAxisSweep3>(min - room, max + room, capacity_, nullptr, no_rays);
    proxies_.assign(boxes.size(), nullptr);
  }

  bool fits(std::span<const Box<D>> boxes) const override { return boxes.size() <= capacity_; }

  void add(BoxId id, const Box<D>& box) override {
    if (proxies_.size() <= index(id)) proxies_.resize(index(id) + 1);
    proxies_[index(id)] =
        sweep_->createProxy(bullet_point(box.min), bullet_point(box.max), 0, bullet_data(id), 1, 1, nullptr);
  }

  void move(BoxId id, const Box<D>& box) override {
    sweep_->setAabb(proxies_[index(id)], bullet_point(box.min), bullet_point(box.max), nullptr);
  }

  void remove(BoxId id) override {
    sweep_->destroyProxy(std::exchange(proxies_[index(id)], nullptr), nullptr);
  }

  void collect(std::span<const Box<D>> boxes, PairSink& pairs) override {
    sweep_->calculateOverlappingPairs(nullptr);
    // It knows ends of boxes rounded to integers.
    btOverlappingPairCache& cache = *sweep_->getOverlappingPairCache();
    const btBroadphasePair* const cached = cache.getOverlappingPairArrayPtr();
    for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
      const BoxId a = id_in(cached[i].m_pProxy0->m_clientObject);
      const BoxId b = id_in(cached[i].m_pProxy1->m_clientObject);
      if (overlap(boxes[index(a)], boxes[index(b)])) pairs.add(a, b);
    }
  }

 private:
  std::unique_ptr<bt32BitAxisSweep3> sweep_;
  std::vector<btBroadphaseProxy*> proxies_;  // null where there is no box
  unsigned capacity_ = 0;
};

template <int D>
std::unique_ptr<PairFinder<D>> finder(const Settings&) {
  return std::make_unique<ProxyFinder<D>>(std::make_unique<AxisSweepProxies<D>>());
}

template <int D>
std::unique_ptr<PairTracker<D>> tracker(const Settings&) {
  return std::make_unique<ProxyTracker<D>>(std::make_unique<AxisSweepProxies<D>>());
}

}  // namespace

Algorithm bullet_axis_sweep() {
  return {
      .name = "bullet_axis_sweep",
      .summary = "Bullet's incremental sweep and prune on three axes, in 32 bits",
      .source = "Bullet, bt32BitAxisSweep3",
      .version = bullet_version(),
      .finder_2d = finder<2>,
      .finder_3d = finder<3>,
      .tracker_2d = tracker<2>,
      .tracker_3d = tracker<3>,
      .infinite_boxes = false,  // its world is bounded
      .largest_coordinate = 1e30,
      .own_allocator = true,
  };
}

}  // namespace broadside::lab::peers
