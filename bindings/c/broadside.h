/* Broadside for C: every overlapping pair of axis-aligned boxes, once or frame after frame, and queries.
 *
 * C99 and later, and C++. All functions are those of the C++ library, whose headers say more; docs/c.md shows
 * how to use them.
 *
 * Boxes are closed: boxes that touch overlap. A box is its minima and then its maxima, two or three of each,
 * floats or doubles: see broadside_kind. Results are exact in that type.
 *
 * Errors. A function that can fail returns a broadside_status. What went wrong is written to the
 * broadside_error that is its last argument, unless that is null; where all went well, that is left as it
 * was. A call that fails has changed nothing, but for what it says of its own. No exception leaves the
 * library and no function exits.
 *
 * Memory. The caller owns what a function named `create` makes, and hands it to the `destroy` of the same
 * kind. Arrays that a function hands out belong to the object they came from; each function says how
 * long they stay. The library keeps no pointer to the caller's arrays beyond a call.
 *
 * Threads. There is no global state. Different objects may be used by different threads at once; one object
 * by one thread at a time, but that functions which take it as `const` may be called by several while none
 * changes it. A callback is called in the thread of the call that was handed it; it may not call the object
 * that is calling it unless said otherwise, and must return: to longjmp() out of it, or to throw a C++
 * exception through it, is undefined. A caller that needs that takes pairs into a buffer instead.
 *
 * Functions marked BROADSIDE_API change only with another BROADSIDE_C_API_VERSION; those marked
 * BROADSIDE_EXPERIMENTAL may change with any version of the library.
 */
#ifndef BROADSIDE_H
#define BROADSIDE_H

#include <stddef.h>
#include <stdint.h>

#define BROADSIDE_C_API_VERSION 1

#if defined(_WIN32) && defined(BROADSIDE_SHARED)
#ifdef BROADSIDE_BUILDING
#define BROADSIDE_API __declspec(dllexport)
#else
#define BROADSIDE_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define BROADSIDE_API __attribute__((visibility("default")))
#else
#define BROADSIDE_API
#endif
#define BROADSIDE_EXPERIMENTAL BROADSIDE_API

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Versions and errors ---- */

/** What became of a call: one of these numbers. */
typedef int32_t broadside_status;
enum {
  BROADSIDE_OK = 0,
  BROADSIDE_INVALID_INPUT = 1,     /**< a box with a NaN or min > max; broadside_error says which */
  BROADSIDE_INVALID_FRAME = 2,     /**< arrays that do not fit together */
  BROADSIDE_INVALID_QUERY = 3,     /**< a question with a NaN, or an infinity where there may be none */
  BROADSIDE_INVALID_SPEC = 4,      /**< an unknown algorithm, or a value out of its range */
  BROADSIDE_INVALID_HANDLE = 5,    /**< a handle that names no box of this world */
  BROADSIDE_INVALID_SNAPSHOT = 6,  /**< bytes that are no snapshot of a world like this */
  BROADSIDE_INVALID_ARGUMENT = 7,  /**< another argument that cannot be; a null pointer, say */
  BROADSIDE_TOO_SMALL = 8,         /**< a buffer has too little room; nothing is lost, ask again */
  BROADSIDE_STOPPED = 9,           /**< a callback asked to stop */
  BROADSIDE_OUT_OF_MEMORY = 10,
  BROADSIDE_FAILED = 11            /**< anything else; the message says what */
};

/** What went wrong: thing, value found, value expected. */
typedef struct broadside_error {
  broadside_status status;
  uint64_t index;     /**< of BROADSIDE_INVALID_INPUT: the place of the first such box in its array */
  char message[1000]; /**< UTF-8, ends with a 0; a longer one is cut off */
} broadside_error;

/** The name of a status, such as "invalid input"; "unknown status" for a number that is not a status. */
BROADSIDE_API const char* broadside_status_name(broadside_status status);

/** The library's version, such as "0.3.0". */
BROADSIDE_API const char* broadside_version(void);

/** The version of this interface that the library has. A program compiled with a header of another one gets
 * BROADSIDE_INVALID_ARGUMENT from every function that creates something. */
BROADSIDE_API int broadside_c_api_version(void);

/** The names of the library's algorithms, by number; null from the last one on. */
BROADSIDE_API const char* broadside_algorithm_name(size_t number);

/* ---- Boxes, pairs, filters ---- */

