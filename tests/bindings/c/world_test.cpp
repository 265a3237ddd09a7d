// Worlds, indexes, callbacks and errors through the interface for C, against the C++ classes behind them.
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/broadside.hpp"

#include "bindings/c/broadside.h"
#include "tests/support/scattered.hpp"

namespace broadside {
namespace {

using testing::HasSubstr;

/// A world of floats in the plane, and its error.
class CWorld : public testing::Test {
 protected:
  CWorld() {
    EXPECT_EQ(broadside_world_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, nullptr, &world_, &error_),
              BROADSIDE_OK)
        << error_.message;
  }
  ~CWorld() override { broadside_world_destroy(world_); }

  static broadside_boxes view_of(const std::vector<Box2>& boxes) {
    return {BROADSIDE_FLOAT_2D, boxes.data(), boxes.size(), 0};
  }

  std::vector<broadside_handle> add(const std::vector<Box2>& boxes) {
    std::vector<broadside_handle> handles(boxes.size());
    const broadside_boxes view = view_of(boxes);
    EXPECT_EQ(broadside_world_add(world_, &view, nullptr, nullptr, handles.data(), &error_), BROADSIDE_OK)
        << error_.message;
    return handles;
  }

  broadside_events update() {
    broadside_events events{};
    EXPECT_EQ(broadside_world_update(world_, &events, &error_), BROADSIDE_OK) << error_.message;
    return events;
  }

