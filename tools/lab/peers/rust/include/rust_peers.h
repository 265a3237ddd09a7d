// The C interface of the static library that this folder builds from crates.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Receives `count` pairs: two ids each, the smaller one first. Returns whether it takes more. Must not
/// throw.
typedef bool (*RustPeerTakes)(void* context, const uint32_t* ids, size_t count);

/// Finds pairs from scratch: see Searcher in src/peer.rs.
typedef struct RustSearcher RustSearcher;

/// Follows boxes: see Follower in src/peer.rs.
typedef struct RustFollower RustFollower;

/// Why the last function that failed in this thread did, such as a panic's message and place. Valid until the
/// next failure.
const char* rust_peer_error(void);

/// The version of a crate in Cargo.lock; null if it is not there. Never freed.
const char* rust_peer_version(const char* crate_name);

/// Null on failure. `dimension` is 2 or 3. `threads` is the number of threads for a library that can use
/// several; 0: all of the machine's.
RustSearcher* rust_searcher_new(const char* name, int dimension, size_t threads);
RustFollower* rust_follower_new(const char* name, int dimension, size_t threads);
void rust_searcher_free(RustSearcher* searcher);
void rust_follower_free(RustFollower* follower);

/// The functions below return false on failure. `boxes` has the minimum and then the maximum of each box.

/// Broadside's Filter.
typedef struct RustFilter {
  uint64_t category;
  uint64_t mask;
  int32_t group;
  bool is_static;
} RustFilter;

/// Gives each overlapping pair once. All boxes are present. If `left_count` is not 0, that many boxes at the
/// front are the left set, and only pairs across the sets count; others may be given. If `filters` is not
/// null, it has a filter for each box, and pairs that these reject may be left out. `length` is that of a
/// typical box, 0 if not needed.
bool rust_searcher_search(RustSearcher* searcher, const float* boxes, size_t count, size_t left_count,
                          const RustFilter* filters, float length, RustPeerTakes takes, void* context);

/// Destroys the structure that the last search left.
bool rust_searcher_tear_down(RustSearcher* searcher);

/// Starts again with the present boxes of `boxes`. `length` is the length of a typical box.
bool rust_follower_build(RustFollower* follower, const float* boxes, size_t count, float length);

/// Moves, adds and removes the boxes at `changed`, whose flags are 1. Gives each pair that has one of these
/// and overlapped before or overlaps now, and may give other pairs.
bool rust_follower_update(RustFollower* follower, const float* boxes, size_t count, const uint32_t* changed,
                          size_t changed_count, const uint8_t* flags, RustPeerTakes takes, void* context);

/// An index of boxes that answers queries.
typedef struct RustIndex RustIndex;

/// What a query finds: the boxes that overlap a box, the first box that a ray hits, or all boxes that it
/// hits. A ray is an origin, a direction and the maximum t.
typedef enum RustQueries { rust_boxes, rust_first_hits, rust_all_hits } RustQueries;

/// Null on failure. All boxes are present.
RustIndex* rust_index_new(const char* name, int dimension, const float* boxes, size_t count);
void rust_index_free(RustIndex* index);

/// Gives each box found as a pair: the number of the query, then the box.
bool rust_index_ask(RustIndex* index, RustQueries kind, const float* queries, size_t count,
                    RustPeerTakes takes, void* context);

/// Gives the `max_results` boxes nearest to each point likewise. `points` has the coordinates of `count`
/// points.
bool rust_index_nearest(RustIndex* index, const float* points, size_t count, size_t max_results,
                        RustPeerTakes take, void* context);

/// A physics engine that runs a scene: see Simulation in src/simulations/mod.rs. Only in builds with engines.
typedef struct RustSimulation RustSimulation;

/// In 2D, z is ignored.
typedef struct RustVector {
  float at[3];
} RustVector;

enum RustBodyKind { rust_body_static, rust_body_kinematic, rust_body_dynamic };

/// A box with sides of twice `half`, or a ball with the radius half.at[0]. The axis of angle and spin is z.
typedef struct RustBody {
  RustVector position;
  RustVector half;
  float angle;
  float spin;
  enum RustBodyKind kind;
  bool is_ball;
} RustBody;

typedef struct RustBounds {
  RustVector min;
  RustVector max;
} RustBounds;

/// Null on failure.
RustSimulation* rust_simulation_new(const char* engine);
void rust_simulation_free(RustSimulation* simulation);
int rust_simulation_dimension(const RustSimulation* simulation);

/// The margin that the engine promises (see Recorder) for boxes that keep their sizes.
float rust_simulation_margin(const RustSimulation* simulation);

/// The functions below return false on failure. Slots number bodies.
bool rust_simulation_set_gravity(RustSimulation* simulation, const RustVector* gravity);
bool rust_simulation_add(RustSimulation* simulation, uint32_t slot, const RustBody* body);
bool rust_simulation_remove(RustSimulation* simulation, uint32_t slot);

/// Puts a body elsewhere, upright, and wakes it.
bool rust_simulation_place(RustSimulation* simulation, uint32_t slot, const RustVector* position,
                           const RustVector* velocity);

/// The box that the broad phase would be given if the next step began now.
bool rust_simulation_bounds(const RustSimulation* simulation, uint32_t slot, RustBounds* bounds);

/// The enlarged box with which the broad phase found the body's pairs in the last step; false if it keeps
/// none.
bool rust_simulation_enlarged(const RustSimulation* simulation, uint32_t slot, RustBounds* bounds);

/// Runs a step, and gives the pairs that the broad phase held after it found pairs and before bodies moved.
bool rust_simulation_step(RustSimulation* simulation, RustPeerTakes takes, void* context);

#ifdef __cplusplus
}
#endif