/** Dimension and coordinates of boxes: one of these numbers. */
typedef int32_t broadside_kind;
enum {
  BROADSIDE_FLOAT_2D = 0,  /**< float min_x, min_y, max_x, max_y */
  BROADSIDE_FLOAT_3D = 1,  /**< float min_x, min_y, min_z, max_x, max_y, max_z */
  BROADSIDE_DOUBLE_2D = 2, /**< likewise of doubles */
  BROADSIDE_DOUBLE_3D = 3
};

/** Boxes where they are: `count` of them, of which the first begins at `first`, each `stride` bytes behind
 * the one before; 0 stands for boxes one right behind the other. Aligned or not. */
typedef struct broadside_boxes {
  broadside_kind kind;
  const void* first; /**< may be null if there is none */
  size_t count;
  size_t stride;
} broadside_boxes;

/** Two boxes by their places in their array, first < second; of two sets, a place in the left one and one in
 * the right one. */
typedef struct broadside_pair {
  uint32_t first;
  uint32_t second;
} broadside_pair;

/** The categories of a box and those it collides with: two boxes may pair if each one's mask has a bit of the
 * other one's category and not both are static. Boxes of one group other than 0 meet whatever their bits if it
 * is positive, and never if it is negative. */
typedef struct broadside_filter {
  uint64_t category;
  uint64_t mask;
  int32_t group;
  int32_t is_static;
} broadside_filter;

/** The filter of boxes that have none: { 1, all bits, 0, 0 }. */
BROADSIDE_API broadside_filter broadside_standard_filter(void);

/** The threads of an engine's own. `run` calls task(state, i) once for each i < count, in any threads, and
 * returns when all of these calls have returned. */
typedef struct broadside_executor {
  size_t (*threads)(void* user); /**< how many tasks run at the same time, at least 1 */
  void (*run)(void* user, size_t count, void (*task)(void* state, size_t i), void* state);
  void* user;
} broadside_executor;

/* ---- All pairs ---- */

/** How pairs are found. Begin with broadside_find_options_init(), which sets what stands for the standard. */
typedef struct broadside_find_options {
  size_t size;           /**< of this struct */
  const char* algorithm; /**< the spec, such as "grid:cell=2.5" or "auto:threads=4"; null: "auto" */
  const broadside_filter* filters;       /**< one for each box (of the left set), or null */
  const broadside_filter* right_filters; /**< of two sets: one for each box of the right one, or null */
  const broadside_pair* ignored;         /**< pairs that never count, in any order; of one set only */
  size_t ignored_count;
  const broadside_executor* executor; /**< runs searches if the spec allows several threads; null: the library's */
  int quarantines; /**< 1: invalid boxes pair with nothing, instead of being refused */
} broadside_find_options;

BROADSIDE_API void broadside_find_options_init(broadside_find_options* options);

/** Takes a chunk of pairs, valid during the call; returns 0 for more, or another number to stop. */
typedef int (*broadside_pairs_callback)(void* user, const broadside_pair* pairs, size_t count);

/** Sets `count` to the number of overlapping pairs of `boxes`, or between `boxes` and `right` if that is not
 * null. `options` may be null. */
BROADSIDE_API broadside_status broadside_count_pairs(const broadside_boxes* boxes, const broadside_boxes* right,
                                                     const broadside_find_options* options, uint64_t* count,
                                                     broadside_error* error);

/** Writes the pairs to `pairs`, which has room for `room` of them, in an order that the spec and the boxes
 * fix, and sets `count` to how many there are. If these are more than `room`, the first `room` are there, and
 * the status is BROADSIDE_TOO_SMALL. */
BROADSIDE_API broadside_status broadside_find_pairs(const broadside_boxes* boxes, const broadside_boxes* right,
                                                    const broadside_find_options* options, broadside_pair* pairs,
                                                    size_t room, uint64_t* count, broadside_error* error);

/** Hands the pairs to `callback`, chunk by chunk, in this thread. If it stops the search, the status is
 * BROADSIDE_STOPPED. */
BROADSIDE_API broadside_status broadside_for_each_pairs(const broadside_boxes* boxes,
                                                        const broadside_boxes* right,
                                                        const broadside_find_options* options,
                                                        broadside_pairs_callback callback, void* user,
                                                        broadside_error* error);

/** Finds pairs again and again, and keeps its memory from call to call. */
typedef struct broadside_finder broadside_finder;

