// What Chipmunk's two spatial indexes share: its generic interface, fed with boxes.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include <chipmunk/chipmunk.h>

#include "broadside/algorithm.hpp"

namespace broadside::lab::peers {

struct FreeIndex {
  void operator()(cpSpatialIndex* spatial_index) const { cpSpatialIndexFree(spatial_index); }
};
using ChipmunkIndex = std::unique_ptr<cpSpatialIndex, FreeIndex>;

/// An object in an index. It must not move in memory while it is there.
struct ChipmunkObject {
  cpBB bounds;
  cpVect velocity;  ///< a second
  BoxId id;
};

/// What a cpSpatialIndexBBFunc must do for a ChipmunkObject.
cpBB bounds_of(void* object);

/// Makes an empty index that suits `boxes`; for objects that move or for one search.
using MakeIndex = ChipmunkIndex (*)(std::span<const Box2> boxes, bool moving);

/// The description of an index that `Make` makes: a finder that fills a new one in each call, and a tracker
/// that keeps one.
Algorithm chipmunk_index(MakeIndex make);

}  // namespace broadside::lab::peers
