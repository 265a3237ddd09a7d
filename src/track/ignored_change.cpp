// IgnoredChange.
#include "track/ignored_change.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "core/sort_pairs.hpp"

namespace broadside::track {

void IgnoredChange::take(const IgnoredPairs* now, std::span<const Pair> listed, bool takes_all) {
  has_set_ = now != nullptr;
  newly_ = 0;
  toggled_.clear();
  const auto take_one = [&](Pair pair) {
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
    const bool is_ignored = now != nullptr && now->contains(pair);
    if (is_ignored != pairs_.contains(pair)) toggled_.push_back(pair);
  };
  if (takes_all || has_set_ != had_set_) {
    pairs_.for_each(take_one);
    if (now != nullptr) now->for_each(take_one);
  } else {
    for (const Pair pair : listed) take_one(pair);
  }
  core::sort_unique(toggled_, sorting_);
}

template <int D, typename Real>
void IgnoredChange::apply(const Change<D, Real>& change, std::vector<Pair>& begun,
                          std::vector<Pair>& ended) const {
  if (toggled_.empty() && pairs_.empty()) return;
  const auto is_dropped = [this](Pair pair) {
    return pairs_.contains(pair) || std::ranges::binary_search(toggled_, pair);
  };
  std::erase_if(begun, is_dropped);
  std::erase_if(ended, is_dropped);
  for (const Pair pair : toggled_) {
    if (index(pair.second) >= change.now.size()) continue;
    if (pairs_.contains(pair)) {
      if (change.holds(pair.first, pair.second)) begun.push_back(pair);
    } else {
      if (change.held(pair.first, pair.second)) ended.push_back(pair);
    }
  }
}

void IgnoredChange::insert() {
  const auto middle =
      std::partition(toggled_.begin(), toggled_.end(), [this](Pair pair) { return !pairs_.contains(pair); });
  newly_ = static_cast<std::size_t>(middle - toggled_.begin());
  for (const Pair pair : std::span(toggled_).first(newly_)) pairs_.insert(pair);
}

void IgnoredChange::undo_insert() noexcept {
  for (const Pair pair : std::span(toggled_).first(newly_)) pairs_.erase(pair);
}

void IgnoredChange::keep() noexcept {
  for (const Pair pair : std::span(toggled_).subspan(newly_)) pairs_.erase(pair);
  had_set_ = has_set_;
}

template void IgnoredChange::apply(const Change<2>&, std::vector<Pair>&, std::vector<Pair>&) const;
template void IgnoredChange::apply(const Change<3>&, std::vector<Pair>&, std::vector<Pair>&) const;
template void IgnoredChange::apply(const Change<2, double>&, std::vector<Pair>&, std::vector<Pair>&) const;
template void IgnoredChange::apply(const Change<3, double>&, std::vector<Pair>&, std::vector<Pair>&) const;

}  // namespace broadside::track