/** Makes a finder for boxes of a kind. Of `options`, which may be null, only `algorithm`, `executor` and
 * `quarantines` count here; the executor must live as long as the finder. */
BROADSIDE_API broadside_status broadside_finder_create(int api_version, broadside_kind kind,
                                                       const broadside_find_options* options,
                                                       broadside_finder** finder, broadside_error* error);
BROADSIDE_API void broadside_finder_destroy(broadside_finder* finder);

/** Sets `pairs` and `count` to the pairs, which belong to the finder and stay until its next call. Of
 * `options`, which may be null, only filters and ignored pairs count here. */
BROADSIDE_API broadside_status broadside_finder_find(broadside_finder* finder, const broadside_boxes* boxes,
                                                     const broadside_boxes* right,
                                                     const broadside_find_options* options,
                                                     const broadside_pair** pairs, size_t* count,
                                                     broadside_error* error);

/** The places of the last call's invalid boxes, where the finder quarantines them. */
BROADSIDE_EXPERIMENTAL const uint32_t* broadside_finder_quarantined(const broadside_finder* finder, size_t* count);

/* ---- Arrays of boxes in motion ---- */

/** Follows an array of boxes from frame to frame and tells which pairs begin and which end. */
typedef struct broadside_tracker broadside_tracker;

/** Events of one frame, each list sorted; they belong to the tracker and stay until its next update. */
typedef struct broadside_pair_events {
  const broadside_pair* begun;
  size_t begun_count;
  const broadside_pair* ended;
  size_t ended_count;
} broadside_pair_events;

/** As broadside_finder_create(). */
BROADSIDE_API broadside_status broadside_tracker_create(int api_version, broadside_kind kind,
                                                        const broadside_find_options* options,
                                                        broadside_tracker** tracker, broadside_error* error);
BROADSIDE_API void broadside_tracker_destroy(broadside_tracker* tracker);

/** Takes the boxes of the next frame. A box with min = +infinity and max = -infinity everywhere is absent:
 * there is none at its place. `changed` lists the places whose boxes or filters may differ from the frame
 * before; null: all of them. A change that is not listed is not seen. `filters` is null, or one for each box.
 * In a tracker's first frame everything has changed. */
BROADSIDE_API broadside_status broadside_tracker_update(broadside_tracker* tracker, const broadside_boxes* boxes,
                                                        const uint32_t* changed, size_t changed_count,
                                                        const broadside_filter* filters,
                                                        broadside_pair_events* events, broadside_error* error);

/* ---- Worlds ---- */

/** Boxes that come, move and go under handles, and the pairs that begin and end. */
typedef struct broadside_world broadside_world;

/** Names a box of a world for as long as it is there; no handle ever names a second one. */
typedef struct broadside_handle {
  uint32_t slot;
  uint32_t generation;
} broadside_handle;

/** Two boxes of a world, first.slot < second.slot; of two worlds, one of each. */
typedef struct broadside_handle_pair {
  broadside_handle first;
  broadside_handle second;
} broadside_handle_pair;

/** How a world works; see WorldOptions in world.hpp. Begin with broadside_world_options_init(). */
typedef struct broadside_world_options {
  size_t size;           /**< of this struct */
  const char* algorithm; /**< as in broadside_find_options */
  double margin;         /**< by which boxes are enlarged on every side, in the coordinates' unit */
  double relative_margin;  /**< or by their longest side times this; the lesser where both are given */
  double predicted_frames; /**< for how many frames ahead, where velocities are given */
  int reports_enlarged;    /**< 1: events are those of the enlarged boxes */
  int forgets_pairs;       /**< 1: current pairs are not kept, which saves 16 bytes a pair */
  int quarantines;         /**< 1: invalid boxes pair with nothing, instead of being refused */
  uint32_t first_generation; /**< of handles: worlds that begin far apart refuse each other's */
  const broadside_executor* executor; /**< as in broadside_find_options; must live as long as the world */
} broadside_world_options;

BROADSIDE_API void broadside_world_options_init(broadside_world_options* options);

/** `options` may be null. */
BROADSIDE_API broadside_status broadside_world_create(int api_version, broadside_kind kind,
                                                      const broadside_world_options* options,
                                                      broadside_world** world, broadside_error* error);
BROADSIDE_API void broadside_world_destroy(broadside_world* world);

/** Adds boxes and sets `handles`, one for each. `filters` and `user_data` are one for each, or null. All are
 * added or none. */
