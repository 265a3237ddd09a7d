/* Broadside for C: every overlapping pair of axis-aligned boxes, once or frame after frame, and queries.
 *
 * C99 and later, and C++. The functions are those of the C++ library, whose headers say more; docs/c.md shows
 * how to use them.
 *
 * Boxes are closed: boxes that touch overlap. A box is its minima and then its maxima, two or three of each,
 * floats or doubles: see broadside_kind. Results are exact in that type.
 *
 * Errors. A function that can fail returns a broadside_status, and takes a broadside_error as its last
 * argument. Unless that is null, a call that fails writes to it what went wrong; a call that succeeds leaves
 * it as it was. A call that fails changes nothing, unless its comment says otherwise. No exception leaves the
 * library, and no function exits the program.
 *
 * Memory. The caller owns what a `create` function makes, and passes it to the `destroy` function of the same
 * kind. Arrays that a function returns belong to the object they came from; each function says how long they
 * stay valid. The library keeps no pointer to the caller's arrays after a call.
 *
 * Threads. There is no global state. Different threads may use different objects at the same time. One object
 * may be used by one thread at a time, except that several threads may call functions that take it as `const`
 * while none changes it. A callback runs in the thread of the call that it was passed to. It must not use the
 * object that calls it unless its comment allows it, and it must return: to longjmp() out of it, or to throw
 * a C++ exception through it, is undefined. A caller that needs this takes pairs into a buffer instead.
 *
 * Functions marked BROADSIDE_API change only with another BROADSIDE_C_API_VERSION; functions marked
 * BROADSIDE_EXPERIMENTAL may change with any version of the library.
 */
#ifndef BROADSIDE_H
#define BROADSIDE_H

#include <stddef.h>
#include <stdint.h>

#define BROADSIDE_C_API_VERSION 2

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

/** The result of a call: one of these numbers. */
typedef int32_t broadside_status;
enum {
  BROADSIDE_OK = 0,
  BROADSIDE_INVALID_INPUT = 1,     /**< a box with a NaN or min > max; broadside_error says which */
  BROADSIDE_INVALID_FRAME = 2,     /**< arrays that do not fit together */
  BROADSIDE_INVALID_QUERY = 3,     /**< a query with a NaN, or with an infinity where none is allowed */
  BROADSIDE_INVALID_SPEC = 4,      /**< an unknown algorithm, or a value out of its range */
  BROADSIDE_INVALID_HANDLE = 5,    /**< a handle that names no box of this world */
  BROADSIDE_INVALID_SNAPSHOT = 6,  /**< bytes that are not a snapshot of a world like this */
  BROADSIDE_INVALID_ARGUMENT = 7,  /**< another invalid argument, such as a null pointer */
  BROADSIDE_TOO_SMALL = 8,         /**< a buffer has too little room; nothing is lost, call again */
  BROADSIDE_STOPPED = 9,           /**< a callback asked to stop */
  BROADSIDE_OUT_OF_MEMORY = 10,
  BROADSIDE_FAILED = 11            /**< anything else; the message says what */
};

/** What went wrong: thing, value found, value expected. */
typedef struct broadside_error {
  broadside_status status;
  uint64_t index;     /**< for BROADSIDE_INVALID_INPUT: the place of the first invalid box in its array */
  char message[1000]; /**< UTF-8, ends with a 0; longer messages are cut off */
} broadside_error;

/** The name of a status, such as "invalid input"; "unknown status" for a number that is not a status. */
BROADSIDE_API const char* broadside_status_name(broadside_status status);

/** The library's version, such as "0.3.0". */
BROADSIDE_API const char* broadside_version(void);

/** The library's version of this interface. A program compiled with the header of another version gets
 * BROADSIDE_INVALID_ARGUMENT from every function that creates an object. */
BROADSIDE_API int broadside_c_api_version(void);

/** The name of the library's algorithm of this number, counted from 0; null beyond the last one. */
BROADSIDE_API const char* broadside_algorithm_name(size_t number);

/* ---- Boxes, pairs, filters ---- */

