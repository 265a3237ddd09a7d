// Embree: rtcCollide joins a bounding volume hierarchy of boxes with itself; rays traverse it with the boxes
// as user geometry.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <embree3/rtcore.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "lab/peers/callback_sink.hpp"
#include "lab/peers/peer_follower.hpp"
#include "lab/peers/peers.hpp"
#include "lab/peers/queries.hpp"

namespace broadside::lab::peers {
namespace {

/// Releases one of Embree's objects.
struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

/// A device, scene or geometry, released by its owner.
template <typename Handle>
using EmbreeOwned = std::unique_ptr<std::remove_pointer_t<Handle>, EmbreeRelease>;

/// A 2D box is flat at z = 0.
template <int D>
RTCBounds bounds_of(const Box<D>& box) {
  return {.lower_x = box.min[0],
          .lower_y = box.min[1],
          .lower_z = D == 3 ? box.min[D - 1] : 0,
          .align0 = 0,
          .upper_x = box.max[0],
          .upper_y = box.max[1],
          .upper_z = D == 3 ? box.max[D - 1] : 0,
          .align1 = 0};
}

/// Whether all present boxes are at one point for Embree, which treats subnormal numbers as 0.
template <int D>
bool are_one_point(std::span<const Box<D>> boxes) {
  const auto first = std::ranges::find_if(boxes, is_present<D, float>);
  return std::all_of(first, boxes.end(), [&](const Box<D>& box) {
    if (!is_present(box)) return true;
    for (int axis = 0; axis < D; ++axis) {
      constexpr float least = std::numeric_limits<float>::min();
      if (box.max[axis] - first->min[axis] >= least || first->min[axis] - box.min[axis] >= least)
        return false;
    }
    return true;
  });
}

/// A scene of one user geometry: the boxes of a set.
template <int D>
class EmbreeSet {
 public:
  explicit EmbreeSet(RTCDevice device, RTCSceneFlags flags = RTC_SCENE_FLAG_NONE)
      : scene_(rtcNewScene(device)), geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER)) {
    rtcSetSceneFlags(scene_.get(), flags);
    rtcSetGeometryBuildQuality(geometry_.get(), RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserData(geometry_.get(), this);
    rtcSetGeometryBoundsFunction(geometry_.get(), bound, nullptr);
    rtcAttachGeometry(scene_.get(), geometry_.get());
  }
  EmbreeSet(const EmbreeSet&) = delete;
  EmbreeSet& operator=(const EmbreeSet&) = delete;

  void build(std::span<const Box<D>> boxes) {
    boxes_ = boxes;
    // For a single search, a fast build is worth more than a good hierarchy. But the fast builder
    // terminates the program if all boxes are one point.
    const bool all_one_point = are_one_point(boxes_);
    const RTCBuildQuality quality = all_one_point ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW;
    rtcSetSceneBuildQuality(scene_.get(), quality);
    rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(boxes_.size()));
    commit(quality);
  }

  /// Refits the hierarchy of a dynamic scene to the same number of boxes; the same ones must be present.
  void refit(std::span<const Box<D>> boxes) {
    boxes_ = boxes;
    commit(RTC_BUILD_QUALITY_REFIT);
  }

  RTCScene scene() const { return scene_.get(); }

 private:
  void commit(RTCBuildQuality quality) {
    rtcSetGeometryBuildQuality(geometry_.get(), quality);
    rtcCommitGeometry(geometry_.get());
    rtcCommitScene(scene_.get());
  }

  static void bound(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const EmbreeSet*>(arguments->geometryUserPtr);
    *arguments->bounds_o = bounds_of(self.boxes_[arguments->primID]);
  }

  EmbreeOwned<RTCScene> scene_;
  EmbreeOwned<RTCGeometry> geometry_;
  std::span<const Box<D>> boxes_;
};

/// Collides two sets, or one with itself.
template <int D>
class EmbreeJoin {
 public:
  explicit EmbreeJoin(const Settings& settings)
      : threads_(static_cast<int>(settings.integer("threads"))),
        // oneTBB warns of more threads than the machine has.
        arena_(threads_ == 0 ? tbb::task_arena::automatic
                             : std::min(threads_, tbb::info::default_concurrency())),
        device_(rtcNewDevice("set_affinity=0")) {
    check();
  }

  RTCDevice device() const { return device_.get(); }

  /// Calls `prepare`, which builds the sets and returns the left and the right scene, and collides these. If
  /// `flags` is not empty, leaves out pairs of boxes that both have no flag.
  template <typename Prepare>
  void collide(std::span<const Box<D>> boxes, std::size_t left_count, std::span<const std::uint8_t> flags,
               PairSink& pairs, const Prepare& prepare) {
    boxes_ = boxes;
    left_count_ = left_count;
    flags_ = flags;
    CallbackSink sink(pairs);
    sink_ = &sink;
    for (std::vector<Pair>& found : found_) found.clear();
    // A device's number of threads would restrict the whole process; an arena's only restricts the code that
    // runs in it.
    arena_.execute([&] {
      const auto [left, right] = prepare();
      rtcCollide(left, right, report, this);
    });
    sink.finish();
    for (const std::vector<Pair>& found : found_) pairs.put(found);
    check();
  }