BROADSIDE_API broadside_status broadside_world_add(broadside_world* world, const broadside_boxes* boxes,
                                                   const broadside_filter* filters, const uint64_t* user_data,
                                                   broadside_handle* handles, broadside_error* error);

/** Replaces the boxes of `handles`, one for each. `velocities` is null, or for each box how far it is expected
 * to go in a frame: two or three coordinates of the world's type. Of a handle given twice the last one
 * counts. */
BROADSIDE_API broadside_status broadside_world_move(broadside_world* world, const broadside_handle* handles,
                                                    const broadside_boxes* boxes, const void* velocities,
                                                    broadside_error* error);

BROADSIDE_API broadside_status broadside_world_remove(broadside_world* world, const broadside_handle* handles,
                                                      size_t count, broadside_error* error);

/** Events of one update, sorted by slots; they belong to the world and stay until its next update. */
typedef struct broadside_events {
  const broadside_handle_pair* begun;
  size_t begun_count;
  const broadside_handle_pair* ended;
  size_t ended_count;
} broadside_events;

/** Brings the pairs up to date. */
BROADSIDE_API broadside_status broadside_world_update(broadside_world* world, broadside_events* events,
                                                      broadside_error* error);

/** The pairs that hold since the last update, sorted by slots; they stay until the next one, or until this is
 * called again. */
BROADSIDE_API broadside_status broadside_world_pairs(broadside_world* world,
                                                     const broadside_handle_pair** pairs, size_t* count,
                                                     broadside_error* error);

BROADSIDE_API size_t broadside_world_size(const broadside_world* world);
BROADSIDE_API int broadside_world_contains(const broadside_world* world, broadside_handle handle);

/** Copies the box to `box`, which has room for one of the world's kind. A removed one can be read until the
 * update after the one that reported its removal; likewise its filter and user data. */
BROADSIDE_API broadside_status broadside_world_box(const broadside_world* world, broadside_handle handle,
                                                   void* box, broadside_error* error);
BROADSIDE_API broadside_status broadside_world_filter(const broadside_world* world, broadside_handle handle,
                                                      broadside_filter* filter, broadside_error* error);
BROADSIDE_API broadside_status broadside_world_user_data(const broadside_world* world, broadside_handle handle,
                                                         uint64_t* user_data, broadside_error* error);
BROADSIDE_API broadside_status broadside_world_set_filter(broadside_world* world, broadside_handle handle,
                                                          const broadside_filter* filter,
                                                          broadside_error* error);
BROADSIDE_API broadside_status broadside_world_set_user_data(broadside_world* world, broadside_handle handle,
                                                             uint64_t user_data, broadside_error* error);

/** Lets two boxes never count as a pair (`ignores` 1), as those that a joint connects, or lets them again
 * (0). */
BROADSIDE_API broadside_status broadside_world_ignore(broadside_world* world, broadside_handle a,
                                                      broadside_handle b, int ignores, broadside_error* error);

/** Says whether two boxes that overlap and whose filters accept each other are to count: 1 or 0. It may read
 * the world that asks. */
typedef int (*broadside_predicate)(void* user, broadside_handle first, broadside_handle second);

/** Has each update ask `predicate` about each pair before it begins; null: all count. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_set_predicate(broadside_world* world,
                                                             broadside_predicate predicate, void* user,
                                                             broadside_error* error);

/** Puts the pairs of a box of `world` and an overlapping one of `other` into `pairs`, as
 * broadside_find_pairs() does. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_join(const broadside_world* world, const broadside_world* other,
                                                    broadside_handle_pair* pairs, size_t room, size_t* count,
                                                    broadside_error* error);

/** Writes a snapshot of the world to `bytes`, if there is room for it, and sets `size` to its bytes; else the
 * status is BROADSIDE_TOO_SMALL. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_snapshot(const broadside_world* world, void* bytes, size_t room,
                                                        size_t* size, broadside_error* error);

/** Makes the world what it was when the snapshot was taken, of this world or of another one. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_restore(broadside_world* world, const void* bytes, size_t size,
                                                       broadside_error* error);

/* ---- Queries ---- */

/** Which boxes a query may find. */
typedef struct broadside_query {
  const broadside_filter* filter; /**< only boxes whose filter accepts this one; null: all */
  const broadside_handle* except; /**< a world's box that is not found; null: none */
  const uint32_t* except_place;   /**< an index's box that is not found; null: none */
} broadside_query;