/** The dimension of boxes and the type of their coordinates: one of these numbers. */
typedef int32_t broadside_kind;
enum {
  BROADSIDE_FLOAT_2D = 0,  /**< float min_x, min_y, max_x, max_y */
  BROADSIDE_FLOAT_3D = 1,  /**< float min_x, min_y, min_z, max_x, max_y, max_z */
  BROADSIDE_DOUBLE_2D = 2, /**< likewise, of doubles */
  BROADSIDE_DOUBLE_3D = 3
};

/** `count` boxes in the caller's memory, aligned or not. The first begins at `first`, each further one
 * `stride` bytes after the one before. A stride of 0 stands for contiguous boxes. */
typedef struct broadside_boxes {
  broadside_kind kind;
  const void* first; /**< may be null if `count` is 0 */
  size_t count;
  size_t stride;
} broadside_boxes;

/** Makes boxes of `count` closed intervals, from minima[i] to maxima[i], for all functions that take boxes. Writes
 * them to `rows`, which has room for 4 * count doubles: boxes of BROADSIDE_DOUBLE_2D whose y is 0. An interval from
 * +infinity to -infinity is absent. Half-open intervals need `leaves_out_touching`. */
BROADSIDE_EXPERIMENTAL broadside_boxes broadside_intervals(const double* minima, const double* maxima,
                                                           size_t count, double* rows);

/** Two boxes by their places in the array, first < second; between two sets, a place in the left one and a
 * place in the right one. */
typedef struct broadside_pair {
  uint32_t first;
  uint32_t second;
} broadside_pair;

/** The categories of a box and the categories it collides with. Two boxes may pair if they are not both
 * static and the mask of each has a bit of the other's category. If both have the same group other than 0, it
 * decides instead of the bits: they pair if it is positive, and never if it is negative. */
typedef struct broadside_filter {
  uint64_t category;
  uint64_t mask;
  int32_t group;
  int32_t is_static;
} broadside_filter;

/** The filter of a box without one: { 1, all bits, 0, 0 }. */
BROADSIDE_API broadside_filter broadside_standard_filter(void);

/** An engine's own threads. `run` calls task(state, i) once for each i < count, in any threads, and returns
 * when all these calls have returned. */
typedef struct broadside_executor {
  size_t (*threads)(void* user); /**< how many tasks run at the same time, at least 1 */
  void (*run)(void* user, size_t count, void (*task)(void* state, size_t i), void* state);
  void* user;
} broadside_executor;

/* ---- All pairs ---- */

/** The options of a search. Begin with broadside_find_options_init(), which sets the defaults. */
typedef struct broadside_find_options {
  size_t size;           /**< of this struct */
  const char* algorithm; /**< the spec, such as "grid:cell=2.5" or "auto:threads=4"; null: "auto" */
  const broadside_filter* filters;       /**< one for each box (of the left set), or null */
  const broadside_filter* right_filters; /**< for two sets: one for each box of the right one, or null */
  const broadside_pair* ignored;         /**< pairs that never count, in any order; for one set only */
  size_t ignored_count;
  const broadside_executor* executor; /**< runs searches if the spec allows several threads; null: the library's */
  int quarantines; /**< 1: invalid boxes pair with nothing, instead of being refused */
  int leaves_out_touching; /**< 1: boxes that only touch do not overlap: see half_open() in box.hpp */

  /** If not 0, two boxes pair if their Euclidean distance is at most this, or if `radii` is not null, at most
   * the sum of their radii: see within.hpp. Numbers are finite and at least 0. For searches alone: finders,
   * trackers and batches refuse them. */
  double distance;
  const double* radii;       /**< one for each box (of the left set), or null; `distance` is then 0 */
  const double* right_radii; /**< for two sets with radii: one for each box of the right one */

  /** If not null, space repeats: one length for each axis, infinity for an axis that does not repeat. Boxes then
   * pair around the edge if they overlap, or within the distance: see Reach::periodic() in within.hpp. For the
   * same calls as `distance`. */
  const double* periods;

  /** If not null, boxes move through a step: these are the same boxes at its end. Two pair if they overlap at some
   * time of the step: see moving.hpp. For the same calls as `distance`, which is then 0. */
  const broadside_boxes* to;
  const broadside_boxes* right_to; /**< for two sets that move: the boxes of the right one at the end */
} broadside_find_options;

BROADSIDE_API void broadside_find_options_init(broadside_find_options* options);

