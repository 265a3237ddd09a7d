// Bullet's dynamic tree of boxes: btDbvt joined with itself, and btDbvtBroadphase, which keeps one in motion.
#include <algorithm>
#include <memory>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <fmt/format.h>

#include "lab/peers/bullet_volume.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/proxies.hpp"

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

template <int D>
class DbvtProxies final : public Proxies<D> {
 public:
  ~DbvtProxies() override { drop(); }

  void clear(std::span<const Box<D>> boxes) override {
    drop();
    broadphase_ = std::make_unique<btDbvtBroadphase>();
    proxies_.assign(boxes.size(), nullptr);
    margin_ = margin_for(boxes);
  }

  void add(BoxId id, const Box<D>& box) override {
    if (proxies_.size() <= index(id)) proxies_.resize(index(id) + 1);
    proxies_[index(id)] = broadphase_->createProxy(bullet_point(box.min), bullet_point(box.max), 0,
                                                   bullet_data(id), 1, 1, nullptr);
  }

  void move(BoxId id, const Box<D>& box) override {
    gDbvtMargin = margin_;
    broadphase_->setAabb(proxies_[index(id)], bullet_point(box.min), bullet_point(box.max), nullptr);
  }

  void remove(BoxId id) override {
    broadphase_->destroyProxy(std::exchange(proxies_[index(id)], nullptr), nullptr);
  }

  void collect(std::span<const Box<D>> boxes, PairSink& pairs) override {
    broadphase_->calculateOverlappingPairs(nullptr);
    // The cache holds pairs of boxes that were made larger, and some that ended a while ago.
    btOverlappingPairCache& cache = *broadphase_->getOverlappingPairCache();
    const btBroadphasePair* const cached = cache.getOverlappingPairArrayPtr();
    for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
      const BoxId a = id_in(cached[i].m_pProxy0->m_clientObject);
      const BoxId b = id_in(cached[i].m_pProxy1->m_clientObject);
      if (overlap(boxes[index(a)], boxes[index(b)])) pairs.add(a, b);
    }
  }

 private:
  /// Bullet makes moving boxes larger by 0.05, being made for boxes of about 1: by a twentieth of what is
  /// usual here.
  static float margin_for(std::span<const Box<D>> boxes) {
    std::vector<float> sides;
    for (const Box<D>& box : boxes) {
      if (is_present(box)) sides.push_back(box.max[0] - box.min[0]);
    }
    if (sides.empty()) return 0;
    const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
    std::nth_element(sides.begin(), middle, sides.end());
    return *middle / 20;
  }

  /// Frees the proxies, which the broad phase does not do, without looking for the pairs of each.
  void drop() {
    broadphase_.reset();
    for (btBroadphaseProxy* const proxy : proxies_) btAlignedFree(proxy);
    proxies_.clear();
  }

  std::unique_ptr<btDbvtBroadphase> broadphase_;
  std::vector<btBroadphaseProxy*> proxies_;  // null where there is no box
  float margin_ = 0;
};

template <int D>
std::unique_ptr<PairTracker<D>> tracker(const Settings&) {
  return std::make_unique<ProxyTracker<D>>(std::make_unique<DbvtProxies<D>>());
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
      .finder_2d = [](const Settings&) { return std::make_unique<BulletDbvt<2>>(); },
      .finder_3d = [](const Settings&) { return std::make_unique<BulletDbvt<3>>(); },
      .tracker_2d = tracker<2>,
      .tracker_3d = tracker<3>,
      .infinite_boxes = false,  // moving boxes are made larger, and their centres compared
      .largest_coordinate = 1e30,
      .own_allocator = true,
  };
}

}  // namespace broadside::lab::peers