/** A box that a ray or a moved box meets, and the parameter at which it does so first: the ray stands at origin
 * + t * direction. */
typedef struct broadside_hit {
  broadside_handle handle; /**< of an index: { place, 0 } */
  double t_enter;
} broadside_hit;

/** A box and the square of its distance from a point. */
typedef struct broadside_neighbour {
  broadside_handle handle; /**< of an index: { place, 0 } */
  double distance_squared;
} broadside_neighbour;

/* Boxes, points and directions asked about are coordinates of the world's type: minima and then maxima, or
 * one after the other. `query` may be null. A function that writes to a buffer sets `count` to how many there
 * are; if these are more than `room`, the first `room` are there, and the status is BROADSIDE_TOO_SMALL.
 * The order of what is found means nothing. A point is a box whose minima are its maxima; a ray is such a box
 * in motion. */

BROADSIDE_API broadside_status broadside_world_overlapping(const broadside_world* world, const void* box,
                                                           const broadside_query* query,
                                                           broadside_handle* handles, size_t room,
                                                           size_t* count, broadside_error* error);

/** All boxes that `box` meets where it is moved along `direction`, up to the parameter `t_max`. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_hits(const broadside_world* world, const void* box,
                                                    const void* direction, double t_max,
                                                    const broadside_query* query, broadside_hit* hits,
                                                    size_t room, size_t* count, broadside_error* error);

/** The one that it meets first, if any: `found` is set to 1 or 0. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_first_hit(const broadside_world* world, const void* box,
                                                         const void* direction, double t_max,
                                                         const broadside_query* query, broadside_hit* hit,
                                                         int* found, broadside_error* error);

/** The `room` boxes nearest to `point`, or all if there are fewer, the nearest first. */
BROADSIDE_API broadside_status broadside_world_nearest(const broadside_world* world, const void* point,
                                                       const broadside_query* query,
                                                       broadside_neighbour* neighbours, size_t room,
                                                       size_t* count, broadside_error* error);

/** As broadside_world_nearest(), but only boxes with distance_squared <= max_distance * max_distance.
 * `max_distance` is at least 0 and may be infinite. It and the product are rounded to the world's type. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_nearest_within(const broadside_world* world, const void* point,
                                                              double max_distance,
                                                              const broadside_query* query,
                                                              broadside_neighbour* neighbours, size_t room,
                                                              size_t* count, broadside_error* error);

/** An index over an array of boxes, for queries alone. */
typedef struct broadside_index broadside_index;

BROADSIDE_API broadside_status broadside_index_create(int api_version, broadside_kind kind,
                                                      broadside_index** index, broadside_error* error);
BROADSIDE_API void broadside_index_destroy(broadside_index* index);

/** Takes the boxes, as broadside_tracker_update() does. */
BROADSIDE_API broadside_status broadside_index_update(broadside_index* index, const broadside_boxes* boxes,
                                                      const uint32_t* changed, size_t changed_count,
                                                      const broadside_filter* filters, broadside_error* error);

/** As those of worlds; a box is named by its place. */
BROADSIDE_API broadside_status broadside_index_overlapping(const broadside_index* index, const void* box,
                                                           const broadside_query* query, uint32_t* places,
                                                           size_t room, size_t* count, broadside_error* error);
BROADSIDE_EXPERIMENTAL broadside_status broadside_index_hits(const broadside_index* index, const void* box,
                                                    const void* direction, double t_max,
                                                    const broadside_query* query, broadside_hit* hits,
                                                    size_t room, size_t* count, broadside_error* error);
BROADSIDE_EXPERIMENTAL broadside_status broadside_index_first_hit(const broadside_index* index, const void* box,
                                                         const void* direction, double t_max,
                                                         const broadside_query* query, broadside_hit* hit,
                                                         int* found, broadside_error* error);
BROADSIDE_API broadside_status broadside_index_nearest(const broadside_index* index, const void* point,
                                                       const broadside_query* query,
                                                       broadside_neighbour* neighbours, size_t room,
                                                       size_t* count, broadside_error* error);
BROADSIDE_EXPERIMENTAL broadside_status broadside_index_nearest_within(const broadside_index* index, const void* point,
                                                              double max_distance,
                                                              const broadside_query* query,
                                                              broadside_neighbour* neighbours, size_t room,
                                                              size_t* count, broadside_error* error);

#ifdef __cplusplus
}
#endif

#endif
