/* Boxes fall to the ground; each frame prints which pairs begin to touch and which end. */
#include <broadside.h>
#include <stdio.h>
#include <stdlib.h>

enum { count = 5, frames = 12 };

static void check(broadside_status status, const broadside_error* error) {
  if (status == BROADSIDE_OK) return;
  fprintf(stderr, "falling_boxes: %s\n", error->message);
  exit(1);
}

int main(void) {
  broadside_error error;
  broadside_world* world;
  check(broadside_world_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, NULL, &world, &error), &error);

  /* The ground, and boxes above it: minima, then maxima. */
  float boxes[count][4] = {{-10, -1, 10, 0}};
  for (int i = 1; i < count; ++i) {
    const float x = 0.75f * (float)i;
    const float y = 1.5f * (float)i;
    boxes[i][0] = x;
    boxes[i][1] = y;
    boxes[i][2] = x + 1;
    boxes[i][3] = y + 1;
  }
  const broadside_boxes all = {BROADSIDE_FLOAT_2D, boxes, count, 0};
  broadside_handle handles[count];
  check(broadside_world_add(world, &all, NULL, NULL, handles, &error), &error);

  for (int frame = 0; frame < frames; ++frame) {
    broadside_events events;
    check(broadside_world_update(world, &events, &error), &error);
    for (size_t i = 0; i < events.begun_count; ++i)
      printf("frame %2d: %u and %u begin to touch\n", frame, events.begun[i].first.slot,
             events.begun[i].second.slot);
    for (size_t i = 0; i < events.ended_count; ++i)
      printf("frame %2d: %u and %u part\n", frame, events.ended[i].first.slot, events.ended[i].second.slot);

    for (int i = 1; i < count; ++i) {
      if (boxes[i][1] <= 0) continue;
      boxes[i][1] -= 0.5f;
      boxes[i][3] -= 0.5f;
    }
    check(broadside_world_move(world, handles, &all, NULL, &error), &error);
  }
  broadside_world_destroy(world);
  return 0;
}
