/* The header as C99, and a world of each kind from begin to end. Prints what went wrong, if anything. */
#include <broadside.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

static void expect(int is_so, const char* what, const broadside_error* error) {
  if (is_so) return;
  fprintf(stderr, "%s: %s\n", what, error->message);
  ++failures;
}

static void try_floats(void) {
  /* Structs of the program's own, in which boxes stand. */
  struct body {
    int number;
    float box[4];
  } bodies[3] = {{0, {0, 0, 1, 1}}, {1, {1, 1, 2, 2}}, {2, {5, 5, 6, 6}}};
  broadside_error error = {BROADSIDE_OK, 0, ""};
  broadside_boxes boxes = {BROADSIDE_FLOAT_2D, bodies[0].box, 3, sizeof(struct body)};
  broadside_pair pairs[4];
  uint64_t count = 0;
  broadside_status status = broadside_find_pairs(&boxes, NULL, NULL, pairs, 4, &count, &error);
  expect(status == BROADSIDE_OK && count == 1 && pairs[0].first == 0 && pairs[0].second == 1, "find", &error);

  {
    /* Only boxes with the same key pair: the first two have different ones. */
    const broadside_filter filters[3] = {{0, 0, 1, 0}, {0, 0, 2, 0}, {0, 0, 1, 0}};
    uint32_t labels[3] = {9, 9, 9};
    broadside_find_options options;
    broadside_find_options_init(&options);
    status = broadside_components(&boxes, NULL, labels, &error);
    expect(status == BROADSIDE_OK && labels[0] == 0 && labels[1] == 0 && labels[2] == 2, "components", &error);
    options.filters = filters;
    status = broadside_components(&boxes, &options, labels, &error);
    expect(status == BROADSIDE_OK && labels[1] == 1, "components of keys", &error);
    status = broadside_components(&boxes, NULL, NULL, &error);
    expect(status == BROADSIDE_INVALID_ARGUMENT && strstr(error.message, "labels is null") != NULL,
           "components without labels", &error);
  }

  {
    /* Around the edge of a cell of 10 by 10. */
    const float around[2][4] = {{9, 0, 11, 1}, {0.5f, 0, 2, 1}};
    broadside_boxes two = {BROADSIDE_FLOAT_2D, NULL, 2, 0};
    double periods[2] = {10, 10};
    broadside_find_options options;
    two.first = around;
    broadside_find_options_init(&options);
    status = broadside_find_pairs(&two, NULL, &options, pairs, 4, &count, &error);
    expect(status == BROADSIDE_OK && count == 0, "without periods", &error);
    options.periods = periods;
    status = broadside_find_pairs(&two, NULL, &options, pairs, 4, &count, &error);
    expect(status == BROADSIDE_OK && count == 1, "with periods", &error);
    periods[1] = 0;
    status = broadside_find_pairs(&two, NULL, &options, pairs, 4, &count, &error);
    expect(status == BROADSIDE_INVALID_QUERY && strstr(error.message, "the period of axis 1 is 0") != NULL,
           "a period of 0", &error);
  }

  {
    /* Within a distance: the last two are 3 apart on both axes, which is 4.24. */
    const double radii[3] = {0, 2, 2.25};
    const double wrong[3] = {0, 2, -1};
    double distances[2] = {9, 9};
    size_t offsets[4] = {9, 9, 9, 9};
    uint32_t neighbours[4] = {9, 9, 9, 9};
    broadside_find_options options;
    broadside_finder* finder = NULL;
    broadside_find_options_init(&options);
    options.distance = 4.2;
    status = broadside_find_pairs(&boxes, NULL, &options, pairs, 4, &count, &error);
    expect(status == BROADSIDE_OK && count == 1, "within 4.2", &error);
    options.distance = 4.25;
    status = broadside_find_pairs(&boxes, &boxes, &options, pairs, 4, &count, &error);
    expect(status == BROADSIDE_TOO_SMALL && count == 7, "within 4.25 of two sets", &error);
    status = broadside_finder_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &finder, &error);
    expect(status == BROADSIDE_INVALID_ARGUMENT && strstr(error.message, "distance") != NULL, "finder", &error);
    options.radii = radii;
    status = broadside_count_pairs(&boxes, NULL, &options, &count, &error);
    expect(status == BROADSIDE_INVALID_ARGUMENT, "a distance and radii", &error);
    options.distance = 0;
    status = broadside_find_pairs(&boxes, NULL, &options, pairs, 4, &count, &error);
    expect(status == BROADSIDE_OK && count == 2, "radii", &error);
    status = broadside_distances(&boxes, NULL, pairs, 2, distances, &error);
    expect(status == BROADSIDE_OK && fabs(distances[0] + distances[1] - 3 * sqrt(2)) < 1e-9, "distances", &error);
    status = broadside_neighbours(pairs, 2, 3, 1, offsets, neighbours, &error);
    expect(status == BROADSIDE_OK && offsets[1] == 1 && offsets[2] == 3 && offsets[3] == 4 && neighbours[0] == 1 &&
               neighbours[1] == 0 && neighbours[2] == 2 && neighbours[3] == 1,
           "neighbours", &error);
    options.radii = wrong;
    status = broadside_count_pairs(&boxes, NULL, &options, &count, &error);
    expect(status == BROADSIDE_INVALID_QUERY && strstr(error.message, "box 2 is -1") != NULL, "a radius", &error);
    options.right_radii = radii;
    status = broadside_count_pairs(&boxes, NULL, &options, &count, &error);
    expect(status == BROADSIDE_INVALID_ARGUMENT, "right radii of one set", &error);
  }

  {
    /* In motion: box 1 leaves box 0 and meets box 2, which comes to touch box 0 at the end. */
    const float ends[3][4] = {{0, 0, 1, 1}, {9, 9, 10, 10}, {1, 1, 2, 2}};
    const broadside_boxes to = {BROADSIDE_FLOAT_2D, ends, 3, 0};
    const broadside_boxes fewer = {BROADSIDE_FLOAT_2D, ends, 2, 0};
    const broadside_pair which[3] = {{0, 1}, {0, 2}, {1, 2}};
    broadside_overlap_time times[3];
    broadside_find_options options;
    broadside_tracker* tracker = NULL;
    broadside_find_options_init(&options);
    options.to = &to;
    status = broadside_count_pairs(&boxes, NULL, &options, &count, &error);
    expect(status == BROADSIDE_OK && count == 3, "moving", &error);
    status = broadside_overlap_times(&boxes, &to, NULL, NULL, which, 3, times, &error);
    expect(status == BROADSIDE_OK && times[0].leave == 0 && times[1].enter == 1 && times[2].enter == 0.25 &&
               times[2].leave == 5 / 12.0,
           "overlap times", &error);
    status = broadside_overlap_times(&boxes, &to, &boxes, NULL, which, 3, times, &error);
    expect(status == BROADSIDE_INVALID_ARGUMENT, "overlap times of a set without ends", &error);
    status = broadside_tracker_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &tracker, &error);
    expect(status == BROADSIDE_INVALID_ARGUMENT && strstr(error.message, "to or right_to") != NULL, "tracker", &error);
    status = broadside_count_pairs(&boxes, &boxes, &options, &count, &error);
    expect(status == BROADSIDE_INVALID_ARGUMENT && strstr(error.message, "right_to") != NULL, "one end", &error);
    options.right_to = &to;
    status = broadside_count_pairs(&boxes, &boxes, &options, &count, &error);
    expect(status == BROADSIDE_OK && count == 9, "two moving sets", &error);
    options.right_to = &fewer;
    status = broadside_count_pairs(&boxes, &boxes, &options, &count, &error);
    expect(status == BROADSIDE_INVALID_FRAME, "ends of another length", &error);
  }

  {
    /* Intervals that touch: closed, and then half-open. */
    const double starts[3] = {3000000000.0, 3000000001.0, INFINITY};
    const double ends[3] = {3000000001.0, 3000000002.0, -INFINITY};
    double rows[12];
    const broadside_boxes intervals = broadside_intervals(starts, ends, 3, rows);
    broadside_find_options options;
    broadside_find_options_init(&options);
    status = broadside_count_pairs(&intervals, NULL, NULL, &count, &error);
    expect(status == BROADSIDE_OK && count == 1, "intervals", &error);
    options.leaves_out_touching = 1;
    status = broadside_count_pairs(&intervals, NULL, &options, &count, &error);
    expect(status == BROADSIDE_OK && count == 0, "half-open intervals", &error);
  }

  bodies[2].box[0] = NAN;
  status = broadside_count_pairs(&boxes, NULL, NULL, &count, &error);
  expect(status == BROADSIDE_INVALID_INPUT && error.index == 2 && strstr(error.message, "box 2") != NULL,
         "an invalid box", &error);
}

