// Fuzzes restore() by meaning. The bytes say how a small world lives, and how the fields of its snapshot are
// then forged. A world refuses what it is given and is as before, or it restores it and is under the law from
// then on.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "history_bytes.hpp"
#include "snapshot_fields.hpp"
#include "snapshot_mutator.hpp"
#include "world_model.hpp"

namespace broadside::fuzz {
namespace {

/// Answers as is_liked(), or throws.
struct Predicate {
  bool* fails;

  bool operator()(Handle a, Handle b) const {
    if (*fails) throw std::runtime_error("the predicate fails");
    return is_liked(a, b);
  }
};

/// The snapshot of a world with a past, in the middle of a frame.
template <int D, typename Real>
SnapshotBytes any_snapshot(Bytes& bytes) {
  bool fails = false;
  const std::size_t kind = bytes.below(8);
  WorldOptions options;
  options.algorithm = kind % 4 == 3 ? "grid" : "brute_force";
  options.margin = kind % 2 == 0 ? 0 : 1;
  options.relative_margin = bytes.next() % 4 == 0 ? 0.5 : 0;
  if (kind % 2 == 1 && bytes.next() % 2 == 0) options.events = WorldEvents::enlarged;
  options.keep_pairs = bytes.next() % 4 != 0;
  World<D, Real> world(options);
  const bool has_predicate = kind / 2 % 2 == 1;
  if (has_predicate) world.set_predicate(Predicate{&fails});
  WorldModel<D, Real> model(has_predicate);
  const std::size_t frames = bytes.below(4);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    for (std::size_t i = bytes.below(12); i > 0; --i) model.change(world, bytes);
    fails = bytes.next() % 4 == 0;
    try {
      world.update();
    } catch (const std::runtime_error&) {
      // Its events wait.
    }
  }
  for (std::size_t i = bytes.below(6); i > 0; --i) model.change(world, bytes);
  return world.snapshot();
}

/// What the snapshot says of boxes, which a world that restores it must agree with.
template <int D, typename Real>
WorldModel<D, Real> model_of(const SnapshotFields<D, Real>& fields) {
  constexpr std::uint8_t live = 1;
  WorldModel<D, Real> model(fields.is_set(world::snapshot::has_predicate));
  for (std::uint32_t slot = 0; slot < fields.boxes.size(); ++slot) {
    const Filter filter = fields.filters.empty() ? Filter{} : fields.filters[slot];
    if (fields.states[slot] == live)
      model.set({{slot, fields.generations[slot]}, fields.boxes[slot], filter});
  }
  for (const Pair pair : fields.ignored) model.ignore(index(pair.first), index(pair.second));
  return model;
}

template <int D, typename Real>
void check_life(World<D, Real>& world, const SnapshotFields<D, Real>& fields, Bytes& bytes) {
  const bool keeps_pairs = fields.is_set(world::snapshot::keeps_pairs);
  const WorldEvents events =
      fields.is_set(world::snapshot::tells_enlarged) ? WorldEvents::enlarged : WorldEvents::exact;
  WorldModel<D, Real> model = model_of(fields);
  const SnapshotBytes taken = world.snapshot();
  World<D, Real> same;
  bool fails = false;
  if (fields.is_set(world::snapshot::has_predicate)) same.set_predicate(Predicate{&fails});
  same.restore(taken);
  expect(same.snapshot() == taken, "a snapshot of what was restored is another one");
  if (bytes.next() % 4 == 0) world.shrink_to_fit();
  for (std::size_t i = bytes.below(4); i > 0; --i) model.change(world, bytes);
  // What the predicate said before is the snapshot's to claim.
  if (fields.is_set(world::snapshot::has_predicate)) world.refilter();
  HandlePairs before;
  if (keeps_pairs) before.assign(world.pairs().begin(), world.pairs().end());
  HandlePairs now = model.check_update(world, keeps_pairs, keeps_pairs ? &before : nullptr, events);
  for (int frame = 0; frame < 3; ++frame) {
    for (std::size_t i = bytes.below(6); i > 0; --i) model.change(world, bytes);
    now = model.check_update(world, keeps_pairs, &now, events);
    same.restore(world.snapshot());
  }
}

template <int D, typename Real>
void check(Bytes& bytes) {
  SnapshotFields<D, Real> fields = fields_of<D, Real>(any_snapshot<D, Real>(bytes));
  SnapshotMutator mutator(fields, bytes);
  const std::size_t mutations = bytes.below(5);
  for (std::size_t i = 0; i < mutations; ++i) mutator.mutate();
  const SnapshotBytes forged = sealed(fields);
  bool fails = false;
  World<D, Real> world("brute_force");
  if (fields.is_set(world::snapshot::has_predicate)) world.set_predicate(Predicate{&fails});
  WorldModel<D, Real> model(fields.is_set(world::snapshot::has_predicate));
  for (std::size_t i = bytes.below(4); i > 0; --i) model.change(world, bytes);
  const HandlePairs nothing;
  const HandlePairs before = model.check_update(world, true, &nothing);
  for (std::size_t i = bytes.below(4); i > 0; --i) model.change(world, bytes);
  const SnapshotBytes was = world.snapshot();
  try {
    world.restore(forged);
  } catch (const InvalidSnapshot& error) {
    expect(mutations > 0, error.what());
    expect(world.snapshot() == was, "a refused snapshot changed the world");
    model.check_update(world, true, &before);
    return;
  }
  check_life(world, fields, bytes);
}

}  // namespace
}  // namespace broadside::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::fuzz::Bytes bytes(data, size);
  if (bytes.next() % 4 != 0)
    broadside::fuzz::check<2, float>(bytes);
  else
    broadside::fuzz::check<3, double>(bytes);
  return 0;
}