/** Takes a chunk of pairs, valid during the call. Returns 0 to go on, or another number to stop. */
typedef int (*broadside_pairs_callback)(void* user, const broadside_pair* pairs, size_t count);

/** Sets `count` to the number of overlapping pairs of `boxes` or, if `right` is not null, between `boxes` and
 * `right`. `options` may be null. */
BROADSIDE_API broadside_status broadside_count_pairs(const broadside_boxes* boxes, const broadside_boxes* right,
                                                     const broadside_find_options* options, uint64_t* count,
                                                     broadside_error* error);

/** Writes the pairs to `pairs`, which has room for `room` of them, and sets `count` to how many there are. If
 * there are more than `room`, the first `room` are written, and the status is BROADSIDE_TOO_SMALL. The order
 * depends only on the spec and the boxes. */
BROADSIDE_API broadside_status broadside_find_pairs(const broadside_boxes* boxes, const broadside_boxes* right,
                                                    const broadside_find_options* options, broadside_pair* pairs,
                                                    size_t room, uint64_t* count, broadside_error* error);

/** Passes the pairs to `callback`, chunk by chunk, in this thread. If it stops the search, the status is
 * BROADSIDE_STOPPED. */
BROADSIDE_API broadside_status broadside_for_each_pairs(const broadside_boxes* boxes,
                                                        const broadside_boxes* right,
                                                        const broadside_find_options* options,
                                                        broadside_pairs_callback callback, void* user,
                                                        broadside_error* error);

/** Finds the pairs of many worlds in one call: world i has the boxes from offsets[i] up to offsets[i + 1], and
 * its pairs count from its first box, as a call of broadside_find_pairs() for each world gives them. There are
 * `worlds` + 1 offsets, none less than the one before, from 0 to the number of boxes. Writes to
 * `pair_offsets`, with room for `worlds` + 1, where each world's pairs begin and, last, how many pairs there
 * are. Writes the pairs to `pairs`, which has room for `room` of them; if there are more, the first `room`, and
 * the status is BROADSIDE_TOO_SMALL. Each call searches, also one that only asks how many pairs there are.
 *
 * Of `options`, which may be null, filters are one for each of all boxes, and ignored pairs are left out in
 * every world. With several threads ("auto:threads=0" takes all), the threads share the worlds. The index of an
 * invalid box is its place in `boxes`. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_find_pairs_batch(
    const broadside_boxes* boxes, const size_t* offsets, size_t worlds, const broadside_find_options* options,
    broadside_pair* pairs, size_t room, size_t* pair_offsets, broadside_error* error);

/** Finds the connected components of the pairs without keeping these. Sets labels[i], one for each box, to the
 * least place of a box in the component of box i. A box without pairs has its own place. If the call fails,
 * `labels` are as they were. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_components(const broadside_boxes* boxes,
                                                             const broadside_find_options* options,
                                                             uint32_t* labels, broadside_error* error);

/** Sets distances[i] to the Euclidean distance of the boxes of pairs[i]: the first one of `boxes`, the second
 * one of `right` or, if that is null, of `boxes`. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_distances(const broadside_boxes* boxes,
                                                            const broadside_boxes* right,
                                                            const broadside_pair* pairs, size_t count,
                                                            double* distances, broadside_error* error);

/** The times between which two boxes overlap in a step from 0 to 1. */
typedef struct broadside_overlap_time {
  double enter;
  double leave;
} broadside_overlap_time;

/** Sets times[i] to when the boxes of pairs[i] overlap, while they move from `boxes` to `to`: the second one, if
 * `right` is not null, from `right` to `right_to`. Infinity and -infinity for two that never overlap. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_overlap_times(const broadside_boxes* boxes, const broadside_boxes* to,
                                                                const broadside_boxes* right,
                                                                const broadside_boxes* right_to,
                                                                const broadside_pair* pairs, size_t count,
                                                                broadside_overlap_time* times,
                                                                broadside_error* error);

/** Makes neighbour lists of `count` pairs in any order. The neighbours of box i, ascending, are
 * neighbours[offsets[i]] up to neighbours[offsets[i + 1]]; there are `boxes` + 1 offsets. If `is_full` is 0, the
 * first box of a pair has the second as a neighbour, and `neighbours` has room for `count`. Otherwise each box has
 * the other, and `neighbours` has room for 2 * count. For pairs of two sets, `is_full` is 0 and `boxes` the size of
 * the left set. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_neighbours(const broadside_pair* pairs, size_t count,
                                                             size_t boxes, int is_full, size_t* offsets,
                                                             uint32_t* neighbours, broadside_error* error);

/** Finds pairs repeatedly, and keeps its memory from call to call. */
typedef struct broadside_finder broadside_finder;

