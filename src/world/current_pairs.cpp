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

/// A merge searches for places if the array has this many pairs for each event of the log, or more. Else it
/// visits every pair.
constexpr std::size_t part_for_galloping = 8;

/// Merges two sorted ranges without branches: no predictor could foresee which comes next.
void merge_events(std::span<const Pair> begun, std::span<const Pair> ended, Pair* out) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < begun.size() && j < ended.size()) {
    const bool ends = key(ended[j]) < key(begun[i]);
    *out++ = *(ends ? &ended[j] : &begun[i]);
    i += static_cast<std::size_t>(!ends);
    j += static_cast<std::size_t>(ends);
  }
  std::copy(ended.begin() + static_cast<std::ptrdiff_t>(j), ended.end(),
            std::copy(begun.begin() + static_cast<std::ptrdiff_t>(i), begun.end(), out));
}

constexpr auto has_slots_before = [](const HandlePair& a, Pair b) { return slots_of(a) < b; };

/// The first place in [from, to) that is not before `pair`: a galloping search, since it is mostly near
/// `from`.
const HandlePair* first_not_before(const HandlePair* from, const HandlePair* to, Pair pair) {
  std::ptrdiff_t step = 1;
  const HandlePair* low = from;
  while (step < to - low && slots_of(low[step]) < pair) {
    low += step;
    step *= 2;
  }
  const HandlePair* const high = step < to - low ? low + step : to;
  return std::lower_bound(low, high, pair, has_slots_before);
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
  is_merged_ = other.is_merged_.load();
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
  log(events, generations);
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

/// Brings size_ and the log up to date, or throws and changes nothing.
void CurrentPairs::log(const PairEvents& events, Generations generations) {
  const std::size_t count = events.begun.size() + events.ended.size();
  const std::size_t old_log = log_.size();
  const std::size_t old_size = std::exchange(size_, size_ + events.begun.size() - events.ended.size());
  if (!keeps_ || count == 0) return;
  try {
    core::make_room(log_, count);
    log_.resize(old_log + count);
    merge_events(events.begun, events.ended, log_.data() + old_log);
    if (log_.size() > std::max(short_log, pairs_.size() / 2)) merge(generations);
  } catch (...) {
    log_.resize(old_log);
    size_ = old_size;
    throw;
  }
  is_merged_ = log_.empty();
}

std::span<const HandlePair> CurrentPairs::pairs(Generations generations) const {
  if (!is_merged_.load(std::memory_order_acquire)) {
    const std::lock_guard lock(reading_);
    merge(generations);
    is_merged_.store(true, std::memory_order_release);
  }
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

void CurrentPairs::merge(Generations generations) const {
  if (log_.empty()) return;
  // Everything that can throw comes first; of that, sorting comes last, since it mixes old and new events.
  const bool is_long = log_.size() > pairs_.size() / part_for_galloping;
  const std::size_t needed = is_long ? pairs_.size() + log_.size() : size_;
  if (pairs_.capacity() < needed) pairs_.reserve(std::max(needed, pairs_.capacity() + pairs_.capacity() / 2));
  if (!std::is_sorted(log_.begin(), log_.end())) sort_pairs(log_, scratch_);
  const std::size_t toggled = keep_toggled(generations);
  if (is_long)
    toggle(toggled, generations);
  else
    insert_begun(drop_ended(toggled), generations);
  log_.clear();
}

/// Moves the pairs that the log has an odd number of times to its front, each once; returns how many. Gives
/// pairs that ended and began again their current handles, since slots may have been reused.
std::size_t CurrentPairs::keep_toggled(Generations generations) const {
  std::size_t toggled = 0;
  for (std::size_t i = 0; i < log_.size();) {
    const Pair pair = log_[i];
    const std::size_t first = i;
    while (i < log_.size() && log_[i] == pair) ++i;
    if ((i - first) % 2 != 0) {
      log_[toggled++] = pair;
      continue;
    }
    const auto place = std::lower_bound(pairs_.begin(), pairs_.end(), pair, has_slots_before);
    if (place != pairs_.end() && slots_of(*place) == pair) *place = handles_of(pair, generations);
  }
  return toggled;
}

/// Removes each of the first `count` pairs of the log from the array, or inserts it if it is not there: from
/// the end on, without branches, as in merge_events(). There is room for all.
void CurrentPairs::toggle(std::size_t count, Generations generations) const {
  std::size_t left = pairs_.size();
  pairs_.resize(left + count);
  HandlePair* const begin = pairs_.data();
  HandlePair* const end = begin + pairs_.size();
  HandlePair* out = end;  // at least `count` places above the pairs that are left
  while (left > 0 && count > 0) {
    const HandlePair toggled = handles_of(log_[count - 1], generations);
    const HandlePair& held = begin[left - 1];
    const std::uint64_t of_held = key(slots_of(held));
    const std::uint64_t of_toggled = key(log_[count - 1]);
    out[-1] = *(of_held > of_toggled ? &held : &toggled);
    out -= static_cast<std::ptrdiff_t>(of_held != of_toggled);
    left -= static_cast<std::size_t>(of_held >= of_toggled);
    count -= static_cast<std::size_t>(of_toggled >= of_held);
  }
  while (count > 0) *--out = handles_of(log_[--count], generations);
  const HandlePair* const last = std::copy(out, end, begin + left);
  pairs_.resize(static_cast<std::size_t>(last - begin));
}

/// Removes each of the first `count` pairs of the log from the array if it is there. Moves the other pairs,
/// which have begun, to the front of the log; returns how many there are.
std::size_t CurrentPairs::drop_ended(std::size_t count) const {
  HandlePair* const begin = pairs_.data();
  const HandlePair* const end = begin + pairs_.size();
  const HandlePair* read = begin;
  HandlePair* write = begin;
  const auto keep_up_to = [&](const HandlePair* to) {
    if (write == read)
      write += to - read;
    else
      write = std::copy(read, to, write);
    read = to;
  };
  std::size_t begun = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (read != end) keep_up_to(first_not_before(read, end, log_[i]));
    if (read != end && slots_of(*read) == log_[i])
      ++read;
    else
      log_[begun++] = log_[i];
  }
  keep_up_to(end);
  pairs_.resize(static_cast<std::size_t>(write - begin));
  return begun;
}

/// Inserts the first `count` pairs of the log into the array, from the end on. There is room for them.
void CurrentPairs::insert_begun(std::size_t count, Generations generations) const {
  std::size_t left = pairs_.size();
  pairs_.resize(left + count);
  HandlePair* out = pairs_.data() + pairs_.size();
  while (count > 0) {
    const Pair pair = log_[--count];
    // Gallops from the back, since the place is near it.
    std::size_t step = 1;
    std::size_t high = left;
    while (step <= high && pair < slots_of(pairs_[high - step])) {
      high -= step;
      step *= 2;
    }
    const std::size_t low = step <= high ? high - step : 0;
    const auto place =
        std::lower_bound(pairs_.begin() + static_cast<std::ptrdiff_t>(low),
                         pairs_.begin() + static_cast<std::ptrdiff_t>(high), pair, has_slots_before);
    const auto kept = static_cast<std::size_t>(place - pairs_.begin());
    out = std::copy_backward(pairs_.data() + kept, pairs_.data() + left, out);
    left = kept;
    *--out = handles_of(pair, generations);
  }
}

void CurrentPairs::shrink_to_fit(Generations generations) {
  merge(generations);
  is_merged_ = true;
  scratch_.clear();
  persisting_.clear();
  has_persisting_ = false;
  core::shrink(pairs_, log_, scratch_, persisting_, events_.begun, events_.ended, events_.begun_data,
               events_.ended_data);
}

std::size_t CurrentPairs::bytes() const {
  const std::lock_guard lock(reading_);
  return core::bytes_of(pairs_, log_, scratch_, persisting_, events_.begun, events_.ended, events_.begun_data,
                        events_.ended_data);
}

void CurrentPairs::restore(std::span<const Pair> pairs, std::size_t size, const PairEvents& events,
                           Generations generations) {
  const auto handles_of_all = [generations](std::span<const Pair> all) {
    std::vector<HandlePair> handles;
    handles.reserve(all.size());
    for (const Pair pair : all) handles.push_back(handles_of(pair, generations));
    return handles;
  };
  pairs_ = handles_of_all(pairs);
  size_ = size;
  events_ = {handles_of_all(events.begun), handles_of_all(events.ended)};
  log_.clear();
  is_merged_ = true;
  has_persisting_ = false;
}

}  // namespace broadside::world
