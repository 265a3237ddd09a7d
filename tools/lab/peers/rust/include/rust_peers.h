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

/// Null on failure. `dimension` is 2 or 3.
RustSearcher* rust_searcher_new(const char* name, int dimension);
RustFollower* rust_follower_new(const char* name, int dimension);
void rust_searcher_free(RustSearcher* searcher);
void rust_follower_free(RustFollower* follower);

/// The functions below return false on failure. `boxes` has the minimum and then the maximum of each box.

/// Gives each overlapping pair once. All boxes are present. If `left_count` is not 0, the boxes before it are
/// the left set, and only pairs with a box of each set count: others may be given. `length` is that of a
/// typical box, 0 if not needed.
bool rust_searcher_search(RustSearcher* searcher, const float* boxes, size_t count, size_t left_count,
                          float length, RustPeerTakes takes, void* context);

/// Destroys the structure that the last search left.
bool rust_searcher_tear_down(RustSearcher* searcher);

/// Starts again with the present boxes of `boxes`. `length` is the length of a typical box.
bool rust_follower_build(RustFollower* follower, const float* boxes, size_t count, float length);

/// Moves, adds and removes the boxes at `changed`, whose flags are 1. Gives each pair that has one of these
/// and overlapped before or overlaps now, and may give other pairs.
bool rust_follower_update(RustFollower* follower, const float* boxes, size_t count, const uint32_t* changed,
                          size_t changed_count, const uint8_t* flags, RustPeerTakes takes, void* context);

/// An index of boxes, which answers queries.
typedef struct RustIndex RustIndex;

/// What is asked: the boxes that overlap a box; the first box that a ray hits, or all that it hits. Rays are
/// an origin, a direction and the greatest t.
typedef enum RustQueries { RUST_BOXES, RUST_FIRST_HITS, RUST_ALL_HITS } RustQueries;

/// Null on failure. All boxes are present.
RustIndex* rust_index_new(const char* name, int dimension, const float* boxes, size_t count);
void rust_index_free(RustIndex* index);

/// Gives the number of each query with each box found, as a pair in this order.
bool rust_index_ask(RustIndex* index, RustQueries kind, const float* queries, size_t count,
                    RustPeerTakes takes, void* context);

#ifdef __cplusplus
}
#endif
