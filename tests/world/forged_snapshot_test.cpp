// Snapshots whose fields contradict each other under a right checksum: each is refused for what is wrong with
// it.
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "tests/fuzz/snapshot_fields.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"

namespace broadside {
namespace {

using testing::HasSubstr;
using Fields = fuzz::SnapshotFields<2, float>;

constexpr Pair first{BoxId{0}, BoxId{1}};
constexpr Pair apart{BoxId{0}, BoxId{3}};

/// Four boxes in a row: those of neighbours are pairs, of which (0, 1) began with the last update. Box 3 has
/// left its place since then.
Fields fields_of_a_world(double margin) {
  WorldOptions options;
  options.algorithm = "brute_force";
  options.margin = margin;
  World2 world(options);
  const Handle moved = world.add(at(-9));
  world.add(at(1));
  world.add(at(2));
  const Handle last = world.add(at(3));
  world.update();
  world.move(moved, at(0));
  world.update();
  world.move(last, at(30));
  return fuzz::fields_of<2, float>(world.snapshot());
}

void expect_refused(const Fields& fields, const std::string& message) {
  World2 world;
  world.add(at(7));
  world.update();
  const auto before = world.snapshot();
  EXPECT_THAT(message_of<InvalidSnapshot>([&] { world.restore(sealed(fields)); }), HasSubstr(message));
  EXPECT_EQ(world.snapshot(), before);
}

struct Forgery {
  std::string message;
  double margin;
  std::function<void(Fields&)> forge;
};

TEST(ForgedSnapshot, IsRefusedForWhatContradictsItself) {
  const std::vector<Forgery> forgeries = {
      {"the pair (0, 1) is a candidate that began; expected the tracker to have it", 0,
       [](Fields& f) {
         f.candidates_begun = {first}, f.edges = {}, f.last_places = {BoxId{0}, BoxId{3}},
         f.last_boxes.insert(f.last_boxes.begin(), at(-9)), f.changed.push_back(BoxId{0});
       }},
      {"its pairs to refine are not those of its boxes", 1, [](Fields& f) { f.candidates_begun = {first}; }},
      {"the pair (0, 1) is a candidate that ended; expected the tracker not to have it", 1,
       [](Fields& f) { f.candidates_ended = {first}; }},
      {"pairs that must be sorted are not", 1,
       [](Fields& f) { f.edges.insert(f.edges.begin(), f.edges[0]), f.marks.push_back(3); }},
      {"the pair (0, 3) began when refined; expected it to hold", 1,
       [](Fields& f) { f.refined_begun = {apart}; }},
      {"the pair (0, 1) ended when refined; expected it not to hold", 1,
       [](Fields& f) { f.refined_ended = {first}; }},
      {"the pair (0, 3) began with the last update; expected it to hold", 0,
       [](Fields& f) { f.begun.push_back(apart); }},
      {"the pair (1, 2) ended with the last update; expected it not to hold", 0,
       [](Fields& f) {
         f.ended = {{BoxId{1}, BoxId{2}}};
       }},
      {"the pair (0, 1) is marked as not overlapping; expected overlapping", 1,
       [](Fields& f) { f.marks[0] = 0, f.pairs.erase(f.pairs.begin()), --f.pair_count, f.begun = {}; }},
      {"the pair (0, 1) overlaps but is not accepted; expected a predicate that refused it", 1,
       [](Fields& f) { f.marks[0] = 1, f.pairs.erase(f.pairs.begin()), --f.pair_count, f.begun = {}; }},
      {"the pair (0, 1) is accepted but does not overlap", 1, [](Fields& f) { f.marks[0] = 2; }},
      {"it counts 4 pairs; expected 3, which its boxes make", 0, [](Fields& f) { ++f.pair_count; }},
      {"its pairs are not those of its boxes", 0, [](Fields& f) { f.pairs[0] = apart; }},
      {"nothing is pending but an update has something to report", 0,
       [](Fields& f) { f.flags |= world::snapshot::was_settled; }},
      {"it had no update but has pairs", 0, [](Fields& f) { f.flags &= ~world::snapshot::was_updated; }},
      {"it refines no pairs but asks about some", 0, [](Fields& f) { f.refiltered = {BoxId{1}}; }},
      {"a box left its enlarged box but did not change", 1, [](Fields& f) { f.changed = {}; }},
      {"the last frame has a box in a slot that has none now", 0,
       [](Fields& f) {
         f.last_count = 5, f.last_places.push_back(BoxId{4}), f.last_boxes.push_back(at(50));
       }},
      {"a filter changed but its box is not listed", 0,
       [](Fields& f) {
         f.last_flags |= world::snapshot::last_has_filters, f.last_filtered = {BoxId{1}},
                                                            f.last_filters = {Filter{.category = 2}};
       }},
      {"the pair (0, 1) is ignored now or was in the last frame", 0,
       [](Fields& f) { f.last_ignored = {first}; }},
      {"the pair (0, 1) has a slot without a box", 0,
       [](Fields& f) { f.states[0] = 0, f.boxes[0] = absent_box<2, float>(), f.last_places = {BoxId{3}}; }},
      {"a slot is used up but has generations left", 0,
       [](Fields& f) { f.states[0] = 4, f.boxes[0] = absent_box<2, float>(); }},
      {"a box with min > max or a NaN", 0, [](Fields& f) { f.boxes[1].min[0] = 5; }},
      {"a snapshot names slot 4; expected one below 4", 0, [](Fields& f) { f.changed.push_back(BoxId{4}); }},
  };
  for (const Forgery& forgery : forgeries) {
    SCOPED_TRACE(forgery.message);
    Fields fields = fields_of_a_world(forgery.margin);
    World2 world;
    ASSERT_NO_THROW(world.restore(sealed(fields)));
    forgery.forge(fields);
    expect_refused(fields, forgery.message);
  }
}

}  // namespace
}  // namespace broadside
