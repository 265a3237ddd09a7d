// Bullet's dynamic tree of boxes: btDbvt joined with itself, and btDbvtBroadphase, which keeps one in motion.
#include <algorithm>
#include <memory>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <fmt/format.h>

#include "lab/peers/bullet_proxies.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab::peers {
namespace {

template <int D>
class BulletDbvt final : public PairFinder<D> {
 private:
  struct Report final : btDbvt::ICollide {
    explicit Report(PairSink& sink) : pairs(sink) {}
    void Process(const btDbvtNode* a, const btDbvtNode* b) override {
      pairs.add(id_in(a->data), id_in(b->data));
    }
    PairSink& pairs;
  };

  void find_valid(std::span<const Box<D>> boxes, PairSink& pairs) override {
    btDbvt tree;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      tree.insert(btDbvtVolume::FromMM(bullet_point(boxes[i].min), bullet_point(boxes[i].max)),
                  bullet_data(BoxId(i)));
    }
    Report report(pairs);
    tree.collideTT(tree.m_root, tree.m_root, report);
  }
};

/// Bullet makes moving boxes larger by 0.05, being made for boxes of about 1: by a twentieth of what is usual
/// here.
template <int D>
float margin_for(std::span<const Box<D>> boxes) {
  std::vector<float> sides;
  for (const Box<D>& box : boxes) {
    if (is_present(box)) sides.push_back(box.max[0] - box.min[0]);
  }
  if (sides.empty()) return 0;
  const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
  std::nth_element(sides.begin(), middle, sides.end());
  return *middle / 20;
}

/// With a margin of its own, where Bullet has one for the whole program, and with its proxies, which Bullet
/// leaves to its caller to take out one by one.
class OwnDbvt final : public btDbvtBroadphase {
 public:
  OwnDbvt(float margin, bool deferred) : margin_(margin) { m_deferedcollide = deferred; }

  ~OwnDbvt() override {
    for (btDbvtProxy* proxy : m_stageRoots) {
      while (proxy != nullptr) btAlignedFree(std::exchange(proxy, proxy->links[1]));
    }
  }

  void setAabb(btBroadphaseProxy* proxy, const btVector3& min, const btVector3& max,
               btDispatcher* dispatcher) override {
    gDbvtMargin = margin_;
    btDbvtBroadphase::setAabb(proxy, min, max, dispatcher);
  }

 private:
  float margin_;
};

template <int D>
std::unique_ptr<PairTracker<D>> make_dbvt_tracker(const Settings& settings) {
  const auto make = [deferred = settings.text("collide") == "deferred"](std::span<const Box<D>> boxes,
                                                                        unsigned) {
    return std::make_unique<OwnDbvt>(margin_for(boxes), deferred);
  };
  constexpr bool bounded = false;
  return std::make_unique<ProxyTracker<D>>(std::make_unique<BulletProxies<D>>(make, bounded));
}

}  // namespace

std::string bullet_version() {
  return fmt::format("Bullet {}.{}", btGetVersion() / 100, btGetVersion() % 100);
}

Algorithm bullet_dbvt() {
  return {
      .name = "bullet_dbvt",
      .summary = "Bullet's dynamic tree joined with itself; in motion, its btDbvtBroadphase",
      .source = "Bullet, btDbvt and btDbvtBroadphase, by Nathanael Presson",
      .version = bullet_version(),
      .tunables = {{.name = "collide",
                    .summary = "in motion: each box as it moves, as Bullet does unless told, or all deferred",
                    .standard = "at_once",
                    .type = Tunable::Type::choice,
                    .choices = {"at_once", "deferred"}}},
      .finder_2d = [](const Settings&) { return std::make_unique<BulletDbvt<2>>(); },
      .finder_3d = [](const Settings&) { return std::make_unique<BulletDbvt<3>>(); },
      .tracker_2d = make_dbvt_tracker<2>,
      .tracker_3d = make_dbvt_tracker<3>,
      .infinite_boxes = false,  // moving boxes are made larger, and their centres compared
      .largest_coordinate = 1e30,
      .own_allocator = true,
  };
}

}  // namespace broadside::lab::peers
