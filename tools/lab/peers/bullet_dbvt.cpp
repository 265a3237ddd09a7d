// Bullet's dynamic bounding volume tree: btDbvt joined with itself, and btDbvtBroadphase, which keeps one for
// moving boxes.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <fmt/format.h>

#include "lab/peers/bullet_proxies.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/tear_down.hpp"

namespace broadside::lab::peers {
namespace {

template <int D>
class BulletDbvt final : public Searcher<D>, public TearDown {
 public:
  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    tear_down();
    for (std::size_t i = 0; i < input.boxes.size(); ++i) {
      const Box<D>& box = input.boxes[i];
      tree_of(i < input.left_count)
          .insert(btDbvtVolume::FromMM(bullet_point(box.min), bullet_point(box.max)), bullet_data(BoxId(i)));
    }
    ContactReport report(pairs);
    tree_of(false).collideTT(tree_of(input.left_count > 0).m_root, tree_of(false).m_root, report);
    return std::nullopt;
  }

  void tear_down() override {
    for (btDbvt& tree : trees_) tree.clear();
  }

 private:
  btDbvt& tree_of(bool left) { return trees_[left ? 1 : 0]; }

  struct ContactReport final : btDbvt::ICollide {
    explicit ContactReport(PairSink& sink) : pairs(sink) {}
    void Process(const btDbvtNode* a, const btDbvtNode* b) override {
      pairs.add(id_in(a->data), id_in(b->data));
    }
    PairSink& pairs;
  };

  std::array<btDbvt, 2> trees_;  // of the last search: of all boxes or the right set, and of the left set
};

/// Bullet enlarges moving boxes by 0.05, for boxes of size about 1: this uses a twentieth of the typical
/// extent.
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

/// When the pairs of moved boxes are searched for.
enum class Collide { at_once, deferred, by_motion };

/// Has its own margin, where Bullet has one for the whole program, and frees its proxies, which Bullet leaves
/// to the caller to remove one by one.
class OwnDbvt final : public btDbvtBroadphase {
 public:
  OwnDbvt(float margin, Collide collide) : margin_(margin), collide_(collide) {
    m_deferedcollide = collide != Collide::at_once;  // at first all boxes are new
  }

  ~OwnDbvt() override {
    for (btDbvtProxy* proxy : m_stageRoots) {
      while (proxy != nullptr) btAlignedFree(std::exchange(proxy, proxy->links[1]));
    }
  }

  void setAabb(btBroadphaseProxy* proxy, const btVector3& min, const btVector3& max,
               btDispatcher* dispatcher) override {
    const bool rested = static_cast<btDbvtProxy*>(proxy)->stage == STAGECOUNT;
    const unsigned updates = m_updates_done;
    gDbvtMargin = margin_;
    btDbvtBroadphase::setAabb(proxy, min, max, dispatcher);
    if (rested || m_updates_done != updates) ++left_margin_;
  }

  /// If many boxes left their margins in this frame, many will in the next one.
  void calculateOverlappingPairs(btDispatcher* dispatcher) override {
    btDbvtBroadphase::calculateOverlappingPairs(dispatcher);
    const int boxes = m_sets[DYNAMIC_SET].m_leaves + m_sets[FIXED_SET].m_leaves;
    if (collide_ == Collide::by_motion) m_deferedcollide = left_margin_ > many * boxes;
    left_margin_ = 0;
  }

 private:
  // The fraction of the boxes from which deferred search is at least as fast (docs/peers.md).
  static constexpr double many = 0.1;

  float margin_;
  Collide collide_;
  int left_margin_ = 0;  // number of boxes, since the last search
};

template <int D>
std::unique_ptr<Follower<D>> make_dbvt_follower(const Settings& settings) {
  const std::string& text = settings.text("collide");
  const Collide collide = text == "auto"      ? Collide::by_motion
                          : text == "at_once" ? Collide::at_once
                                              : Collide::deferred;
  const auto make = [collide](std::span<const Box<D>> boxes, unsigned) {
    return std::make_unique<OwnDbvt>(margin_for(boxes), collide);
  };
  constexpr bool bounded = false;
  return std::make_unique<ProxyFollower<D>>(std::make_unique<BulletProxies<D>>(make, bounded));
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
                    .summary = "in motion: each box as it moves, as Bullet does unless told, or all at the "
                               "end of the frame; auto: by how many left their margins in the frame before",
                    .default_value = "auto",
                    .type = Tunable::Type::choice,
                    .choices = {"at_once", "deferred"}}},
      .in_2d = {.searcher = make_strategy<BulletDbvt<2>>,
                .followers = {{.name = "btDbvtBroadphase", .make = make_dbvt_follower<2>}}},
      .in_3d = {.searcher = make_strategy<BulletDbvt<3>>,
                .followers = {{.name = "btDbvtBroadphase", .make = make_dbvt_follower<3>}}},
      // Moving boxes are enlarged, and their centres compared.
      .limits = {.infinite_boxes = false, .max_coordinate = 1e30},
      .own_allocator = true,
  };
}

}  // namespace broadside::lab::peers
