// Boxes in one of Bullet's broad phases, whose pair cache gives the pairs.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <LinearMath/btVector3.h>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "lab/peers/proxies.hpp"

namespace broadside::lab::peers {

template <std::size_t D>
btVector3 bullet_point(const std::array<float, D>& corner) {
  if constexpr (D == 2)
    return {corner[0], corner[1], 0};
  else
    return {corner[0], corner[1], corner[2]};
}

inline void* bullet_data(BoxId id) { return std::bit_cast<void*>(std::uintptr_t{index(id)}); }

inline BoxId id_in(const void* data) { return BoxId(std::bit_cast<std::uintptr_t>(data)); }

/// Such as "Bullet 3.24".
std::string bullet_version();

/// Makes an empty broad phase, which frees its proxies, for `boxes` and at most `max_boxes` boxes.
template <int D>
using MakeBroadphase =
    std::function<std::unique_ptr<btBroadphaseInterface>(std::span<const Box<D>> boxes, unsigned max_boxes)>;

template <int D>
class BulletProxies final : public Proxies<D> {
 public:
  /// `bounded` if the broad phase cannot hold more boxes than it was made for.
  BulletProxies(MakeBroadphase<D> make, bool bounded) : make_(std::move(make)), bounded_(bounded) {}

  void clear(std::span<const Box<D>> boxes) override {
    max_boxes_ = static_cast<unsigned>(boxes.size()) * 2 + 16;
    broadphase_.reset();
    broadphase_ = make_(boxes, max_boxes_);
    proxies_.assign(boxes.size(), nullptr);
  }

  bool fits(std::span<const Box<D>> boxes) const override { return !bounded_ || boxes.size() <= max_boxes_; }

  void add(BoxId id, const Box<D>& box) override {
    if (proxies_.size() <= index(id)) proxies_.resize(index(id) + std::size_t{1});
    proxies_[index(id)] = broadphase_->createProxy(bullet_point(box.min), bullet_point(box.max), 0,
                                                   bullet_data(id), 1, 1, nullptr);
  }

  void move(BoxId id, const Box<D>& box) override {
    broadphase_->setAabb(proxies_[index(id)], bullet_point(box.min), bullet_point(box.max), nullptr);
  }

  void remove(BoxId id) override {
    broadphase_->destroyProxy(std::exchange(proxies_[index(id)], nullptr), nullptr);
  }

  void collect(std::span<const Box<D>> boxes, std::span<const std::uint8_t> flags, PairSink& pairs) override {
    broadphase_->calculateOverlappingPairs(nullptr);
    // The cache has pairs of rounded or enlarged boxes, and some that no longer overlap.
    btOverlappingPairCache& cache = *broadphase_->getOverlappingPairCache();
    const btBroadphasePair* const cached = cache.getOverlappingPairArrayPtr();
    for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
      const BoxId a = id_in(cached[i].m_pProxy0->m_clientObject);
      const BoxId b = id_in(cached[i].m_pProxy1->m_clientObject);
      if (!flags.empty() && (flags[index(a)] | flags[index(b)]) == 0) continue;
      if (overlap(boxes[index(a)], boxes[index(b)])) pairs.add(a, b);
    }
  }

 private:
  MakeBroadphase<D> make_;
  bool bounded_;
  unsigned max_boxes_ = 0;
  std::unique_ptr<btBroadphaseInterface> broadphase_;
  std::vector<btBroadphaseProxy*> proxies_;  // by place; null if there is no box
};

}  // namespace broadside::lab::peers