/** Makes a finder for boxes of a kind. Of `options`, which may be null, only `algorithm`, `executor`,
 * `quarantines` and `leaves_out_touching` count here; the executor must live as long as the finder. */
BROADSIDE_API broadside_status broadside_finder_create(int api_version, broadside_kind kind,
                                                       const broadside_find_options* options,
                                                       broadside_finder** finder, broadside_error* error);
BROADSIDE_API void broadside_finder_destroy(broadside_finder* finder);

/** Sets `pairs` and `count` to the pairs, which belong to the finder and stay valid until its next call. Of
 * `options`, which may be null, only filters and ignored pairs count here. */
BROADSIDE_API broadside_status broadside_finder_find(broadside_finder* finder, const broadside_boxes* boxes,
                                                     const broadside_boxes* right,
                                                     const broadside_find_options* options,
                                                     const broadside_pair** pairs, size_t* count,
                                                     broadside_error* error);

/** The places of the last call's invalid boxes, if the finder quarantines them. */
BROADSIDE_EXPERIMENTAL const uint32_t* broadside_finder_quarantined(const broadside_finder* finder, size_t* count);

/* ---- Arrays of boxes in motion ---- */

/** Follows an array of boxes from frame to frame and tells which pairs begin and which end. */
typedef struct broadside_tracker broadside_tracker;

/** Events of a frame, each list sorted. They belong to the tracker and stay valid until its next update. */
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

/** Takes the boxes of the next frame. A box with min = +infinity and max = -infinity on every axis is absent:
 * there is no box at its place. `changed` lists the places where boxes or filters may differ from the frame
 * before; null stands for all. A change that is not listed is not seen. `filters` is null or has one for each
 * box. In a tracker's first frame, everything has changed. */
BROADSIDE_API broadside_status broadside_tracker_update(broadside_tracker* tracker, const broadside_boxes* boxes,
                                                        const uint32_t* changed, size_t changed_count,
                                                        const broadside_filter* filters,
                                                        broadside_pair_events* events, broadside_error* error);

/** Follows the boxes of many small worlds from frame to frame, in one call for all. */
typedef struct broadside_batch_tracker broadside_batch_tracker;

/** The events of every world: world i has the pairs from begun_offsets[i] up to begun_offsets[i + 1], which count
 * from its first box; likewise those that ended. They belong to the tracker and stay valid until its next update. */
typedef struct broadside_batch_events {
  const broadside_pair* begun;
  const size_t* begun_offsets;
  const broadside_pair* ended;
  const size_t* ended_offsets;
} broadside_batch_events;

/** Makes a tracker for worlds with boxes of a kind. Of `options`, which may be null, only `algorithm`, `executor`
 * and `leaves_out_touching` count here, and `quarantines` must be 0; the executor must live as long as the tracker. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_batch_tracker_create(int api_version, broadside_kind kind,
                                                                       const broadside_find_options* options,
                                                                       broadside_batch_tracker** tracker,
                                                                       broadside_error* error);
BROADSIDE_EXPERIMENTAL void broadside_batch_tracker_destroy(broadside_batch_tracker* tracker);

/** Takes the boxes of the next frame; `boxes`, `offsets` and `worlds` are those of broadside_find_pairs_batch().
 * `filters` is null or has one for each box. Each world must have as many boxes as in the update before; absent ones
 * take the places of bodies that are missing. In the first frame all pairs begin. A call that fails has taken
 * nothing. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_batch_tracker_update(
    broadside_batch_tracker* tracker, const broadside_boxes* boxes, const size_t* offsets, size_t worlds,
    const broadside_filter* filters, broadside_batch_events* events, broadside_error* error);

/* ---- Owners ---- */

/** Tells which pairs of owners touch, such as bodies made of several boxes, from the pairs of boxes that begin
 * and end: two owners touch while at least one box of each touches a box of the other. */