static void try_owners(void) {
  /* Two boxes of car 7 touch the wall 9; then one, then none. */
  const broadside_owner_pair pairs[2] = {{7, 9}, {9, 7}};
  broadside_error error = {BROADSIDE_OK, 0, ""};
  broadside_owner_events events;
  broadside_owner_pairs* cars = NULL;
  broadside_status status = broadside_owner_pairs_create(BROADSIDE_C_API_VERSION, &cars, &error);
  expect(status == BROADSIDE_OK, "owners", &error);
  status = broadside_owner_pairs_update(cars, pairs, 2, NULL, 0, &events, &error);
  expect(status == BROADSIDE_OK && events.begun_count == 1 && events.begun[0].first == 7, "owners begin",
         &error);
  status = broadside_owner_pairs_update(cars, NULL, 0, pairs, 1, &events, &error);
  expect(status == BROADSIDE_OK && events.ended_count == 0, "one pair of boxes is left", &error);
  status = broadside_owner_pairs_update(cars, NULL, 0, pairs, 2, &events, &error);
  expect(status == BROADSIDE_INVALID_FRAME && strstr(error.message, "owners 7 and 9 have 1 pairs") != NULL,
         "more end than begin", &error);
  status = broadside_owner_pairs_update(cars, NULL, 0, pairs, 1, &events, &error);
  expect(status == BROADSIDE_OK && events.ended_count == 1 && events.ended[0].second == 9, "owners end",
         &error);
  broadside_owner_pairs_destroy(cars);
}