 private:
  /// Receives pairs of leaves, in both orders if there is one set, in any thread of the arena. Embree does
  /// not guarantee that their boxes overlap.
  static void report(void* user, RTCCollision* collisions, unsigned count) noexcept {
    auto& self = *static_cast<EmbreeJoin*>(user);
    std::vector<Pair>* const found = self.threads_ == 1 ? nullptr : &self.found_.local();
    for (const RTCCollision& collision : std::span(collisions, count)) {
      const std::size_t a = collision.primID0;
      const std::size_t b = collision.primID1 + self.left_count_;
      if (a < b && (self.flags_.empty() || (self.flags_[a] | self.flags_[b]) != 0) &&
          overlap(self.boxes_[a], self.boxes_[b])) {
        if (found != nullptr)
          found->push_back({BoxId(a), BoxId(b)});
        else
          self.sink_->add(BoxId(a), BoxId(b));
      }
    }
  }

  void check() const {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (!device_ || error != RTC_ERROR_NONE)
      throw std::runtime_error("Embree reports error " + std::to_string(error) + "; expected none");
  }

  int threads_;
  tbb::task_arena arena_;
  EmbreeOwned<RTCDevice> device_;
  std::span<const Box<D>> boxes_;  // of the current call, as below
  std::size_t left_count_ = 0;
  std::span<const std::uint8_t> flags_;
  CallbackSink* sink_ = nullptr;                              // of one thread
  tbb::enumerable_thread_specific<std::vector<Pair>> found_;  // by several threads
};

template <int D>
class EmbreeCollide final : public Searcher<D> {
 public:
  explicit EmbreeCollide(const Settings& settings) : join_(settings) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    if (input.boxes.size() < 2) return std::nullopt;
    join_.collide(input.boxes, input.left_count, {}, pairs, [&] {
      right_.build(input.boxes.subspan(input.left_count));
      if (input.left_count == 0) return std::pair(right_.scene(), right_.scene());
      left_.build(input.boxes.first(input.left_count));
      return std::pair(left_.scene(), right_.scene());
    });
    return std::nullopt;
  }

 private:
  EmbreeJoin<D> join_;
  EmbreeSet<D> left_{join_.device()};
  EmbreeSet<D> right_{join_.device()};
};

/// Refits the hierarchy if few boxes moved, each only a little; rebuilds it otherwise.
template <int D>
class EmbreeFollower final : public PeerFollower<D> {
 public:
  explicit EmbreeFollower(const Settings& settings) : join_(settings) {}

 private:
  void build(std::span<const Box<D>>, std::span<const Box<D>>) override { is_built_ = is_steady_ = false; }

  void move(const Change<D>& change) override {
    // A box that jumped, appeared or vanished spoils a refitted hierarchy. The builder of dynamic scenes
    // terminates the program if all boxes are at one point.
    is_steady_ = !change.rebuild && !are_one_point(change.now) && change.before.size() == change.now.size() &&
                 change.changed.size() <= change.now.size() / 4 &&
                 std::ranges::all_of(change.changed, [&](BoxId id) {
                   return overlap(change.before[index(id)], change.now[index(id)]);
                 });
    moves_ += change.changed.size();
    is_built_ = is_built_ && is_steady_ && moves_ <= change.now.size();
  }

  void collide(const Change<D>& change, PairSink& pairs) override {
    if (std::ranges::count_if(change.now, is_present<D, float>) < 2) return;
    const auto flags = change.rebuild ? std::span<const std::uint8_t>() : change.flags;
    join_.collide(change.now, 0, flags, pairs, [&] {
      EmbreeSet<D>& set = is_steady_ ? fitted_ : static_;
      if (is_built_) {
        set.refit(change.now);
      } else {
        set.build(change.now);
        is_built_ = is_steady_;
        moves_ = 0;
      }
      return std::pair(set.scene(), set.scene());
    });
  }

  EmbreeJoin<D> join_;
  EmbreeSet<D> static_{join_.device()};  // builds faster
  EmbreeSet<D> fitted_{join_.device(), RTC_SCENE_FLAG_DYNAMIC};
  bool is_steady_ = false;
  bool is_built_ = false;  // whether fitted_ has these boxes
  std::size_t moves_ = 0;  // since it was built
};

