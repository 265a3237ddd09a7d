// Fuzzes restore() by meaning. The bytes say how a small world lives, and how the fields of its snapshot are
// then forged. A world refuses what it is given and is as before, or it restores it and is under the law from
// then on.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "history_bytes.hpp"
#include "snapshot_fields.hpp"
#include "snapshot_mutator.hpp"
#include "tests/support/world_history.hpp"

namespace broadside::fuzz {
namespace {

/// A small world, whose enlarged boxes a snapshot may say anything of.
template <int D, typename Real>
WorldCourse<D, Real> course_of(bool has_predicate) {
  WorldCourse<D, Real> course;
  course.options.algorithm = "brute_force";
  course.make = [] { return World<D, Real>("brute_force"); };
  course.box = lattice_box<D, Real>;
  course.has_predicate = has_predicate;
  course.trusts_enlarged = true;
  return course;
}

/// The snapshot of a world with a past, in the middle of a frame.
template <int D, typename Real>
SnapshotBytes any_snapshot(Bytes& bytes) {
  const std::size_t kind = bytes.below(8);
  WorldCourse<D, Real> course = course_of<D, Real>(kind / 2 % 2 == 1);
  course.make = {};
  course.predicate_throws = true;
  WorldOptions& options = course.options;
  if (kind % 4 == 3) options.algorithm = "grid";
  options.margin = kind % 2 == 0 ? 0 : 1;
  options.relative_margin = bytes.next() % 4 == 0 ? 0.5 : 0;
  if (kind % 2 == 1 && bytes.next() % 2 == 0) options.events = WorldEvents::enlarged;
  options.keep_pairs = bytes.next() % 4 != 0;
  options.touching = bytes.next() % 4 != 0;
  WorldHistory<D, Real> history(bytes, course);
  const std::size_t frames = bytes.below(4);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    for (std::size_t i = bytes.below(12); i > 0; --i) history.change();
    history.update();
  }
  for (std::size_t i = bytes.below(6); i > 0; --i) history.change();
  return history.world().snapshot();
}

/// What the snapshot says of boxes, which a world that restores it must agree with.
template <int D, typename Real>
WorldModel<D, Real> model_of(const SnapshotFields<D, Real>& fields) {
  constexpr std::uint8_t live = 1;
  WorldModel<D, Real> model;
  const auto handle = [&](std::uint32_t slot) { return Handle{slot, fields.generations[slot]}; };
  model.options.keep_pairs = fields.is_set(world::snapshot::keeps_pairs);
  model.options.predicted_frames = fields.predicted_frames;
  if (fields.is_set(world::snapshot::tells_enlarged)) model.options.events = WorldEvents::enlarged;
  for (std::uint32_t slot = 0; slot < fields.boxes.size(); ++slot) {
    if (fields.states[slot] != live) continue;
    model.add(handle(slot), fields.boxes[slot],
              {fields.filters.empty() ? Filter{} : fields.filters[slot],
               fields.user_data.empty() ? 0 : fields.user_data[slot]});
  }
  // Only now: the snapshot has the boxes as the world keeps them.
  model.options.touching = !fields.is_set(world::snapshot::leaves_out_touching);
  for (const Pair pair : fields.ignored)
    model.ignored.insert({handle(index(pair.first)), handle(index(pair.second))});
  return model;
}

/// The first update of a world that has not kept its pairs: what they were is not known.
template <int D, typename Real>
void check_unknown_pairs(WorldHistory<D, Real>& history) {
  const Events events = history.world().update();
  const std::vector<HandlePair> begun(events.begun.begin(), events.begun.end());
  const std::vector<HandlePair> ended(events.ended.begin(), events.ended.end());
  history.check();
  history.model().update();
  const std::vector<HandlePair>& now = history.model().pairs;
  expect(without(begun, now).empty(), "a pair began that does not hold");
  expect(without(ended, now) == ended, "a pair ended that holds");
  expect(history.world().statistics().pairs == now.size(), "the count of pairs is wrong");
}

/// The world lives on under the law, as does one that restores its snapshots.
template <int D, typename Real>
void check_life(WorldHistory<D, Real>& history, const SnapshotFields<D, Real>& fields, Bytes& bytes) {
  World<D, Real>& world = history.world();
  WorldModel<D, Real> model = model_of(fields);
  const bool keeps_pairs = model.options.keep_pairs;
  if (keeps_pairs) model.pairs.assign(world.pairs().begin(), world.pairs().end());
  history.adopt(model);
  for (std::size_t i = bytes.below(4); i > 0; --i) history.change();
  // What the predicate said before is the snapshot's to claim.
  if (fields.is_set(world::snapshot::has_predicate)) world.refilter();
  history.model().refilter();
  if (keeps_pairs)
    history.update();
  else
    check_unknown_pairs(history);
  for (int frame = 0; frame < 3; ++frame) {
    for (std::size_t i = bytes.below(6); i > 0; --i) history.change();
    history.update();
    history.check();
    history.look();
    static_cast<void>(history.twin(bytes));
  }
}

template <int D, typename Real>
void check(Bytes& bytes) {
  SnapshotFields<D, Real> fields = fields_of<D, Real>(any_snapshot<D, Real>(bytes));
  SnapshotMutator mutator(fields, bytes);
  const std::size_t mutations = bytes.below(5);
  for (std::size_t i = 0; i < mutations; ++i) mutator.mutate();
  const SnapshotBytes forged = sealed(fields);
  WorldHistory<D, Real> history(bytes, course_of<D, Real>(fields.is_set(world::snapshot::has_predicate)));
  for (std::size_t i = bytes.below(4); i > 0; --i) history.change();
  history.update();
  for (std::size_t i = bytes.below(4); i > 0; --i) history.change();
  const SnapshotBytes was = history.world().snapshot();
  try {
    history.world().restore(forged);
  } catch (const InvalidSnapshot& error) {
    expect(mutations > 0, error.what());
    expect(history.world().snapshot() == was, "a refused snapshot changed the world");
    history.update();
    return;
  }
  check_life(history, fields, bytes);
}

}  // namespace
}  // namespace broadside::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::fuzz::Bytes bytes({data, size});
  if (bytes.next() % 4 != 0)
    broadside::fuzz::check<2, float>(bytes);
  else
    broadside::fuzz::check<3, double>(bytes);
  return 0;
}
