// Box2D's b2BroadPhase: a balanced binary tree of enlarged boxes, inserted one by one.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <box2d/box2d.h>

#include "lab/peers/callback_sink.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/tear_down.hpp"
#include "lab/peers/typical_extent.hpp"

namespace broadside::lab::peers {
namespace {

/// The power of two that scales a typical box to half a metre to a metre, which suits the tree's margins of
/// 0.1 m, as far as no coordinate overflows. Recorded scenes keep their original scale. Rounding (of
/// denormals) keeps the order of coordinates, so no pair is lost.
float scale_of(std::span<const Box2> boxes) {
  float greatest = 0;
  for (const Box2& box : boxes) {
    for (const float at : {box.min[0], box.min[1], box.max[0], box.max[1]}) {
      if (!std::isinf(at)) greatest = std::max(greatest, std::abs(at));
    }
  }
  constexpr int greatest_exponent = 100;  // a product of two lengths may overflow, which only makes the tree
                                          // worse
  const int wanted = -1 - std::ilogb(typical_extent(boxes));
  const int max_scale_exponent = greatest > 0 ? greatest_exponent - std::ilogb(greatest) : greatest_exponent;
  return std::ldexp(1.0f,
                    std::clamp(std::min(wanted, max_scale_exponent), -greatest_exponent, greatest_exponent));
}

b2AABB scaled(const Box2& box, float scale) {
  return {{box.min[0] * scale, box.min[1] * scale}, {box.max[0] * scale, box.max[1] * scale}};
}

void* user_data(BoxId id) { return std::bit_cast<void*>(std::uintptr_t{index(id)}); }
BoxId id_of(void* data) { return BoxId(std::bit_cast<std::uintptr_t>(data)); }

class Box2dSearcher final : public Searcher<2>, public TearDown {
 public:
  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& pairs) override {
    const std::span<const Box2> boxes = input.boxes;
    b2BroadPhase& broad_phase = broad_phase_.emplace();
    const float scale = scale_of(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i)
      broad_phase.CreateProxy(scaled(boxes[i], scale), user_data(BoxId(i)));
    PairReport report{boxes, CallbackSink(pairs)};
    broad_phase.UpdatePairs(&report);
    report.pairs.finish();
    return std::nullopt;
  }

  void tear_down() override { broad_phase_.reset(); }

 private:
  /// The callback of b2BroadPhase::UpdatePairs; margins give more pairs than overlap.
  struct PairReport {
    std::span<const Box2> boxes;
    CallbackSink pairs;

    void AddPair(void* first, void* second) {  // NOLINT(readability-identifier-naming): Box2D's name
      const BoxId a = id_of(first);
      const BoxId b = id_of(second);
      if (overlap(boxes[index(a)], boxes[index(b)])) pairs.add(a, b);
    }
  };

  std::optional<b2BroadPhase> broad_phase_;  // of the last search
};

/// Works like b2ContactManager: pairs of enlarged boxes are contacts, which are tested again in every frame;
/// the broad phase reports the contacts of boxes that left their margins.
class Box2dFollower final : public Follower<2> {
 public:
  std::optional<Statistics> follow(const Change<2>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild) build(change);
    moved_.assign(change.now.size(), 0);
    proxies_.resize(std::max(proxies_.size(), change.now.size()), b2BroadPhase::e_nullProxy);
    // Removals first: each searches the list of moved proxies.
    for (const BoxId id : change.changed) {
      if (!is_present(change.now[index(id)])) remove(id);
    }
    for (const BoxId id : change.changed) {
      if (is_present(change.now[index(id)])) put(id, change);
    }

    auto kept = contacts_.begin();
    for (const Pair pair : contacts_) {
      const auto either = [pair](std::span<const std::uint8_t> flags) {
        return (flags[index(pair.first)] | flags[index(pair.second)]) != 0;
      };
      if (either(change.flags)) {
        change.report(pair.first, pair.second, begun, ended);
        // The broad phase reports the contacts of the proxies that it moved.
        if (either(moved_)) continue;
      }
      *kept++ = pair;
    }
    contacts_.erase(kept, contacts_.end());
    const std::size_t known = contacts_.size();
    Contacts contacts{contacts_};
    broad_phase_->UpdatePairs(&contacts);
    for (std::size_t i = known; i < contacts_.size(); ++i) {
      const Pair pair = contacts_[i];
      change.report(pair.first, pair.second, begun, ended);
    }
    return std::nullopt;
  }

