// Embree's objects, owned.
#pragma once

#include <memory>
#include <type_traits>

#include <embree3/rtcore.h>

namespace broadside::lab::peers {

/// Releases one of Embree's objects.
struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

/// A device, scene or geometry that is released with its owner.
template <typename Handle>
using EmbreeOwned = std::unique_ptr<std::remove_pointer_t<Handle>, EmbreeRelease>;

}  // namespace broadside::lab::peers
