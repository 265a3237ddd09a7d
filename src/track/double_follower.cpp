// DoubleFollower.
#include "track/double_follower.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

namespace broadside::track {
namespace {

/// False candidates a box that cost about what rounding all boxes anew does.
constexpr std::uint64_t max_false_candidates = 32;

struct TooManyFalse {};

/// Writes the events among the candidates, and counts false candidates. Throws TooManyFalse if there are more
/// than `max_false`.
template <int D>
class Candidates final : public PairSink {
 public:
  Candidates(const Change<D, double>& change, std::uint64_t max_false, PairSink& begun, PairSink& ended)
      : change_(change), max_false_(max_false), begun_(begun), ended_(ended) {}

  std::uint64_t count() const noexcept { return count_; }
  std::uint64_t false_count() const noexcept { return false_count_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    count_ += pairs.size();
    for (const Pair pair : pairs) {
      change_.report(pair.first, pair.second, begun_, ended_);
      const bool was_near = overlap(change_.before[index(pair.first)], change_.before[index(pair.second)]);
      const bool is_near = overlap(change_.now[index(pair.first)], change_.now[index(pair.second)]);
      false_count_ += static_cast<std::uint64_t>(!was_near && !is_near);
    }
    if (false_count_ > max_false_) throw TooManyFalse();
  }

  const Change<D, double>& change_;
  std::uint64_t max_false_;
  PairSink& begun_;
  PairSink& ended_;
  std::uint64_t count_ = 0;
  std::uint64_t false_count_ = 0;
};

}  // namespace

/// Boxes that rounding makes equal cause false candidates. If there are too many, even in the middle of a
/// frame, all boxes are rounded anew. Events that were already written are harmless: an event may be written
/// more than once.
template <int D>
std::optional<Statistics> DoubleFollower<D>::follow(const Change<D, double>& change, PairSink& begun,
                                                    PairSink& ended) {
  const std::uint64_t max_false = max_false_candidates * change.now.size();
  if (!change.rebuild && false_candidates_ <= max_false) {
    try {
      return follow(change, false, max_false - false_candidates_, begun, ended);
    } catch (const TooManyFalse&) {
    }
  }
  start(change);
  return follow(change, true, std::numeric_limits<std::uint64_t>::max(), begun, ended);
}

/// Follows the boxes; throws TooManyFalse if there are more than `max_false` false candidates.
template <int D>
std::optional<Statistics> DoubleFollower<D>::follow(const Change<D, double>& change, bool starts,
                                                    std::uint64_t max_false, PairSink& begun,
                                                    PairSink& ended) {
  before_.resize(change.now.size(), absent_box<D>());
  now_.resize(change.now.size(), absent_box<D>());
  for (const BoxId id : change.changed) now_[index(id)] = rounded(change.now[index(id)]);
  Candidates<D> candidates(change, max_false, begun, ended);
  std::optional<Statistics> statistics = floats_->follow({.before = before_,
                                                          .now = now_,
                                                          .changed = change.changed,
                                                          .flags = change.flags,
                                                          .rebuild = starts,
                                                          .wants_candidates = true,
                                                          .workers = change.workers},
                                                         candidates, candidates);
  candidates.flush();
  if (statistics) statistics->hits = candidates.count();
  false_candidates_ += candidates.false_count();
  for (const BoxId id : change.changed) before_[index(id)] = now_[index(id)];
  return statistics;
}

/// Rounds all boxes of the frame before, by a rounding that suits this one.
template <int D>
void DoubleFollower<D>::start(const Change<D, double>& change) {
  false_candidates_ = 0;
  fit_ = core::fit_linear<D>(change.now);
  const std::uint64_t hash = core::hash_of<D>(change.now);
  by_quantiles_ = core::makes_false_pairs<D>(fit_, change.now, 0, hash);
  quantiles_ =
      by_quantiles_ ? core::fit_quantiles<D>(change.now, hash) : std::array<core::QuantileRounding, D>{};
  before_.resize(change.before.size());
  for (std::size_t i = 0; i < before_.size(); ++i) before_[i] = rounded(change.before[i]);
  now_ = before_;
}

template <int D>
Box<D> DoubleFollower<D>::rounded(const Box<D, double>& box) const {
  if (!is_present(box)) return absent_box<D>();
  if (by_quantiles_)
    return core::rounded(
        box, [&](int axis) -> const auto& { return quantiles_[axis]; });
  return core::rounded(
      box, [&](int axis) -> const auto& { return fit_[axis]; });
}

template <int D>
std::size_t DoubleFollower<D>::bytes() const noexcept {
  std::size_t bytes = (before_.capacity() + now_.capacity()) * sizeof(Box<D>);
  for (const core::QuantileRounding& rounding : quantiles_) bytes += rounding.bytes();
  return bytes + floats_->bytes();
}

template class DoubleFollower<2>;
template class DoubleFollower<3>;

}  // namespace broadside::track