  broadside_world* world_ = nullptr;
  broadside_error error_{};
};

Handle handle_of(broadside_handle handle) { return {handle.slot, handle.generation}; }

TEST_F(CWorld, HasTheEventsOfTheClassBehindIt) {
  World2 model;
  std::vector<Box2> boxes = scattered_boxes<2>(300, 30);
  std::vector<Handle> model_handles(boxes.size());
  model.add(boxes, model_handles);
  const std::vector<broadside_handle> handles = add(boxes);
  Rng rng(5);
  for (int frame = 0; frame < 20; ++frame) {
    const Events expected = model.update();
    const broadside_events events = update();
    ASSERT_EQ(events.begun_count, expected.begun.size());
    ASSERT_EQ(events.ended_count, expected.ended.size());
    for (std::size_t i = 0; i < expected.begun.size(); ++i) {
      EXPECT_EQ(handle_of(events.begun[i].first), expected.begun[i].first);
      EXPECT_EQ(handle_of(events.begun[i].second), expected.begun[i].second);
    }
    const broadside_handle_pair* pairs = nullptr;
    std::size_t count = 0;
    ASSERT_EQ(broadside_world_pairs(world_, &pairs, &count, &error_), BROADSIDE_OK);
    EXPECT_EQ(count, model.pairs().size());
    for (Box2& box : boxes) {
      const float step = rng.between(-1, 1);
      box.min[0] += step;
      box.max[0] += step;
    }
    model.move(model_handles, boxes);
    const broadside_boxes view = view_of(boxes);
    ASSERT_EQ(broadside_world_move(world_, handles.data(), &view, nullptr, &error_), BROADSIDE_OK);
  }
}

TEST_F(CWorld, AnswersQueriesAsTheClassBehindIt) {
  World2 model;
  const std::vector<Box2> boxes = scattered_boxes<2>(200, 30);
  std::vector<Handle> handles(boxes.size());
  model.add(boxes, handles);
  add(boxes);
  for (const Box2& asked : scattered_boxes<2>(50, 30, 9)) {
    std::size_t expected = 0;
    model.overlapping(asked, [&](Handle) {
      ++expected;
      return true;
    });
    std::vector<broadside_handle> found(200);
    std::size_t count = 0;
    ASSERT_EQ(
        broadside_world_overlapping(world_, &asked, nullptr, found.data(), found.size(), &count, &error_),
        BROADSIDE_OK);
    EXPECT_EQ(count, expected);

    const Box2 point = {asked.min, asked.min};
    const Point<2> direction = {1, 0.5F};
    const auto first = model.first_hit(Ray<2>{asked.min, direction});
    broadside_hit hit{};
    int is_found = -1;
    ASSERT_EQ(broadside_world_first_hit(world_, &point, &direction, std::numeric_limits<double>::infinity(),
                                        nullptr, &hit, &is_found, &error_),
              BROADSIDE_OK);
    ASSERT_EQ(is_found != 0, first.has_value());
    if (first) {
      EXPECT_EQ(handle_of(hit.handle), first->handle);
      EXPECT_EQ(hit.t_enter, first->t_enter);
    }

    const BoxCast<2> cast{.box = asked, .direction = direction, .entering = true};
    const auto entered = model.first_hit(cast);
    std::size_t entered_count = 0;
    model.hits(cast, [&](Handle, float) { ++entered_count; });
    std::vector<broadside_hit> hits(200);
    ASSERT_EQ(broadside_world_entered(world_, &asked, &direction, std::numeric_limits<double>::infinity(),
                                      nullptr, hits.data(), hits.size(), &count, &error_),
              BROADSIDE_OK);
    EXPECT_EQ(count, entered_count);
    ASSERT_EQ(
        broadside_world_first_entered(world_, &asked, &direction, std::numeric_limits<double>::infinity(),
                                      nullptr, &hit, &is_found, &error_),
        BROADSIDE_OK);
    ASSERT_EQ(is_found != 0, entered.has_value());
    if (entered) {
      EXPECT_EQ(handle_of(hit.handle), entered->handle);
      EXPECT_EQ(hit.t_enter, entered->t_enter);
    }

    const auto near_box = model.nearest(asked, 2);
    broadside_neighbour to_box[2];
    ASSERT_EQ(broadside_world_nearest_to_box(world_, &asked, std::numeric_limits<double>::infinity(), nullptr,
                                             to_box, 2, &count, &error_),
              BROADSIDE_OK);
    ASSERT_EQ(count, near_box.size());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(handle_of(to_box[i].handle), near_box[i].handle);
      EXPECT_EQ(to_box[i].distance_squared, near_box[i].distance_squared);
    }

    std::vector<HandleNeighbour> near;
    model.nearest(asked.min, 3, near);
    broadside_neighbour neighbours[3];
    ASSERT_EQ(broadside_world_nearest(world_, &asked.min, nullptr, neighbours, 3, &count, &error_),
              BROADSIDE_OK);
    ASSERT_EQ(count, near.size());
    for (std::size_t i = 0; i < near.size(); ++i) EXPECT_EQ(handle_of(neighbours[i].handle), near[i].handle);

    model.nearest(asked.min, 3, near, {.max_distance = 0.25F});
    ASSERT_EQ(
        broadside_world_nearest_within(world_, &asked.min, 0.25, nullptr, neighbours, 3, &count, &error_),
        BROADSIDE_OK);
    ASSERT_EQ(count, near.size());
    for (std::size_t i = 0; i < near.size(); ++i) EXPECT_EQ(handle_of(neighbours[i].handle), near[i].handle);
  }
}

TEST_F(CWorld, FindsNothingFartherThanAGreatestDistance) {
  const std::vector<broadside_handle> handles = add({{{3, 0}, {4, 1}}, {{0.1F, 0}, {1, 1}}});
  const Point<2> point = {0, 0};
  broadside_neighbour found[2];
  std::size_t count = 0;
  const auto ask = [&](double max_distance, const broadside_query* query = nullptr) {
    return broadside_world_nearest_within(world_, &point, max_distance, query, found, 2, &count, &error_);
  };
  ASSERT_EQ(ask(3), BROADSIDE_OK);
  EXPECT_EQ(count, 2U);
  ASSERT_EQ(ask(0.1), BROADSIDE_OK) << "0.1F is more than 0.1";
  EXPECT_EQ(count, 0U);
  ASSERT_EQ(ask(0.1F), BROADSIDE_OK);
  EXPECT_EQ(count, 1U);
  EXPECT_EQ(handle_of(found[0].handle), handle_of(handles[1]));
  const broadside_query query = {nullptr, &handles[1], nullptr};
  ASSERT_EQ(ask(0.1F, &query), BROADSIDE_OK);
  EXPECT_EQ(count, 0U);
  count = 77;
  EXPECT_EQ(ask(-1), BROADSIDE_INVALID_QUERY);
  EXPECT_STREQ(error_.message, "max_distance is -1; expected at least 0, or infinity");
  EXPECT_EQ(ask(std::numeric_limits<double>::quiet_NaN()), BROADSIDE_INVALID_QUERY);
  EXPECT_EQ(count, 77U);
}

