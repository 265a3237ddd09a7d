// Bullet's bt32BitAxisSweep3: sorted end points of boxes on three axes, kept from frame to frame.
#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>

#include "lab/peers/bullet_proxies.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab::peers {
namespace {

template <int D>
std::unique_ptr<btBroadphaseInterface> make_sweep(std::span<const Box<D>> boxes, unsigned max_boxes) {
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
  // Room to move in; boxes beyond it are still found, at a higher cost. Every axis needs an extent.
  const btVector3 room = (max - min) * btScalar(0.25) + btVector3(1, 1, 1);
  constexpr bool no_rays = true;
  return std::make_unique<bt32BitAxisSweep3>(min - room, max + room, max_boxes, nullptr, no_rays);
}

template <int D>
std::unique_ptr<Proxies<D>> proxies() {
  constexpr bool bounded = true;
  return std::make_unique<BulletProxies<D>>(make_sweep<D>, bounded);
}

template <int D>
Strategies<D> sweep_strategies() {
  return {.searcher = [](const Settings&) { return std::make_unique<ProxySearcher<D>>(proxies<D>()); },
          .followers = {{.name = "bt32BitAxisSweep3", .make = [](const Settings&) {
                           return std::make_unique<ProxyFollower<D>>(proxies<D>());
                         }}}};
}

}  // namespace

Algorithm bullet_axis_sweep() {
  return {
      .name = "bullet_axis_sweep",
      .summary = "Bullet's incremental sweep and prune on three axes, in 32 bits",
      .source = "Bullet, bt32BitAxisSweep3",
      .version = bullet_version(),
      .in_2d = sweep_strategies<2>(),
      .in_3d = sweep_strategies<3>(),
      // Its world is bounded.
      .limits = {.infinite_boxes = false, .max_coordinate = 1e30},
      .own_allocator = true,
  };
}

}  // namespace broadside::lab::peers