static void try_world(void) {
  const double boxes[2][6] = {{0, 0, 0, 1, 1, 1}, {3, 0, 0, 4, 1, 1}};
  const double moved[6] = {0.5, 0, 0, 1.5, 1, 1};
  broadside_error error = {BROADSIDE_OK, 0, ""};
  broadside_world* world = NULL;
  broadside_handle handles[2];
  broadside_events events;
  const broadside_boxes both = {BROADSIDE_DOUBLE_3D, boxes, 2, 0};
  const broadside_boxes one = {BROADSIDE_DOUBLE_3D, moved, 1, 0};
  broadside_status status =
      broadside_world_create(BROADSIDE_C_API_VERSION, BROADSIDE_DOUBLE_3D, NULL, &world, &error);
  expect(status == BROADSIDE_OK, "create", &error);
  status = broadside_world_add(world, &both, NULL, NULL, handles, &error);
  expect(status == BROADSIDE_OK, "add", &error);
  status = broadside_world_update(world, &events, &error);
  expect(status == BROADSIDE_OK && events.begun_count == 0, "the first update", &error);
  status = broadside_world_move(world, &handles[1], &one, NULL, &error);
  expect(status == BROADSIDE_OK, "move", &error);
  status = broadside_world_update(world, &events, &error);
  expect(status == BROADSIDE_OK && events.begun_count == 1 && events.begun[0].first.slot == handles[0].slot,
         "the second update", &error);
  status = broadside_world_remove(world, handles, 2, &error);
  expect(status == BROADSIDE_OK && broadside_world_size(world) == 0, "remove", &error);
  status = broadside_world_remove(world, handles, 1, &error);
  expect(status == BROADSIDE_INVALID_HANDLE, "remove again", &error);
  broadside_world_destroy(world);
}

int main(void) {
  try_floats();
  try_owners();
  try_world();
  return failures == 0 ? 0 : 1;
}