TEST_F(CWorld, LeavesOutWhatAQueryExcepts) {
  const std::vector<broadside_handle> handles = add({{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}});
  const Box2 all = {{0, 0}, {4, 4}};
  const broadside_query query = {nullptr, &handles[0], nullptr};
  broadside_handle found[2];
  std::size_t count = 0;
  ASSERT_EQ(broadside_world_overlapping(world_, &all, &query, found, 2, &count, &error_), BROADSIDE_OK);
  ASSERT_EQ(count, 1U);
  EXPECT_EQ(handle_of(found[0]), handle_of(handles[1]));
}

TEST_F(CWorld, SaysHowMuchRoomIsMissing) {
  add({{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{2, 2}, {4, 4}}});
  const Box2 all = {{0, 0}, {4, 4}};
  broadside_handle found[2] = {};
  std::size_t count = 0;
  EXPECT_EQ(broadside_world_overlapping(world_, &all, nullptr, found, 2, &count, &error_),
            BROADSIDE_TOO_SMALL);
  EXPECT_EQ(count, 3U);
  EXPECT_THAT(error_.message, HasSubstr("room for 2 handles; expected room for 3"));
}

TEST_F(CWorld, LeavesTheCountOfAQueryThatFails) {
  const Box2 wrong = {{std::numeric_limits<float>::quiet_NaN(), 0}, {1, 1}};
  broadside_handle found[2] = {};
  std::size_t count = 77;
  EXPECT_EQ(broadside_world_overlapping(world_, &wrong, nullptr, found, 2, &count, &error_),
            BROADSIDE_INVALID_QUERY);
  EXPECT_EQ(count, 77U);
}

TEST_F(CWorld, AsksThePredicate) {
  const std::vector<broadside_handle> handles = add({{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{2, 2}, {4, 4}}});
  struct Seen {
    std::uint32_t slot;
    int asked = 0;
  } seen{handles[2].slot};
  const auto predicate = [](void* user, broadside_handle, broadside_handle second) {
    auto& wanted = *static_cast<Seen*>(user);
    ++wanted.asked;
    return second.slot == wanted.slot ? 1 : 0;
  };
  ASSERT_EQ(broadside_world_set_predicate(world_, predicate, &seen, &error_), BROADSIDE_OK);
  EXPECT_EQ(update().begun_count, 2U);
  EXPECT_EQ(seen.asked, 3);
}

TEST_F(CWorld, IsRestoredFromASnapshot) {
  const std::vector<broadside_handle> handles = add(scattered_boxes<2>(50));
  const std::size_t begun = update().begun_count;
  std::size_t size = 0;
  EXPECT_EQ(broadside_world_snapshot(world_, nullptr, 0, &size, &error_), BROADSIDE_TOO_SMALL);
  std::vector<std::byte> bytes(size);
  ASSERT_EQ(broadside_world_snapshot(world_, bytes.data(), bytes.size(), &size, &error_), BROADSIDE_OK);
  ASSERT_EQ(broadside_world_remove(world_, handles.data(), handles.size(), &error_), BROADSIDE_OK);
  EXPECT_EQ(update().ended_count, begun);
  EXPECT_EQ(broadside_world_restore(world_, bytes.data(), size - 1, &error_), BROADSIDE_INVALID_SNAPSHOT);
  EXPECT_EQ(broadside_world_size(world_), 0U);
  ASSERT_EQ(broadside_world_restore(world_, bytes.data(), size, &error_), BROADSIDE_OK);
  EXPECT_EQ(broadside_world_size(world_), handles.size());
  EXPECT_EQ(broadside_world_contains(world_, handles[7]), 1);
}

