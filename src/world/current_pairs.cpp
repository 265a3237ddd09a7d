// CurrentPairs: the pairs that hold now, and the events of the last update.
#include "world/current_pairs.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "core/grow.hpp"

namespace broadside::world {
namespace {

/// Below this many events in the log, a pass over the array does not pay.
constexpr std::size_t short_log = 1024;

/// If there are this many pairs for each event, or more, it pays to search for the events' places in the
/// array. Else it pays to visit every pair.
constexpr std::size_t pairs_per_event = 8;

/// The first place in [from, to) that is not before `pair`: a galloping search, since it is mostly near
/// `from`.
const Pair* first_not_before(const Pair* from, const Pair* to, Pair pair) noexcept {
  std::ptrdiff_t step = 1;
  const Pair* low = from;
  while (step < to - low && low[step] < pair) {
    low += step;
    step *= 2;
  }
  const Pair* const high = step < to - low ? low + step : to;
  return std::lower_bound(low, high, pair);
}

/// Sorts both lists and removes what is in both, as often as it is. If it throws, only the order has changed.
void make_net(PairEvents& events, std::vector<Pair>& scratch) {
  sort_pairs(events.begun, scratch);
  sort_pairs(events.ended, scratch);
  auto [begun, begun_end] = std::pair(events.begun.begin(), events.begun.end());
  auto [ended, ended_end] = std::pair(events.ended.begin(), events.ended.end());
  auto net_begun = begun;
  auto net_ended = ended;
  while (begun != begun_end && ended != ended_end) {
    if (*begun < *ended) {
      *net_begun++ = *begun++;
    } else if (*ended < *begun) {
      *net_ended++ = *ended++;
    } else {
      ++begun;
      ++ended;
    }
  }
  events.begun.erase(std::copy(begun, begun_end, net_begun), begun_end);
  events.ended.erase(std::copy(ended, ended_end, net_ended), ended_end);
}

}  // namespace

CurrentPairs& CurrentPairs::operator=(CurrentPairs&& other) noexcept {
  keeps_ = other.keeps_;
  size_ = other.size_;
  events_ = std::move(other.events_);
  pairs_ = std::move(other.pairs_);
  log_ = std::move(other.log_);
  scratch_ = std::move(other.scratch_);
  persisting_ = std::move(other.persisting_);
  handles_ = std::move(other.handles_);
  has_handles_ = other.has_handles_.load();
  has_persisting_ = other.has_persisting_.load();
  return *this;
}

void CurrentPairs::take(PairEvents& events, Generations generations,
                        const SlotColumn<std::uint64_t>& user_data) {
  auto& [begun, ended, begun_data, ended_data] = events_;
  const bool has_user_data = user_data.is_used();
  begun.reserve(events.begun.size());
  ended.reserve(events.ended.size());
  if (has_user_data) {
    begun_data.reserve(events.begun.size());
    ended_data.reserve(events.ended.size());
  }
  keep(events);
  // Nothing below throws.
  const auto replace = [&](std::vector<HandlePair>& handles, std::vector<UserDataPair>& data,
                           std::span<const Pair> pairs) {
    handles.resize(pairs.size());
    data.resize(has_user_data ? pairs.size() : 0);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Pair pair = pairs[i];
      handles[i] = handles_of(pair, generations);
      if (has_user_data) data[i] = {user_data.get(index(pair.first)), user_data.get(index(pair.second))};
    }
  };
  replace(begun, begun_data, events.begun);
  replace(ended, ended_data, events.ended);
  has_persisting_ = false;
  events.clear();
}

/// Brings size_, the array and the log up to date, or throws and changes nothing.
void CurrentPairs::keep(const PairEvents& events) {
  const auto& [begun, ended] = events;
  const std::size_t count = begun.size() + ended.size();
  if (keeps_ && count > 0) {
    const bool are_many = count > pairs_.size() / pairs_per_event;
    const std::size_t logged = log_.begun.size() + log_.ended.size();
    if (are_many || logged + count > std::max(short_log, pairs_.size() / 2)) merge();
    if (are_many) {
      core::make_room(pairs_, begun.size());
      apply(begun, ended);
    } else {
      core::make_room(log_.begun, begun.size());
      core::make_room(log_.ended, ended.size());
      log_.begun.insert(log_.begun.end(), begun.begin(), begun.end());
      log_.ended.insert(log_.ended.end(), ended.begin(), ended.end());
    }
    has_handles_ = false;
  }
  size_ += begun.size() - ended.size();
}

std::span<const HandlePair> CurrentPairs::pairs(Generations generations) const {
  if (!has_handles_.load(std::memory_order_acquire)) {
    const std::lock_guard lock(reading_);
    if (!has_handles_.load(std::memory_order_relaxed)) {
      merge();
      handles_.resize(pairs_.size());
      for (std::size_t i = 0; i < pairs_.size(); ++i) handles_[i] = handles_of(pairs_[i], generations);
      has_handles_.store(true, std::memory_order_release);
    }
  }
  return handles_;
}

std::span<const Pair> CurrentPairs::slot_pairs() const {
  const std::lock_guard lock(reading_);
  merge();
  return pairs_;
}

