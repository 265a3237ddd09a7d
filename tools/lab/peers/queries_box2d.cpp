// Box queries and ray casts in Box2D's b2DynamicTree, filled box by box.
#include <cmath>
#include <cstdint>
#include <optional>

#include <box2d/box2d.h>

#include "lab/peers/queries.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {
namespace {

class Box2dQueries final : public QueryPeer<2> {
 public:
  explicit Box2dQueries(std::span<const Box2> boxes)
      : boxes_(boxes), scale_(std::ldexp(1.0f, -std::ilogb(typical_extent(boxes)))), id_of_(boxes.size()) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const std::int32_t proxy = tree_.CreateProxy(converted(boxes[i]), nullptr);
      if (id_of_.size() <= static_cast<std::size_t>(proxy))
        id_of_.resize(static_cast<std::size_t>(proxy) * 2);
      id_of_[static_cast<std::size_t>(proxy)] = BoxId(i);
    }
  }

  std::string name() const override { return "box2d_tree"; }
  bool has_boxes() const override { return true; }
  bool has_rays() const override { return true; }

  // Box2D calls members of these by its own names. Its boxes have margins: each is looked at again.
  // NOLINTBEGIN(readability-identifier-naming)
  struct Overlapping {
    bool QueryCallback(std::int32_t proxy) {
      const BoxId id = peer.id_of_[static_cast<std::size_t>(proxy)];
      if (overlap(peer.boxes_[index(id)], box)) answers.add(query, id);
      return true;
    }
    const Box2dQueries& peer;
    const Box2& box;
    std::size_t query;
    Answers& answers;
  };

  struct All {
    float RayCastCallback(const b2RayCastInput& input, std::int32_t proxy) {
      const BoxId id = peer.id_of_[static_cast<std::size_t>(proxy)];
      if (t_enter(ray, peer.boxes_[index(id)])) answers.add(query, id);
      return input.maxFraction;
    }
    const Box2dQueries& peer;
    const Ray<2>& ray;
    std::size_t query;
    Answers& answers;
  };

  struct FirstHitCallback {
    float RayCastCallback(const b2RayCastInput& input, std::int32_t proxy) {
      const BoxId id = peer.id_of_[static_cast<std::size_t>(proxy)];
      const std::optional<float> enter = t_enter(ray, peer.boxes_[index(id)]);
      if (!enter || (found && (*enter > nearest || (*enter == nearest && id > box))))
        return input.maxFraction;
      found = true;
      nearest = *enter;
      box = id;
      return nearest;
    }
    const Box2dQueries& peer;
    const Ray<2>& ray;
    bool found = false;
    float nearest = 0;
    BoxId box{};
  };
  // NOLINTEND(readability-identifier-naming)

  Answers overlapping(std::span<const Box2> queries) override {
    Answers answers;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      Overlapping callback{*this, queries[i], i, answers};
      tree_.Query(&callback, converted(queries[i]));
    }
    return answers;
  }

  Answers first_hits(std::span<const Ray<2>> rays) override {
    Answers answers;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      FirstHitCallback callback{*this, rays[i]};
      tree_.RayCast(&callback, converted(rays[i]));
      if (callback.found) answers.add(i, callback.box);
    }
    return answers;
  }

  Answers all_hits(std::span<const Ray<2>> rays) override {
    Answers answers;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      All callback{*this, rays[i], i, answers};
      tree_.RayCast(&callback, converted(rays[i]));
    }
    return answers;
  }

 private:
  static b2AABB converted(const Box2& box) { return {{box.min[0], box.min[1]}, {box.max[0], box.max[1]}}; }

  static b2RayCastInput converted(const Ray<2>& ray) {
    const b2Vec2 from(ray.origin[0], ray.origin[1]);
    return {from, from + b2Vec2(ray.direction[0], ray.direction[1]), ray.t_max};
  }

  std::span<const Box2> boxes_;
  float scale_;  // a power of two that scales a typical box to about a metre, to suit the tree's margins
  std::vector<BoxId> id_of_;  // by proxy
  b2DynamicTree tree_;
};

}  // namespace

std::unique_ptr<QueryPeer<2>> box2d_queries(std::span<const Box2> boxes) {
  return std::make_unique<Box2dQueries>(boxes);
}

}  // namespace broadside::lab::peers
