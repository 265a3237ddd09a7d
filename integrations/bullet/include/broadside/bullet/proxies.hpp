// The proxies of a BulletBroadphase, which is Bullet's name for an object's box, and their memory pool.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <LinearMath/btVector3.h>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/world.hpp"

namespace broadside::bullet_detail {

using Box = broadside::Box<3, btScalar>;
using World = broadside::World<3, btScalar>;

inline Box box_of(const btVector3& min, const btVector3& max) {
  return {{min.x(), min.y(), min.z()}, {max.x(), max.y(), max.z()}};
}

/// Whether one box contains another; false for NaN.
inline bool encloses(const Box& outer, const Box& inner) {
  bool is_inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    is_inside &= outer.min[axis] <= inner.min[axis];
    is_inside &= inner.min[axis] <= inner.max[axis];
    is_inside &= inner.max[axis] <= outer.max[axis];
  }
  return is_inside;
}

/// The sum of the lengths of a box's sides.
inline btScalar sides_of(const Box& box) {
  return box.max[0] - box.min[0] + box.max[1] - box.min[1] + box.max[2] - box.min[2];
}

/// The smallest distance by which `outer` extends beyond `inner` on any side.
inline btScalar reach_beyond(const Box& outer, const Box& inner) {
  btScalar reach = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const btScalar beyond : {inner.min[axis] - outer.min[axis], outer.max[axis] - inner.max[axis]}) {
      if (beyond > reach) reach = std::nextafter(beyond, std::numeric_limits<btScalar>::max());
    }
  }
  return reach;
}

/// The box enlarged by at least `reach` on every side.
inline Box widened(Box box, btScalar reach) {
  constexpr btScalar infinity = std::numeric_limits<btScalar>::infinity();
  if (reach == 0) return box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::nextafter(box.min[axis] - reach, -infinity);
    box.max[axis] = std::nextafter(box.max[axis] + reach, infinity);
  }
  return box;
}

/// Bullet's record of a box in the world.
struct Proxy : btBroadphaseProxy {
  Handle handle{};            ///< Handle{} unless the proxy is in use
  std::uint32_t moved = 0;    ///< the step in which its box last changed
  std::uint32_t checked = 0;  ///< the step in which `filter_group` and `filter_mask` were last compared
  int filter_group = 0;       ///< as the world has it; anyone may change the members of the base class
  int filter_mask = 0;
  Box enlarged{};          ///< the world's enlarged box, in which the box may move without telling the world
  btScalar spare = 0;      ///< sum of the enlarged box's sides minus that of the box that the world has
  bool is_untold = false;  ///< the box has moved since the world last got it

  bool is_used() const noexcept { return handle != Handle{}; }
};

/// Bullet's rule is the world's: two boxes can pair if each one's mask has a bit of the other's group. The
/// sign is extended, so that Bullet's default filter becomes the world's.
inline Filter filter_of(const Proxy& proxy) noexcept {
  return {.category = static_cast<std::uint64_t>(std::int64_t{proxy.m_collisionFilterGroup}),
          .mask = static_cast<std::uint64_t>(std::int64_t{proxy.m_collisionFilterMask})};
}

inline std::uint64_t user_data_of(const Proxy& proxy) noexcept {
  return std::uint64_t{std::bit_cast<std::uintptr_t>(&proxy)};
}

inline Proxy& proxy_in(std::uint64_t user_data) noexcept {
  return *std::bit_cast<Proxy*>(static_cast<std::uintptr_t>(user_data));
}

/// Proxies at fixed addresses. Their memory is kept as long as the pool, so that a destroyed proxy can still
/// be distinguished from one in use.
class ProxyPool {
 public:
  /// Ensures capacity for one more proxy, and returns the one that take() will allocate.
  Proxy& next() {
    if (free_.empty()) add_chunk();
    return *free_.back();
  }

  /// Allocates next().
  void take() noexcept {
    free_.pop_back();
    ++used_;
  }

  void give_back(Proxy& proxy) noexcept {
    proxy.handle = {};
    proxy.m_clientObject = nullptr;
    free_.push_back(&proxy);  // the capacity suffices for all proxies
    --used_;
  }

  /// Whether an arbitrary pointer is a proxy of this pool, in use or not.
  bool owns(const btBroadphaseProxy* proxy) const noexcept {
    const auto address = std::bit_cast<std::uintptr_t>(proxy);
    // The last chunk is the largest.
    for (auto chunk = chunks_.rbegin(); chunk != chunks_.rend(); ++chunk) {
      const std::uintptr_t offset = address - std::bit_cast<std::uintptr_t>(chunk->proxies.get());
      if (offset < chunk->size * sizeof(Proxy)) return offset % sizeof(Proxy) == 0;
    }
    return false;
  }

  template <typename Function>
  void for_each_used(Function function) const {
    for (const Chunk& chunk : chunks_) {
      for (std::size_t i = 0; i < chunk.size; ++i) {
        if (chunk.proxies[i].is_used()) function(chunk.proxies[i]);
      }
    }
  }

  /// If no proxy is in use: the same addresses will be allocated in the same order again.
  void reset() noexcept {
    free_.clear();
    for (auto chunk = chunks_.rbegin(); chunk != chunks_.rend(); ++chunk) list_free(*chunk);
  }

  std::size_t used() const noexcept { return used_; }

 private:
  struct Chunk {
    std::unique_ptr<Proxy[]> proxies;
    std::size_t size;
  };

  void add_chunk() {
    const std::size_t before = used_ + free_.size();
    const std::size_t size = before < 64 ? 64 : before;  // doubles the capacity
    free_.reserve(before + size);
    chunks_.push_back({std::make_unique<Proxy[]>(size), size});
    list_free(chunks_.back());
  }

  void list_free(const Chunk& chunk) noexcept {
    for (std::size_t i = chunk.size; i-- > 0;) free_.push_back(&chunk.proxies[i]);
  }

  std::vector<Chunk> chunks_;
  std::vector<Proxy*> free_;  // a stack: the next proxy is the last element
  std::size_t used_ = 0;
};

}  // namespace broadside::bullet_detail