typedef struct broadside_owner_pairs broadside_owner_pairs;

/** Two owners, numbers of yours; in events, first < second. */
typedef struct broadside_owner_pair {
  uint64_t first;
  uint64_t second;
} broadside_owner_pair;

/** The pairs of owners that began and ended, each once and sorted. They stay valid until the next update. */
typedef struct broadside_owner_events {
  const broadside_owner_pair* begun;
  size_t begun_count;
  const broadside_owner_pair* ended;
  size_t ended_count;
} broadside_owner_events;

BROADSIDE_EXPERIMENTAL broadside_status broadside_owner_pairs_create(int api_version,
                                                                     broadside_owner_pairs** owner_pairs,
                                                                     broadside_error* error);
BROADSIDE_EXPERIMENTAL void broadside_owner_pairs_destroy(broadside_owner_pairs* owner_pairs);

/** Takes the owners of the boxes of the pairs that began and ended since the last update, in any order. Two
 * boxes of one owner are no pair. If a pair of owners would end more often than it began, the status is
 * BROADSIDE_INVALID_FRAME. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_owner_pairs_update(
    broadside_owner_pairs* owner_pairs, const broadside_owner_pair* begun, size_t begun_count,
    const broadside_owner_pair* ended, size_t ended_count, broadside_owner_events* events,
    broadside_error* error);

/* ---- Worlds ---- */

/** Boxes that come, move and go under handles, and the pairs that begin and end. */
typedef struct broadside_world broadside_world;

/** Names a box of a world for as long as it is there; no handle ever names a second one. */
typedef struct broadside_handle {
  uint32_t slot;
  uint32_t generation;
} broadside_handle;

/** Two boxes of a world, first.slot < second.slot; between two worlds, one of each. */
typedef struct broadside_handle_pair {
  broadside_handle first;
  broadside_handle second;
} broadside_handle_pair;

/** The options of a world; see WorldOptions in world.hpp. Begin with broadside_world_options_init(). */
typedef struct broadside_world_options {
  size_t size;           /**< of this struct */
  const char* algorithm; /**< as in broadside_find_options */
  double margin;         /**< enlarges boxes by this on every side, in the coordinates' unit */
  double relative_margin;  /**< likewise, by this times their longest side; if both are given, the smaller counts */
  double predicted_frames; /**< enlarges boxes for this many frames ahead, if velocities are given */
  int reports_enlarged;    /**< 1: events are those of the enlarged boxes */
  int forgets_pairs;       /**< 1: current pairs are not kept, which saves 16 bytes per pair */
  int quarantines;         /**< 1: invalid boxes pair with nothing, instead of being refused */
  uint32_t first_generation; /**< of handles; worlds that begin far apart refuse each other's handles */
  const broadside_executor* executor; /**< as in broadside_find_options; must live as long as the world */
  const char* settings; /**< options by their names in world_tunables() of world.hpp, such as
                             "world:shadow=yes:max_boxes=1000", or null; a field above that is not 0 counts instead */
} broadside_world_options;

BROADSIDE_API void broadside_world_options_init(broadside_world_options* options);

/** `options` may be null. */
BROADSIDE_API broadside_status broadside_world_create(int api_version, broadside_kind kind,
                                                      const broadside_world_options* options,
                                                      broadside_world** world, broadside_error* error);
BROADSIDE_API void broadside_world_destroy(broadside_world* world);

/** Adds boxes and sets `handles`, one for each. `filters` and `user_data` have one for each, or are null.
 * Adds all boxes or none. */
BROADSIDE_API broadside_status broadside_world_add(broadside_world* world, const broadside_boxes* boxes,
                                                   const broadside_filter* filters, const uint64_t* user_data,
                                                   broadside_handle* handles, broadside_error* error);

/** Replaces the boxes of `handles`, one for each. `velocities` is null, or has each box's expected motion per
 * frame: two or three coordinates of the world's type. If a handle is given twice, its last box counts. */
BROADSIDE_API broadside_status broadside_world_move(broadside_world* world, const broadside_handle* handles,
                                                    const broadside_boxes* boxes, const void* velocities,
                                                    broadside_error* error);

BROADSIDE_API broadside_status broadside_world_remove(broadside_world* world, const broadside_handle* handles,
                                                      size_t count, broadside_error* error);

