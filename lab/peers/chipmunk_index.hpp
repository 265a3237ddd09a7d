// What Chipmunk's two spatial indexes share: its generic interface, fed with boxes.
#pragma once

#include <cstdint>
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
  std::uint32_t moved = 0;  ///< the frame in which it moved last
  bool awake = false;       ///< whether it is in the index for what moves
  bool listed = false;      ///< whether it is in the list of those awake
};

/// What a cpSpatialIndexBBFunc must do for a ChipmunkObject.
cpBB bounds_of(void* object);

/// Makes an empty index that suits `boxes`; for objects that move or for one search. Where there is an index
/// of those that rest, which must outlive it, what is in it is searched with those in that one, too.
using MakeIndex = ChipmunkIndex (*)(std::span<const Box2> boxes, bool moving, cpSpatialIndex* resting);

/// The description of an index that `Make` makes: a finder that fills a new one in each call, and a tracker
/// that keeps one.
Algorithm chipmunk_index(MakeIndex make);

}  // namespace broadside::lab::peers