TEST_F(CWorld, KeepsFiltersAndUserData) {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}};
  const broadside_boxes view = view_of(boxes);
  broadside_filter filters[2] = {broadside_standard_filter(), broadside_standard_filter()};
  filters[1].mask = 2;
  const std::uint64_t data[2] = {17, 18};
  broadside_handle handles[2];
  ASSERT_EQ(broadside_world_add(world_, &view, filters, data, handles, &error_), BROADSIDE_OK);
  EXPECT_EQ(update().begun_count, 0U);
  std::uint64_t found = 0;
  ASSERT_EQ(broadside_world_user_data(world_, handles[1], &found, &error_), BROADSIDE_OK);
  EXPECT_EQ(found, 18U);
  filters[1].mask = 1;
  ASSERT_EQ(broadside_world_set_filter(world_, handles[1], &filters[1], &error_), BROADSIDE_OK);
  EXPECT_EQ(update().begun_count, 1U);
  ASSERT_EQ(broadside_world_ignore(world_, handles[0], handles[1], 1, &error_), BROADSIDE_OK);
  EXPECT_EQ(update().ended_count, 1U);
}

TEST_F(CWorld, RefusesBoxesOfAnotherKindAndWorldsOfOne) {
  const double box[6] = {};
  const broadside_boxes boxes = {BROADSIDE_DOUBLE_3D, box, 1, 0};
  broadside_handle handle;
  EXPECT_EQ(broadside_world_add(world_, &boxes, nullptr, nullptr, &handle, &error_),
            BROADSIDE_INVALID_ARGUMENT);
  EXPECT_THAT(error_.message, HasSubstr("boxes are 3D doubles; expected 2D floats"));
  broadside_world* other = nullptr;
  ASSERT_EQ(broadside_world_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_3D, nullptr, &other, &error_),
            BROADSIDE_OK);
  std::size_t count = 0;
  EXPECT_EQ(broadside_world_join(world_, other, nullptr, 0, &count, &error_), BROADSIDE_INVALID_ARGUMENT);
  broadside_world_destroy(other);
}

TEST_F(CWorld, RefusesHandlesOfAnotherWorld) {
  broadside_world_options options;
  broadside_world_options_init(&options);
  options.first_generation = 1U << 20;
  broadside_world* other = nullptr;
  ASSERT_EQ(broadside_world_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &other, &error_),
            BROADSIDE_OK);
  const broadside_handle handle = add({{{0, 0}, {1, 1}}})[0];
  EXPECT_EQ(broadside_world_remove(other, &handle, 1, &error_), BROADSIDE_INVALID_HANDLE);
  broadside_world_destroy(other);
}

TEST(CWorldOptions, AreNamedAsInCxxAndFieldsCountInstead) {
  broadside_world_options options;
  broadside_world_options_init(&options);
  options.settings = "world:margin=-1";
  broadside_error error;
  broadside_world* world = nullptr;
  EXPECT_EQ(broadside_world_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &world, &error),
            BROADSIDE_INVALID_SPEC);
  EXPECT_STREQ(error.message, "world: margin is '-1'; expected a number of at least 0");
  options.settings = "world:first_generation=7:events=enlarged:margin=1";
  for (const std::uint32_t field : {0U, 9U}) {
    options.first_generation = field;
    ASSERT_EQ(broadside_world_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &world, &error),
              BROADSIDE_OK);
    const float boxes[][4] = {{0, 0, 1, 1}};
    const broadside_boxes view{BROADSIDE_FLOAT_2D, boxes, 1, 0};
    broadside_handle handle;
    ASSERT_EQ(broadside_world_add(world, &view, nullptr, nullptr, &handle, &error), BROADSIDE_OK);
    EXPECT_EQ(handle.generation, field == 0 ? 7U : 9U);
    broadside_world_destroy(world);
  }
}