class EmbreeQueries final : public QueryPeer<3> {
 public:
  explicit EmbreeQueries(std::span<const Box3> boxes)
      : boxes_(boxes), device_(rtcNewDevice("set_affinity=0")) {
    if (!device_) throw std::runtime_error("Embree gave no device; expected one");
    scene_.reset(rtcNewScene(device_.get()));
    geometry_.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(boxes.size()));
    rtcSetGeometryUserData(geometry_.get(), this);
    rtcSetGeometryBoundsFunction(geometry_.get(), bound, nullptr);
    rtcSetGeometryIntersectFunction(geometry_.get(), intersect);
    rtcAttachGeometry(scene_.get(), geometry_.get());
    tbb::task_arena(1).execute([this] {
      rtcCommitGeometry(geometry_.get());
      rtcCommitScene(scene_.get());
    });
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
      throw std::runtime_error("Embree reports an error; expected none");
  }

  std::string name() const override { return "embree"; }
  bool has_rays() const override { return true; }

  Answers first_hits(std::span<const Ray<3>> rays) override {
    Answers answers;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RayContext search(rays[i], nullptr, i);
      RTCRayHit ray_hit = trace(search);
      if (ray_hit.hit.geomID != RTC_INVALID_GEOMETRY_ID) answers.add(i, BoxId{ray_hit.hit.primID});
    }
    return answers;
  }

  Answers all_hits(std::span<const Ray<3>> rays) override {
    Answers answers;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RayContext search(rays[i], &answers, i);
      trace(search);
    }
    return answers;
  }

 private:
  /// The context that Embree passes to the callback.
  struct RayContext {
    RayContext(const Ray<3>& searched, Answers* found, std::size_t number)
        : ray(searched), answers(found), query(number) {
      rtcInitIntersectContext(&context);
      for (std::size_t axis = 0; axis < 3; ++axis) inverse[axis] = 1 / ray.direction[axis];
    }

    RTCIntersectContext context;  // first, so that its address is that of the search
    const Ray<3>& ray;
    Answers* answers;  // of all hits; null to find the first hit only
    std::size_t query;
    std::array<float, 3> inverse;
  };

  RTCRayHit trace(RayContext& search) const {
    const Ray<3>& ray = search.ray;
    RTCRayHit ray_hit{};
    ray_hit.ray.org_x = ray.origin[0];
    ray_hit.ray.org_y = ray.origin[1];
    ray_hit.ray.org_z = ray.origin[2];
    ray_hit.ray.dir_x = ray.direction[0];
    ray_hit.ray.dir_y = ray.direction[1];
    ray_hit.ray.dir_z = ray.direction[2];
    ray_hit.ray.tnear = 0;
    ray_hit.ray.tfar = ray.t_max;
    ray_hit.ray.mask = 0xffffffffU;
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &search.context, &ray_hit);
    return ray_hit;
  }

  static void bound(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const EmbreeQueries*>(arguments->geometryUserPtr);
    *arguments->bounds_o = bounds_of(self.boxes_[arguments->primID]);
  }

  /// The slab test, with an inverse direction computed once per ray, as in fast code.
  static void intersect(const RTCIntersectFunctionNArguments* arguments) {
    const auto& self = *static_cast<const EmbreeQueries*>(arguments->geometryUserPtr);
    const auto& search = *reinterpret_cast<const RayContext*>(arguments->context);
    const Box3& box = self.boxes_[arguments->primID];
    auto& ray_hit = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);  // of one ray
    float enter = 0;
    float leave = ray_hit.ray.tfar;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float a = (box.min[axis] - search.ray.origin[axis]) * search.inverse[axis];
      const float b = (box.max[axis] - search.ray.origin[axis]) * search.inverse[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (!(enter <= leave)) return;
    if (search.answers != nullptr) {
      search.answers->add(search.query, BoxId{arguments->primID});
      return;
    }
    ray_hit.ray.tfar = enter;
    ray_hit.hit.geomID = arguments->geomID;
    ray_hit.hit.primID = arguments->primID;
  }

  std::span<const Box3> boxes_;
  EmbreeOwned<RTCDevice> device_;
  EmbreeOwned<RTCScene> scene_;
  EmbreeOwned<RTCGeometry> geometry_;
};

}  // namespace

Algorithm embree_collide() {
  return {
      .name = "embree_collide",
      .summary = "Embree's hierarchy of boxes collided with itself",
      .source = "Embree, rtcCollide",
      .version = "Embree " RTC_VERSION_STRING,
      .tunables = {threads_tunable()},
      .in_2d = {.searcher = make_strategy<EmbreeCollide<2>>,
                .followers = {{"rtcCollide", make_strategy<EmbreeFollower<2>>}}},
      .in_3d = {.searcher = make_strategy<EmbreeCollide<3>>,
                .followers = {{"rtcCollide", make_strategy<EmbreeFollower<3>>}}},
      // Beyond 1.844e18, Embree drops boxes as invalid.
      .limits = {.infinite_boxes = false, .max_coordinate = 1.8e18},
      .own_allocator = true,
  };
}

std::unique_ptr<QueryPeer<3>> embree_queries(std::span<const Box3> boxes) {
  return std::make_unique<EmbreeQueries>(boxes);
}

}  // namespace broadside::lab::peers
