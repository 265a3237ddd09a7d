// Brute force, frame after frame: each changed box against all others. Section VI-A of the paper.
//
// The paper's flag and previous state are in the Change; what is kept here is one copy of all boxes as a
// structure of arrays. Changed boxes are taken one after the other, and each one's place is brought up to
// date when it has been compared, so an event of two changed boxes shows when the second one is taken.
#include "algorithms/brute_force/tracker.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "interface/incremental_tracker.hpp"
#include "kernels/toggle.hpp"

namespace broadside::own {
namespace {

/// The fraction of changed boxes from which comparing all pairs is not slower: each is compared twice, and
/// pairs of changed boxes from both sides.
constexpr double worthwhile = 0.45;

/// So many boxes at once are compared with all that changed, while they are in the nearest cache.
constexpr std::size_t boxes_at_once = 1024;

template <int D>
class BruteForceTracker final : public core::IncrementalTracker<D> {
  using Base = core::IncrementalTracker<D>;

 public:
  BruteForceTracker(typename Base::Way way, std::unique_ptr<PairFinder<D>> finder)
      : Base(way, worthwhile, std::move(finder)) {}

 private:
  void follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    const std::size_t size = change.now.size();
    resize(size);
    if (change.rebuild) {
      for (std::size_t i = 0; i < size; ++i) set(i, change.before[i]);
    }
    for (std::size_t begin = 0; begin < size; begin += boxes_at_once) {
      const std::size_t end = std::min(begin + boxes_at_once, size);
      for (const BoxId id : change.changed) compare(change, id, begin, end, begun, ended);
    }
    this->count(Statistics{.tests = std::uint64_t{change.changed.size()} * size, .references = size});
  }

  void compare(const Change<D>& change, BoxId id, std::size_t begin, std::size_t end, PairSink& begun,
               PairSink& ended) {
    const std::size_t place = index(id);
    const bool refiltered = Base::is_refiltered(change, id);
    if (!refiltered && change.before[place] == change.now[place]) return;
    const kernels::Mover<D> mover =
        kernels::mover_of(change.before[place], change.now[place], id, refiltered);
    const std::size_t count = kernels::find_toggles(mover, run_, begin, end, toggles_.data());
    for (std::size_t i = 0; i < count; ++i)
      Base::report_toggle(change, id, toggles_[i].id, toggles_[i].overlaps, begun, ended);
    if (begin <= place && place < end) set(place, change.now[place]);
  }

  /// Makes the arrays as long as the frame; new places are absent.
  void resize(std::size_t size) {
    const std::size_t known = std::min(ids_.size(), size);
    for (int axis = 0; axis < D; ++axis) {
      min_[axis].resize(size + kernels::read_ahead);
      max_[axis].resize(size + kernels::read_ahead);
      run_.min[axis] = min_[axis].data();
      run_.max[axis] = max_[axis].data();
    }
    ids_.resize(size + kernels::read_ahead);
    for (std::size_t i = known; i < ids_.size(); ++i) {
      ids_[i] = BoxId(i);
      min_[0][i] = max_[0][i] = std::numeric_limits<float>::quiet_NaN();
    }
    run_.id = ids_.data();
    run_.size = size;
  }

  void set(std::size_t place, const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      min_[axis][place] = box.min[axis];
      max_[axis][place] = box.max[axis];
    }
    if (!is_present(box)) min_[0][place] = max_[0][place] = std::numeric_limits<float>::quiet_NaN();
  }

  std::size_t structure_bytes() const noexcept override {
    std::size_t bytes = ids_.capacity() * sizeof(BoxId);
    for (int axis = 0; axis < D; ++axis)
      bytes += (min_[axis].capacity() + max_[axis].capacity()) * sizeof(float);
    return bytes;
  }

  std::array<std::vector<float>, D> min_;
  std::array<std::vector<float>, D> max_;
  std::vector<BoxId> ids_;
  kernels::Run<D> run_{};
  std::array<kernels::Toggle, boxes_at_once> toggles_{};
};

}  // namespace

Tunable brute_force_update() {
  return {.name = "update",
          .summary = "for tracking only: compare what changed with all boxes, or all with all",
          .standard = "auto",
          .type = Tunable::Type::choice,
          .choices = {"changed", "all"}};
}

template <int D>
std::unique_ptr<PairTracker<D>> make_brute_force_tracker(const Settings& settings,
                                                         std::unique_ptr<PairFinder<D>> finder) {
  using Way = typename core::IncrementalTracker<D>::Way;
  const Way way = settings.is_auto("update")             ? Way::choose
                  : settings.text("update") == "changed" ? Way::follow
                                                         : Way::rebuild;
  return std::make_unique<BruteForceTracker<D>>(way, std::move(finder));
}

template std::unique_ptr<PairTracker<2>> make_brute_force_tracker(const Settings&,
                                                                  std::unique_ptr<PairFinder<2>>);
template std::unique_ptr<PairTracker<3>> make_brute_force_tracker(const Settings&,
                                                                  std::unique_ptr<PairFinder<3>>);

}  // namespace broadside::own