std::span<const HandlePair> CurrentPairs::persisting(Generations generations) const {
  const std::span<const HandlePair> current = pairs(generations);
  if (events_.begun.empty()) return current;
  if (!has_persisting_.load(std::memory_order_acquire)) {
    const std::lock_guard lock(reading_);
    if (!has_persisting_.load(std::memory_order_relaxed)) {
      persisting_.clear();
      persisting_.reserve(current.size());
      std::set_difference(current.begin(), current.end(), events_.begun.begin(), events_.begun.end(),
                          std::back_inserter(persisting_));
      has_persisting_.store(true, std::memory_order_release);
    }
  }
  return persisting_;
}

/// Takes the log into the array.
void CurrentPairs::merge() const {
  if (log_.empty()) return;
  make_net(log_, scratch_);
  core::make_room(pairs_, log_.begun.size());
  apply(log_.begun, log_.ended);
  log_.clear();
}

/// Applies sorted events to the array, in which there is room.
void CurrentPairs::apply(std::span<const Pair> begun, std::span<const Pair> ended) const noexcept {
  if (begun.size() + ended.size() > pairs_.size() / pairs_per_event) return apply_many(begun, ended);
  drop(ended);
  insert(begun);
}

/// Merges from the end on, without branches: no predictor could foresee which pair comes next.
void CurrentPairs::apply_many(std::span<const Pair> begun, std::span<const Pair> ended) const noexcept {
  std::size_t left = pairs_.size();
  std::size_t fresh = begun.size();
  std::size_t gone = ended.size();
  pairs_.resize(left + fresh);
  Pair* const begin = pairs_.data();
  Pair* const end = begin + pairs_.size();
  Pair* out = end;  // at least `fresh` places above the pairs that are left
  while (left > 0) {
    const Pair held = begin[left - 1];
    const Pair other = fresh > 0 ? begun[fresh - 1] : Pair{};  // Pair{} is before every pair
    const bool is_fresh = key(held) < key(other);
    const bool is_gone = !is_fresh && gone > 0 && ended[gone - 1] == held;
    out[-1] = is_fresh ? other : held;
    out -= static_cast<std::ptrdiff_t>(!is_gone);
    left -= static_cast<std::size_t>(!is_fresh);
    fresh -= static_cast<std::size_t>(is_fresh);
    gone -= static_cast<std::size_t>(is_gone);
  }
  while (fresh > 0) *--out = begun[--fresh];
  const Pair* const last = std::copy(out, end, begin);
  pairs_.resize(static_cast<std::size_t>(last - begin));
}

void CurrentPairs::drop(std::span<const Pair> ended) const noexcept {
  Pair* const begin = pairs_.data();
  const Pair* const end = begin + pairs_.size();
  const Pair* read = begin;
  Pair* write = begin;
  const auto keep_up_to = [&](const Pair* to) {
    write = write == read ? write + (to - read) : std::copy(read, to, write);
    read = to;
  };
  for (const Pair pair : ended) {
    keep_up_to(first_not_before(read, end, pair));
    read += static_cast<std::ptrdiff_t>(read != end && *read == pair);
  }
  keep_up_to(end);
  pairs_.resize(static_cast<std::size_t>(write - begin));
}

/// Inserts from the end on.
void CurrentPairs::insert(std::span<const Pair> begun) const noexcept {
  std::size_t left = pairs_.size();
  pairs_.resize(left + begun.size());
  Pair* const begin = pairs_.data();
  Pair* out = begin + pairs_.size();
  for (std::size_t i = begun.size(); i-- > 0;) {
    const Pair pair = begun[i];
    // Gallops from the back, since the place is near it.
    std::size_t step = 1;
    std::size_t high = left;
    while (step <= high && pair < begin[high - step]) {
      high -= step;
      step *= 2;
    }
    const std::size_t low = step <= high ? high - step : 0;
    const auto place = std::lower_bound(begin + low, begin + high, pair);
    const auto kept = static_cast<std::size_t>(place - begin);
    out = std::copy_backward(begin + kept, begin + left, out);
    left = kept;
    *--out = pair;
  }
}

void CurrentPairs::shrink_to_fit() {
  merge();
  core::give_back(scratch_, handles_, persisting_);
  has_handles_ = pairs_.empty();
  has_persisting_ = false;
  log_.shrink_to_fit();
  core::shrink(pairs_, events_.begun, events_.ended, events_.begun_data, events_.ended_data);
}

std::size_t CurrentPairs::bytes() const {
  const std::lock_guard lock(reading_);
  return log_.bytes() + core::bytes_of(pairs_, scratch_, handles_, persisting_, events_.begun, events_.ended,
                                       events_.begun_data, events_.ended_data);
}

void CurrentPairs::restore(std::span<const Pair> pairs, std::size_t size, const PairEvents& events,
                           Generations generations) {
  const auto handles_of_all = [generations](std::span<const Pair> all) {
    std::vector<HandlePair> handles;
    handles.reserve(all.size());
    for (const Pair pair : all) handles.push_back(handles_of(pair, generations));
    return handles;
  };
  pairs_.assign(pairs.begin(), pairs.end());
  size_ = size;
  events_ = {handles_of_all(events.begun), handles_of_all(events.ended)};
  log_.clear();
  has_handles_ = false;
  has_persisting_ = false;
}

}  // namespace broadside::world