TEST(CIndex, FindsWhatTheClassBehindItFinds) {
  const std::vector<Box3> boxes = scattered_boxes<3>(300, 20);
  broadside_error error;
  broadside_index* index = nullptr;
  ASSERT_EQ(broadside_index_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_3D, &index, &error),
            BROADSIDE_OK);
  const broadside_boxes view = {BROADSIDE_FLOAT_3D, boxes.data(), boxes.size(), 0};
  ASSERT_EQ(broadside_index_update(index, &view, nullptr, 0, nullptr, &error), BROADSIDE_OK);
  for (std::uint32_t place = 0; place < 300; place += 10) {
    std::vector<std::uint32_t> found(300);
    std::size_t count = 0;
    const broadside_query query = {nullptr, nullptr, &place};
    ASSERT_EQ(broadside_index_overlapping(index, &boxes[place], &query, found.data(), 300, &count, &error),
              BROADSIDE_OK);
    std::size_t expected = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) expected += i != place && overlap(boxes[i], boxes[place]);
    EXPECT_EQ(count, expected);

    std::size_t near = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      near += i != place && distance_squared(boxes[place].min, boxes[i]) <= 4;
    std::vector<broadside_neighbour> neighbours(300);
    ASSERT_EQ(broadside_index_nearest_within(index, &boxes[place].min, 2, &query, neighbours.data(), 300,
                                             &count, &error),
              BROADSIDE_OK);
    EXPECT_EQ(count, near);
  }
  broadside_index_destroy(index);
}

