// An index of boxes that runs out of memory: it finds nothing until an update ends, and then all again.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/index.hpp"

#include "injection.hpp"
#include "memory_case.hpp"

namespace broadside::laws {
namespace {

template <int D, typename Real>
std::vector<BoxId> overlapping(const BoxIndex<D, Real>& index, const Box<D, Real>& box) {
  std::vector<BoxId> found;
  index.overlapping(box, [&](BoxId id) { found.push_back(id); });
  std::ranges::sort(found);
  return found;
}

/// What is wrong with an index of boxes that change; empty if nothing is.
template <int D, typename Real>
std::string play(std::size_t max_boxes, std::uint64_t seed, Injector& injector) {
  Rng rng(seed);
  BoxIndex<D, Real> index;
  std::vector<Box<D, Real>> boxes;
  std::vector<Box<D, Real>> held;
  Box<D, Real> everywhere;
  everywhere.min.fill(-1);
  everywhere.max.fill(1e6F);
  for (int frame = 0; frame < 8; ++frame) {
    boxes.resize(rng.below(max_boxes + 1), absent_box<D, Real>());
    const std::vector<Box<D, Real>> others = lattice_boxes<D, Real>(boxes.size(), rng);
    std::vector<BoxId> changed;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!rng.one_in(frame % 2 == 0 ? 2 : 12)) continue;
      boxes[i] = others[i];
      changed.push_back(BoxId(i));
    }
    while (!injector.attempt([&] { index.update({boxes, changed}); })) {
      std::vector<Neighbour> near;
      index.nearest({}, 1, near);
      const bool is_empty = overlapping(index, everywhere).empty() && near.empty() &&
                            !index.first_hit(BoxCast<D, Real>{.box = everywhere, .direction = {}});
      if (!is_empty) return "an index that ran out of memory finds boxes";
    }
    for (const Box<D, Real>& box : others) {
      if (!is_present(box)) continue;
      std::vector<BoxId> expected;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (is_present(boxes[i]) && overlap(box, boxes[i])) expected.push_back(BoxId(i));
      }
      if (overlapping(index, box) != expected) return "not the boxes that overlap";
    }
  }
  return "";
}

template <int D, typename Real>
void check() {
  for (const FailureKind kind : {FailureKind::once, FailureKind::from_then_on}) {
    for (std::uint64_t k = 0, failures = 1; failures > 0; k = next_number(k)) {
      Injector injector(k, kind);
      ASSERT_EQ((play<D, Real>(60, 1, injector)), "") << "allocation " << k;
      failures = injector.failures();
    }
  }
  for (std::uint64_t seed = 0; seed < random_histories(); ++seed) {
    Injector injector(seed);
    ASSERT_EQ((play<D, Real>(seed % 4 == 0 ? 500 : 60, seed, injector)), "") << "seed " << seed;
  }
}

TEST(IndexFailure, FindsAllAgain2d) { check<2, float>(); }
TEST(IndexFailure, FindsAllAgain3d) { check<3, float>(); }
TEST(IndexFailure, FindsAllAgainOfDoubles2d) { check<2, double>(); }
TEST(IndexFailure, FindsAllAgainOfDoubles3d) { check<3, double>(); }

}  // namespace
}  // namespace broadside::laws