/** Events of an update, sorted by slots. They belong to the world and stay valid until its next update. */
typedef struct broadside_events {
  const broadside_handle_pair* begun;
  size_t begun_count;
  const broadside_handle_pair* ended;
  size_t ended_count;
} broadside_events;

/** Brings the pairs up to date. */
BROADSIDE_API broadside_status broadside_world_update(broadside_world* world, broadside_events* events,
                                                      broadside_error* error);

/** The pairs that held at the last update, sorted by slots. They stay valid until the next update or the next
 * call of this function. */
BROADSIDE_API broadside_status broadside_world_pairs(broadside_world* world,
                                                     const broadside_handle_pair** pairs, size_t* count,
                                                     broadside_error* error);

BROADSIDE_API size_t broadside_world_size(const broadside_world* world);
BROADSIDE_API int broadside_world_contains(const broadside_world* world, broadside_handle handle);

/** Copies the box to `box`, which has room for one of the world's kind. A removed box, its filter and its
 * user data can be read until the update after the one that reported the removal. */
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

/** Makes two boxes never count as a pair (`ignores` is 1), such as bodies that a joint connects, or count
 * again (0). */
BROADSIDE_API broadside_status broadside_world_ignore(broadside_world* world, broadside_handle a,
                                                      broadside_handle b, int ignores, broadside_error* error);

/** Returns 1 if two boxes that overlap and pass their filters count as a pair, or 0. It may read the world
 * that calls it. */
typedef int (*broadside_predicate)(void* user, broadside_handle first, broadside_handle second);

/** Makes each update ask `predicate` about each pair before it begins. Null: all pairs count. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_set_predicate(broadside_world* world,
                                                             broadside_predicate predicate, void* user,
                                                             broadside_error* error);

/** Writes to `pairs`, as broadside_find_pairs() does, each pair of a box of `world` and an overlapping box of
 * `other`. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_join(const broadside_world* world, const broadside_world* other,
                                                    broadside_handle_pair* pairs, size_t room, size_t* count,
                                                    broadside_error* error);

/** Sets `size` to the bytes of a snapshot of the world. Writes it to `bytes` if there is room for it;
 * otherwise the status is BROADSIDE_TOO_SMALL. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_snapshot(const broadside_world* world, void* bytes, size_t room,
                                                        size_t* size, broadside_error* error);

/** Brings the world to the state of a snapshot of this or of another world. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_restore(broadside_world* world, const void* bytes, size_t size,
                                                       broadside_error* error);

/* ---- Queries ---- */

/** Which boxes a query may find. */
typedef struct broadside_query {
  const broadside_filter* filter; /**< only boxes whose filter accepts this one; null: all */
  const broadside_handle* except; /**< a world's box to leave out; null: none */
  const uint32_t* except_place;   /**< an index's box to leave out; null: none */
} broadside_query;

/** A box that a ray or a moving box hits, and the least t at which it does: the ray is at
 * origin + t * direction. */
typedef struct broadside_hit {
  broadside_handle handle; /**< in an index: { place, 0 } */
  double t_enter;
} broadside_hit;

/** A box and the square of its distance from a point or a box. */
typedef struct broadside_neighbour {
  broadside_handle handle; /**< in an index: { place, 0 } */
  double distance_squared;
} broadside_neighbour;

/* Boxes, points and directions are coordinates of the world's type: a box has minima and then maxima. `query`
 * may be null. A function that writes to a buffer sets `count` to how many it found. If there are more than
 * `room`, the first `room` are written, and the status is BROADSIDE_TOO_SMALL. The order of results means
 * nothing. A point is a box with equal minima and maxima; a ray is such a box in motion. */

BROADSIDE_API broadside_status broadside_world_overlapping(const broadside_world* world, const void* box,
                                                           const broadside_query* query,
                                                           broadside_handle* handles, size_t room,
                                                           size_t* count, broadside_error* error);