 private:
  struct Contacts {
    std::vector<Pair>& pairs;

    void AddPair(void* first, void* second) {  // NOLINT(readability-identifier-naming): Box2D's name
      const BoxId a = id_of(first);
      const BoxId b = id_of(second);
      pairs.push_back({std::min(a, b), std::max(a, b)});
    }
  };

  /// Starts with the boxes of `change.before`.
  void build(const Change<2>& change) {
    broad_phase_.emplace();
    scale_ = scale_of(change.now);
    proxies_.assign(change.now.size(), b2BroadPhase::e_nullProxy);
    for (std::size_t i = 0; i < change.before.size(); ++i) {
      if (!is_present(change.before[i])) continue;
      proxies_[i] = broad_phase_->CreateProxy(scaled(change.before[i], scale_), user_data(BoxId(i)));
    }
    contacts_.clear();
    Contacts contacts{contacts_};
    broad_phase_->UpdatePairs(&contacts);
  }

  void remove(BoxId id) {
    std::int32_t& proxy = proxies_[index(id)];
    if (proxy == b2BroadPhase::e_nullProxy) return;
    broad_phase_->DestroyProxy(proxy);
    proxy = b2BroadPhase::e_nullProxy;
    moved_[index(id)] = 1;
  }

  void put(BoxId id, const Change<2>& change) {
    const Box2& before = change.before[index(id)];
    const Box2& now = change.now[index(id)];
    const b2AABB bounds = scaled(now, scale_);
    std::int32_t& proxy = proxies_[index(id)];
    if (proxy == b2BroadPhase::e_nullProxy) {
      proxy = broad_phase_->CreateProxy(bounds, user_data(id));
      moved_[index(id)] = 1;
      return;
    }
    const b2AABB fat = broad_phase_->GetFatAABB(proxy);
    broad_phase_->MoveProxy(proxy, bounds, displacement(scaled(before, scale_), bounds));
    const b2AABB& fat_now = broad_phase_->GetFatAABB(proxy);
    moved_[index(id)] = !(fat.lowerBound == fat_now.lowerBound && fat.upperBound == fat_now.upperBound);
  }

  /// The displacement that b2Fixture passes to the tree, to predict motion: the step of the centre. Zero if
  /// the box moved farther than its own size, because it was then placed, as by b2Body::SetTransform.
  static b2Vec2 displacement(const b2AABB& before, const b2AABB& now) {
    const b2Vec2 step = now.GetCenter() - before.GetCenter();
    const b2Vec2 size = now.upperBound - now.lowerBound;
    const bool stepped = std::abs(step.x) <= size.x && std::abs(step.y) <= size.y;
    return stepped ? step : b2Vec2_zero;
  }

  std::optional<b2BroadPhase> broad_phase_;
  float scale_ = 1;
  std::vector<std::int32_t> proxies_;  // by place
  std::vector<std::uint8_t> moved_;    // by place: whether the tree moved the box's proxy
  std::vector<Pair> contacts_;
};

}  // namespace

Algorithm box2d_tree() {
  return {
      .name = "box2d_tree",
      .summary = "Box2D's broad phase: a dynamic tree of boxes with margins, balanced by rotations",
      .source = "Box2D, b2BroadPhase and b2DynamicTree, after Presson's btDbvt",
      .kind = AlgorithmKind::peer,
      .version = "Box2D " BROADSIDE_BOX2D_VERSION,
      .in_2d = {.searcher = make_strategy<Box2dSearcher>,
                .followers = {{.name = "b2BroadPhase", .make = make_strategy<Box2dFollower>}}},
      .limits = {.infinite_boxes = false},
      .own_allocator = true,
  };
}

}  // namespace broadside::lab::peers
