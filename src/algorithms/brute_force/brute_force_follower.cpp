// BruteForceFollower: each changed box against all others. Section VI-A of the paper.
//
// The Change has the paper's flag and previous state; this class keeps one copy of all boxes as a structure
// of arrays. It takes the changed boxes one after the other and updates a box's place after comparing it, so
// an event of two changed boxes shows at the second one's turn.
#include <algorithm>
#include <vector>

#include "algorithms/event_sinks.hpp"
#include "algorithms/followers.hpp"
#include "core/grow.hpp"
#include "kernels/find_changes.hpp"
#include "kernels/kept_run.hpp"

namespace broadside::algorithm {
namespace {

/// Boxes that are compared with all changed ones at a time, while they are in the L1 cache.
constexpr std::size_t boxes_at_once = 1024;

template <int D>
class BruteForceFollower final : public Follower<D> {
 public:
  std::optional<Statistics> follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    const std::size_t size = change.now.size();
    resize(size);
    if (change.rebuild) {
      for (std::size_t i = 0; i < size; ++i) set(i, change.before[i]);
    }
    moved_.clear();
    append_moved(change, change.changed, moved_);
    EventSinks<D> events(change, begun, ended);
    Checkpoint checkpoint(change.workers.checkpoint);
    const kernels::Run<D> run = kept_.view();
    for (std::size_t begin = 0; begin < size; begin += boxes_at_once) {
      const std::size_t end = std::min(begin + boxes_at_once, size);
      for (const core::MovedBox<D>& box : moved_) {
        kernels::find_changes(run, begin, end, box, events.sinks());
        checkpoint.count(end - begin);
        if (begin <= index(box.id) && index(box.id) < end) set(index(box.id), box.now);
      }
    }
    events.flush();
    return Statistics{
        .tests = std::uint64_t{moved_.size()} * size, .references = size, .hits = events.candidates()};
  }

  std::size_t bytes() const noexcept override {
    return core::bytes_of(kept_.min, kept_.max, kept_.id, moved_);
  }

 private:
  /// Makes the arrays as long as the frame; new places are absent.
  void resize(std::size_t size) {
    const std::size_t known = std::min(kept_.id.size(), size);
    kept_.resize(size);
    for (std::size_t i = known; i < kept_.id.size(); ++i) {
      kept_.id[i] = BoxId(i);
      set(i, absent_box<D>());
    }
  }

  void set(std::size_t place, const Box<D>& box) {
    kept_.set(place, is_present(box) ? box : core::nan_box<D>());
  }

  kernels::KeptRun<D> kept_;
  std::vector<core::MovedBox<D>> moved_;
};

}  // namespace

template <int D>
std::unique_ptr<Follower<D>> make_brute_force_follower(const Settings&) {
  return std::make_unique<BruteForceFollower<D>>();
}

template std::unique_ptr<Follower<2>> make_brute_force_follower(const Settings&);
template std::unique_ptr<Follower<3>> make_brute_force_follower(const Settings&);

}  // namespace broadside::algorithm