/** All boxes that `box` hits if it moves along `direction`, up to the parameter `t_max`. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_hits(const broadside_world* world, const void* box,
                                                    const void* direction, double t_max,
                                                    const broadside_query* query, broadside_hit* hits,
                                                    size_t room, size_t* count, broadside_error* error);

/** The box that it hits first. Sets `found` to 1, or to 0 if there is none. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_first_hit(const broadside_world* world, const void* box,
                                                         const void* direction, double t_max,
                                                         const broadside_query* query, broadside_hit* hit,
                                                         int* found, broadside_error* error);

/** As broadside_world_hits() and broadside_world_first_hit(), but only boxes that it enters: not those that it is in
 * or rests on at its start. See enters() in queries.hpp. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_entered(const broadside_world* world, const void* box,
                                                       const void* direction, double t_max,
                                                       const broadside_query* query, broadside_hit* hits,
                                                       size_t room, size_t* count, broadside_error* error);
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_first_entered(const broadside_world* world, const void* box,
                                                             const void* direction, double t_max,
                                                             const broadside_query* query, broadside_hit* hit,
                                                             int* found, broadside_error* error);

/** The `room` boxes nearest to `point`, or all if there are fewer, the nearest first. */
BROADSIDE_API broadside_status broadside_world_nearest(const broadside_world* world, const void* point,
                                                       const broadside_query* query,
                                                       broadside_neighbour* neighbours, size_t room,
                                                       size_t* count, broadside_error* error);

/** As broadside_world_nearest(), but only boxes with distance_squared <= max_distance * max_distance.
 * `max_distance` is at least 0 and may be infinite. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_nearest_within(const broadside_world* world, const void* point,
                                                              double max_distance,
                                                              const broadside_query* query,
                                                              broadside_neighbour* neighbours, size_t room,
                                                              size_t* count, broadside_error* error);

/** As broadside_world_nearest_within(), but nearest to a box. The distance of boxes that overlap is 0. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_world_nearest_to_box(const broadside_world* world, const void* box,
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

/** Like the queries of worlds; a box is named by its place. */
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
BROADSIDE_EXPERIMENTAL broadside_status broadside_index_entered(const broadside_index* index, const void* box,
                                                       const void* direction, double t_max,
                                                       const broadside_query* query, broadside_hit* hits,
                                                       size_t room, size_t* count, broadside_error* error);
BROADSIDE_EXPERIMENTAL broadside_status broadside_index_first_entered(const broadside_index* index, const void* box,
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
BROADSIDE_EXPERIMENTAL broadside_status broadside_index_nearest_to_box(const broadside_index* index, const void* box,
                                                              double max_distance,
                                                              const broadside_query* query,
                                                              broadside_neighbour* neighbours, size_t room,
                                                              size_t* count, broadside_error* error);

/* ---- The nearest boxes of many ---- */

/** Begin with broadside_nearest_options_init(), which sets the defaults. */
typedef struct broadside_nearest_options {
  size_t size;         /**< of this struct */
  double max_distance; /**< boxes that are farther away are not found; infinity */
  const broadside_filter* filters;       /**< one for each box (of the left set), or null */
  const broadside_filter* right_filters; /**< for two sets: one for each box of the right one, or null */
  size_t threads;                        /**< the most threads, 0: as many as there are; 1 */
  const broadside_executor* executor;    /**< if several threads are allowed; null: the library's */
} broadside_nearest_options;

BROADSIDE_API void broadside_nearest_options_init(broadside_nearest_options* options);

/** Finds for each box the `k` boxes of `right` that are nearest to it or, if that is null, of the same set,
 * without itself. Writes `k` places and squared distances for each box in turn, by distance and then by place.
 * A row with fewer boxes ends with places UINT32_MAX at infinite distances. `options` may be null. If the call
 * fails, the arrays are as they were. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_nearest_pairs(const broadside_boxes* boxes,
                                                       const broadside_boxes* right, size_t k,
                                                       const broadside_nearest_options* options,
                                                       uint32_t* places, double* distances_squared,
                                                       broadside_error* error);

/** The same for many boxes and an index. Boxes without min <= max are invalid queries. `except` is null, or has
 * for each box the place of one to leave out; UINT32_MAX stands for none. */
BROADSIDE_EXPERIMENTAL broadside_status broadside_index_nearest_of_each(const broadside_index* index,
                                                               const broadside_boxes* boxes, size_t k,
                                                               const broadside_nearest_options* options,
                                                               const uint32_t* except, uint32_t* places,
                                                               double* distances_squared,
                                                               broadside_error* error);

#ifdef __cplusplus
}
#endif

#endif
