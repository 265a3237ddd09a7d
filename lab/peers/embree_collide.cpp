// Embree's rtcCollide: a hierarchy of boxes joined with itself.
#include <algorithm>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

#include <tbb/task_arena.h>

#include "lab/peers/embree_handles.hpp"
#include "lab/peers/peers.hpp"

namespace broadside::lab::peers {
namespace {

class EmbreeCollide final : public PairFinder<3> {
 public:
  EmbreeCollide() : device_(rtcNewDevice("set_affinity=0")) {
    if (!device_) throw_error(nullptr);
    scene_.reset(rtcNewScene(device_.get()));
    geometry_.reset(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryBuildQuality(geometry_.get(), RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserData(geometry_.get(), this);
    rtcSetGeometryBoundsFunction(geometry_.get(), bound, nullptr);
    rtcAttachGeometry(scene_.get(), geometry_.get());
    check();
  }

 private:
  void find_valid(std::span<const Box3> boxes, PairSink& pairs) override {
    if (boxes.size() < 2) return;
    boxes_ = boxes;
    pairs_ = &pairs;
    thrown_ = nullptr;
    // A device with one thread would hold all of the process to one; an arena with one holds what runs in it.
    arena_.execute([this] {
      // Searched once, a hierarchy built fast is worth more than a good one. But the fast builder ends the
      // program where all boxes are one point.
      const Box3& first = boxes_.front();
      const bool all_one_point = first.min == first.max && std::ranges::all_of(boxes_, [&](const Box3& box) {
                                   return box.min == first.min && box.max == first.max;
                                 });
      rtcSetSceneBuildQuality(scene_.get(), all_one_point ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW);
      rtcSetGeometryUserPrimitiveCount(geometry_.get(), static_cast<unsigned>(boxes_.size()));
      rtcCommitGeometry(geometry_.get());
      rtcCommitScene(scene_.get());
      rtcCollide(scene_.get(), scene_.get(), report, this);
    });
    if (thrown_) std::rethrow_exception(thrown_);
    check();
  }

  static void bound(const RTCBoundsFunctionArguments* arguments) {
    const auto& self = *static_cast<const EmbreeCollide*>(arguments->geometryUserPtr);
    const Box3& box = self.boxes_[arguments->primID];
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = box.min[0];
    bounds.lower_y = box.min[1];
    bounds.lower_z = box.min[2];
    bounds.upper_x = box.max[0];
    bounds.upper_y = box.max[1];
    bounds.upper_z = box.max[2];
  }

  /// Takes pairs of leaves, both ways round; Embree does not promise that their boxes overlap.
  static void report(void* user, RTCCollision* collisions, unsigned count) {
    auto& self = *static_cast<EmbreeCollide*>(user);
    if (self.thrown_) return;
    try {
      for (const RTCCollision& collision : std::span(collisions, count)) {
        const unsigned a = collision.primID0;
        const unsigned b = collision.primID1;
        if (a < b && overlap(self.boxes_[a], self.boxes_[b])) self.pairs_->add(BoxId{a}, BoxId{b});
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
  EmbreeOwned<RTCScene> scene_;
  EmbreeOwned<RTCGeometry> geometry_;
  std::span<const Box3> boxes_;  // of the search that is going on
  PairSink* pairs_ = nullptr;
  std::exception_ptr thrown_;
};

}  // namespace

Algorithm embree_collide() {
  return {
      .name = "embree_collide",
      .summary = "Embree's hierarchy of boxes collided with itself, in one thread",
      .source = "Embree, rtcCollide",
      .version = "Embree " RTC_VERSION_STRING,
      .finder_3d = [](const Settings&) { return std::make_unique<EmbreeCollide>(); },
      .infinite_boxes = false,
      .largest_coordinate = 1.8e18,  // beyond 1.844e18 it drops boxes as invalid
      .own_allocator = true,
  };
}

}  // namespace broadside::lab::peers
