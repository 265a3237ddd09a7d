// Embree: rtcCollide joins a bounding volume hierarchy of boxes with itself; rays traverse it with the boxes
// as user geometry.
#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

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

/// A scene of one user geometry, the boxes of a set.
template <int D>
class EmbreeSet {
 public:
  explicit EmbreeSet(RTCDevice device)
      : scene_(rtcNewScene(device)), geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER)) {
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
    const Box<D>& first = boxes_.front();
    const bool all_one_point = first.min == first.max && std::ranges::all_of(boxes_, [&](const Box<D>& box) {
                                 return box.min == first.min && box.max == first.max;
                               });
    rtcSetSceneBuildQuality(scene_.get(), all_one_point ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(boxes_.size()));
    rtcCommitGeometry(geometry_.get());
    rtcCommitScene(scene_.get());
  }

  RTCScene scene() const { return scene_.get(); }

 private:
  static void bound(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const EmbreeSet*>(arguments->geometryUserPtr);
    *arguments->bounds_o = bounds_of(self.boxes_[arguments->primID]);
  }

  EmbreeOwned<RTCScene> scene_;
  EmbreeOwned<RTCGeometry> geometry_;
  std::span<const Box<D>> boxes_;
};

template <int D>
class EmbreeCollide final : public Searcher<D> {
 public:
  EmbreeCollide() : device_(rtcNewDevice("set_affinity=0")) {
    if (!device_) throw_error(nullptr);
    for (auto& set : sets_) set.emplace(device_.get());
    check();
  }

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    if (input.boxes.size() < 2) return std::nullopt;
    boxes_ = input.boxes;
    left_count_ = input.left_count;
    pairs_ = &pairs;
    thrown_ = nullptr;
    // A device with one thread would restrict the whole process to one; an arena with one thread restricts
    // only the code that runs in it.
    arena_.execute([this] {
      if (left_count_ > 0) sets_[1]->build(boxes_.first(left_count_));
      sets_[0]->build(boxes_.subspan(left_count_));
      rtcCollide(sets_[left_count_ > 0 ? 1 : 0]->scene(), sets_[0]->scene(), report, this);
    });
    if (thrown_) std::rethrow_exception(thrown_);
    check();
    return std::nullopt;
  }

 private:
  /// Receives pairs of leaves, of one set in both orders; Embree does not guarantee that their boxes overlap.
  static void report(void* user, RTCCollision* collisions, unsigned count) {
    auto& self = *static_cast<EmbreeCollide*>(user);
    if (self.thrown_) return;
    try {
      for (const RTCCollision& collision : std::span(collisions, count)) {
        const std::size_t a = collision.primID0;
        const std::size_t b = collision.primID1 + self.left_count_;
        if (a < b && overlap(self.boxes_[a], self.boxes_[b])) self.pairs_->add(BoxId(a), BoxId(b));
      }
    } catch (...) {  // must not pass through Embree
      self.thrown_ = std::current_exception();
    }
  }

  void check() const {
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) throw_error(device_.get());
  }

  [[noreturn]] static void throw_error(RTCDevice device) {
    throw std::runtime_error("Embree reports error " + std::to_string(rtcGetDeviceError(device)) +
                             "; expected none");
  }

  tbb::task_arena arena_{1};
  EmbreeOwned<RTCDevice> device_;
  std::array<std::optional<EmbreeSet<D>>, 2> sets_;  // all boxes, or the right set; the left set
  std::span<const Box<D>> boxes_;                    // of the current search
  std::size_t left_count_ = 0;
  PairSink* pairs_ = nullptr;
  std::exception_ptr thrown_;
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
      .summary = "Embree's hierarchy of boxes collided with itself, in one thread",
      .source = "Embree, rtcCollide",
      .version = "Embree " RTC_VERSION_STRING,
      .in_2d = {.searcher = make_strategy<EmbreeCollide<2>>},
      .in_3d = {.searcher = make_strategy<EmbreeCollide<3>>},
      // Beyond 1.844e18, Embree drops boxes as invalid.
      .limits = {.infinite_boxes = false, .max_coordinate = 1.8e18},
      .own_allocator = true,
  };
}

std::unique_ptr<QueryPeer<3>> embree_queries(std::span<const Box3> boxes) {
  return std::make_unique<EmbreeQueries>(boxes);
}

}  // namespace broadside::lab::peers
