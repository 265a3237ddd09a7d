// Boxes of doubles, followed by their floats.
#include "doubles/double_follower.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

#include "interface/candidate_tracker.hpp"

namespace broadside::algorithm {
namespace {

/// False candidates a box that cost about what rounding all boxes anew does.
constexpr double most_false_candidates = 32;

/// Writes the events among candidates, and counts the candidates that are false.
template <int D>
class Candidates final : public PairSink {
 public:
  Candidates(const Change<D, double>& change, PairSink& begun, PairSink& ended)
      : change_(change), begun_(begun), ended_(ended) {}

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
  }

  const Change<D, double>& change_;
  PairSink& begun_;
  PairSink& ended_;
  std::uint64_t count_ = 0;
  std::uint64_t false_count_ = 0;
};

}  // namespace

template <int D>
void DoubleFollower<D>::update_valid(const Change<D, double>& change, PairSink& begun, PairSink& ended) {
  const double most = most_false_candidates * static_cast<double>(change.now.size());
  const bool starts = change.rebuild || static_cast<double>(false_candidates_) > most;
  if (starts) start(change);
  before_.resize(change.now.size(), absent_box<D>());
  now_.resize(change.now.size(), absent_box<D>());
  for (const BoxId id : change.changed) now_[index(id)] = rounded(change.now[index(id)]);
  Candidates<D> candidates(change, begun, ended);
  Statistics statistics = floats_->candidate_tracker()->candidates(
      {.before = before_, .now = now_, .changed = change.changed, .flags = change.flags, .rebuild = starts},
      candidates);
  candidates.flush();
  statistics.hits = candidates.count();
  false_candidates_ += candidates.false_count();
  for (const BoxId id : change.changed) before_[index(id)] = now_[index(id)];
  this->count(statistics);
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
std::size_t DoubleFollower<D>::algorithm_bytes() const noexcept {
  std::size_t bytes = (before_.capacity() + now_.capacity()) * sizeof(Box<D>);
  for (const core::QuantileRounding& rounding : quantiles_) bytes += rounding.bytes();
  return bytes + floats_->bytes();
}

template class DoubleFollower<2>;
template class DoubleFollower<3>;

}  // namespace broadside::algorithm