class CPairs : public testing::Test {
 protected:
  const std::vector<Box2> boxes_ = scattered_boxes<2>(3'000, 40);
  const broadside_boxes view_ = {BROADSIDE_FLOAT_2D, boxes_.data(), boxes_.size(), 0};
  broadside_error error_{};
};

TEST_F(CPairs, AreCountedWrittenAndHandedOnAlike) {
  std::uint64_t count = 0;
  ASSERT_EQ(broadside_count_pairs(&view_, nullptr, nullptr, &count, &error_), BROADSIDE_OK);
  EXPECT_EQ(count, find_pairs(boxes_).size());
  std::vector<broadside_pair> written(count);
  ASSERT_EQ(broadside_find_pairs(&view_, nullptr, nullptr, written.data(), written.size(), &count, &error_),
            BROADSIDE_OK);
  std::vector<broadside_pair> handed_on;
  const auto callback = [](void* user, const broadside_pair* pairs, std::size_t size) {
    auto& all = *static_cast<std::vector<broadside_pair>*>(user);
    all.insert(all.end(), pairs, pairs + size);
    return 0;
  };
  ASSERT_EQ(broadside_for_each_pairs(&view_, nullptr, nullptr, callback, &handed_on, &error_), BROADSIDE_OK);
  ASSERT_EQ(handed_on.size(), written.size());
  EXPECT_EQ(std::memcmp(handed_on.data(), written.data(), written.size() * sizeof(written[0])), 0);
}

TEST_F(CPairs, FillABufferThatIsTooSmallAndSayHowManyThereAre) {
  broadside_pair pairs[10];
  std::uint64_t count = 0;
  EXPECT_EQ(broadside_find_pairs(&view_, nullptr, nullptr, pairs, 10, &count, &error_), BROADSIDE_TOO_SMALL);
  EXPECT_EQ(count, find_pairs(boxes_).size());
  EXPECT_LT(pairs[9].first, pairs[9].second);
}

TEST_F(CPairs, StopWhereTheCallbackAsksFor) {
  const auto callback = [](void*, const broadside_pair*, std::size_t) { return 1; };
  EXPECT_EQ(broadside_for_each_pairs(&view_, nullptr, nullptr, callback, nullptr, &error_),
            BROADSIDE_STOPPED);
}

TEST_F(CPairs, OfManyWorldsAreThoseOfEach) {
  const std::size_t offsets[] = {0, 0, 1'000, 1'500, 3'000};
  std::size_t pair_offsets[5];
  ASSERT_EQ(broadside_find_pairs_batch(&view_, offsets, 4, nullptr, nullptr, 0, pair_offsets, &error_),
            BROADSIDE_TOO_SMALL);
  std::vector<broadside_pair> pairs(pair_offsets[4]);
  broadside_find_options options;
  broadside_find_options_init(&options);
  options.algorithm = "auto:threads=2";
  ASSERT_EQ(broadside_find_pairs_batch(&view_, offsets, 4, &options, pairs.data(), pairs.size(), pair_offsets,
                                       &error_),
            BROADSIDE_OK)
      << error_.message;
  for (std::size_t world = 0; world < 4; ++world) {
    const auto expected =
        find_pairs(std::span(boxes_).subspan(offsets[world], offsets[world + 1] - offsets[world]));
    ASSERT_EQ(pair_offsets[world + 1] - pair_offsets[world], expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const broadside_pair& pair = pairs[pair_offsets[world] + i];
      ASSERT_EQ((Pair{BoxId{pair.first}, BoxId{pair.second}}), expected[i]);
    }
  }
}

TEST_F(CPairs, OfManyWorldsRefuseWhatCannotBe) {
  std::size_t offsets[] = {0, 2'000, 3'000};
  std::size_t pair_offsets[3] = {7, 7, 7};
  std::vector<Box2> boxes = boxes_;
  const broadside_boxes view = {BROADSIDE_FLOAT_2D, boxes.data(), boxes.size(), 0};
  const auto status = [&] {
    return broadside_find_pairs_batch(&view, offsets, 2, nullptr, nullptr, 0, pair_offsets, &error_);
  };
  boxes[2'005].min[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(status(), BROADSIDE_INVALID_INPUT);
  EXPECT_EQ(error_.index, 2'005U);
  EXPECT_NE(std::string(error_.message).find("box 5 of world 1"), std::string::npos) << error_.message;
  boxes = boxes_;
  offsets[2] = 2'999;
  EXPECT_EQ(status(), BROADSIDE_INVALID_FRAME);
  EXPECT_EQ(broadside_find_pairs_batch(&view, nullptr, 2, nullptr, nullptr, 0, pair_offsets, &error_),
            BROADSIDE_INVALID_ARGUMENT);
  EXPECT_EQ(pair_offsets[0], 7U);
}

TEST_F(CPairs, OfManyWorldsBeginAndEnd) {
  std::vector<Box2> boxes = boxes_;
  const broadside_boxes view = {BROADSIDE_FLOAT_2D, boxes.data(), boxes.size(), 0};
  const std::size_t offsets[] = {0, 0, 1'000, 1'500, 3'000};
  broadside_batch_tracker* tracker = nullptr;
  broadside_find_options options;
  broadside_find_options_init(&options);
  options.quarantines = 1;
  EXPECT_EQ(broadside_batch_tracker_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &tracker,
                                           &error_),
            BROADSIDE_INVALID_ARGUMENT);
  options.quarantines = 0;
  ASSERT_EQ(broadside_batch_tracker_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &tracker,
                                           &error_),
            BROADSIDE_OK)
      << error_.message;
  broadside_batch_events events;
  const auto update = [&](std::size_t worlds) {
    return broadside_batch_tracker_update(tracker, &view, offsets, worlds, nullptr, &events, &error_);
  };
  ASSERT_EQ(update(4), BROADSIDE_OK) << error_.message;
  const BatchPairs expected = find_pairs_batch(boxes, offsets);
  ASSERT_EQ(std::vector<std::size_t>(events.begun_offsets, events.begun_offsets + 5), expected.offsets);
  EXPECT_EQ(events.ended_offsets[4], 0U);
  for (std::size_t i = 0; i < expected.pairs.size(); ++i)
    ASSERT_EQ((Pair{BoxId{events.begun[i].first}, BoxId{events.begun[i].second}}), expected.pairs[i]);

  EXPECT_EQ(update(3), BROADSIDE_INVALID_FRAME);
  EXPECT_NE(std::string(error_.message).find("the last offset of worlds is 1500"), std::string::npos);
  std::fill(boxes.begin(), boxes.begin() + 1'000, absent_box<2>());
  ASSERT_EQ(update(4), BROADSIDE_OK);
  EXPECT_EQ(events.begun_offsets[4], 0U);
  EXPECT_EQ(events.ended_offsets[2], expected.offsets[2]);
  EXPECT_EQ(events.ended_offsets[4], expected.offsets[2]);
  broadside_batch_tracker_destroy(tracker);
  broadside_batch_tracker_destroy(nullptr);
}

TEST_F(CPairs, AreFoundInStructsOfTheCallers) {
  struct Body {
    char name[3];
    float box[4];
  };
  std::vector<Body> bodies(boxes_.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) std::memcpy(bodies[i].box, &boxes_[i], sizeof(Box2));
  const broadside_boxes view = {BROADSIDE_FLOAT_2D, bodies[0].box, bodies.size(), sizeof(Body)};
  std::uint64_t count = 0;
  ASSERT_EQ(broadside_count_pairs(&view, nullptr, nullptr, &count, &error_), BROADSIDE_OK) << error_.message;
  EXPECT_EQ(count, find_pairs(boxes_).size());
}

TEST_F(CPairs, AreFoundByTheCallersThreads) {
  const auto run = [](void*, std::size_t count, void (*task)(void*, std::size_t), void* state) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back(task, state, i);
    for (std::thread& thread : threads) thread.join();
  };
  const broadside_executor executor = {[](void*) { return std::size_t{3}; }, run, nullptr};
  broadside_find_options options;
  broadside_find_options_init(&options);
  options.algorithm = "grid:threads=0";
  options.executor = &executor;
  std::uint64_t count = 0;
  std::vector<Box2> many = scattered_boxes<2>(20'000, 100);
  const broadside_boxes view = {BROADSIDE_FLOAT_2D, many.data(), many.size(), 0};
  ASSERT_EQ(broadside_count_pairs(&view, nullptr, &options, &count, &error_), BROADSIDE_OK) << error_.message;
  EXPECT_EQ(count, find_pairs(many).size());
}

TEST_F(CPairs, RefuseWhatCannotBe) {
  std::uint64_t count = 77;
  const auto refused = [&](const broadside_boxes& boxes, const broadside_find_options* options = nullptr) {
    const broadside_status status = broadside_count_pairs(&boxes, nullptr, options, &count, &error_);
    EXPECT_EQ(count, 77U);
    return status;
  };
  EXPECT_EQ(refused({static_cast<broadside_kind>(9), nullptr, 0, 0}), BROADSIDE_INVALID_ARGUMENT);
  EXPECT_THAT(error_.message, HasSubstr("kind is 9"));
  EXPECT_EQ(refused({BROADSIDE_FLOAT_2D, nullptr, 1, 0}), BROADSIDE_INVALID_ARGUMENT);
  EXPECT_THAT(error_.message, HasSubstr("boxes.first is null; expected an array of 1"));
  EXPECT_EQ(refused({BROADSIDE_FLOAT_2D, boxes_.data(), 2, 8}), BROADSIDE_INVALID_ARGUMENT);
  EXPECT_THAT(error_.message, HasSubstr("boxes.stride is 8; expected 0 or at least 16"));
  broadside_find_options options;
  broadside_find_options_init(&options);
  options.algorithm = "gird";
  EXPECT_EQ(refused(view_, &options), BROADSIDE_INVALID_SPEC);
  EXPECT_THAT(error_.message, HasSubstr("did you mean 'grid'?"));
  options.size = 3;
  EXPECT_EQ(refused(view_, &options), BROADSIDE_INVALID_ARGUMENT);
  EXPECT_EQ(broadside_count_pairs(nullptr, nullptr, nullptr, &count, nullptr), BROADSIDE_INVALID_ARGUMENT);
  broadside_finder* finder = nullptr;
  EXPECT_EQ(
      broadside_finder_create(BROADSIDE_C_API_VERSION + 1, BROADSIDE_FLOAT_2D, nullptr, &finder, &error_),
      BROADSIDE_INVALID_ARGUMENT);
  EXPECT_EQ(finder, nullptr);
}

TEST_F(CPairs, QuarantineWhatIsInvalidWhereThatIsAskedFor) {
  std::vector<Box2> boxes = boxes_;
  boxes[5].max[1] = std::numeric_limits<float>::quiet_NaN();
  broadside_find_options options;
  broadside_find_options_init(&options);
  options.quarantines = 1;
  broadside_finder* finder = nullptr;
  ASSERT_EQ(broadside_finder_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &finder, &error_),
            BROADSIDE_OK);
  const broadside_boxes view = {BROADSIDE_FLOAT_2D, boxes.data(), boxes.size(), 0};
  const broadside_pair* pairs = nullptr;
  std::size_t count = 0;
  ASSERT_EQ(broadside_finder_find(finder, &view, nullptr, nullptr, &pairs, &count, &error_), BROADSIDE_OK);
  std::size_t quarantined = 0;
  const std::uint32_t* places = broadside_finder_quarantined(finder, &quarantined);
  ASSERT_EQ(quarantined, 1U);
  EXPECT_EQ(places[0], 5U);
  broadside_finder_destroy(finder);
}

TEST(CTouching, IsLeftOutWhereThatIsAskedFor) {
  const std::vector<Box2> boxes = {{{0, 0}, {1, 1}}, {{1, 0}, {2, 1}}, {{0.5F, 0}, {1.5F, 1}}};
  const broadside_boxes view = {BROADSIDE_FLOAT_2D, boxes.data(), boxes.size(), 0};
  broadside_find_options options;
  broadside_find_options_init(&options);
  options.leaves_out_touching = 1;
  std::uint64_t count = 0;
  broadside_error error;
  ASSERT_EQ(broadside_count_pairs(&view, nullptr, nullptr, &count, &error), BROADSIDE_OK);
  EXPECT_EQ(count, 3U);
  ASSERT_EQ(broadside_count_pairs(&view, nullptr, &options, &count, &error), BROADSIDE_OK);
  EXPECT_EQ(count, 2U);
  broadside_tracker* tracker = nullptr;
  ASSERT_EQ(broadside_tracker_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &options, &tracker, &error),
            BROADSIDE_OK);
  broadside_pair_events events;
  ASSERT_EQ(broadside_tracker_update(tracker, &view, nullptr, 0, nullptr, &events, &error), BROADSIDE_OK);
  EXPECT_EQ(events.begun_count, 2U);
  broadside_tracker_destroy(tracker);
  broadside_world_options world_options;
  broadside_world_options_init(&world_options);
  world_options.settings = "world:touching=no";
  broadside_world* world = nullptr;
  ASSERT_EQ(
      broadside_world_create(BROADSIDE_C_API_VERSION, BROADSIDE_FLOAT_2D, &world_options, &world, &error),
      BROADSIDE_OK);
  std::vector<broadside_handle> handles(boxes.size());
  ASSERT_EQ(broadside_world_add(world, &view, nullptr, nullptr, handles.data(), &error), BROADSIDE_OK);
  std::size_t found = 0;
  ASSERT_EQ(broadside_world_overlapping(world, boxes.data(), nullptr, handles.data(), handles.size(), &found,
                                        &error),
            BROADSIDE_OK);
  EXPECT_EQ(found, 2U);
  broadside_world_destroy(world);
}

TEST(CErrors, CutALongMessageAtACharacter) {
  broadside_find_options options;
  broadside_find_options_init(&options);
  std::string spec = "grid:cell=";
  while (spec.size() < 5'000) spec += "ä";
  options.algorithm = spec.c_str();
  broadside_error error;
  std::uint64_t count = 0;
  const broadside_boxes none = {BROADSIDE_FLOAT_2D, nullptr, 0, 0};
  EXPECT_EQ(broadside_count_pairs(&none, nullptr, &options, &count, &error), BROADSIDE_INVALID_SPEC);
  const std::string message = error.message;
  EXPECT_LT(message.size(), sizeof(error.message));
  EXPECT_NE(static_cast<unsigned char>(message.back()) & 0xc0U, 0xc0U) << "half a character";
}

}  // namespace
}  // namespace broadside
