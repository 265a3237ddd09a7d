// CurrentPairs: the pairs that hold now, and the events of the last update.
#include "world/current_pairs.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

#include "core/grow.hpp"

namespace broadside::world {
namespace {

/// Below this many events in the log, a pass over the array does not pay.
constexpr std::size_t short_log = 1024;

/// If there are fewer pairs for each event of an update, a pass over the array costs less than to log and
/// sort the events.
constexpr std::size_t pairs_per_event = 16;

/// Reads the keys of sorted pairs.
class KeyReader {
 public:
  static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();

  explicit KeyReader(std::span<const Pair> pairs) : pairs_(pairs) { advance(false); }

  /// Goes on to the next pair, or not.
  void advance(bool goes_on) {
    place_ += static_cast<std::size_t>(goes_on);
    next = place_ < pairs_.size() ? key(pairs_[place_]) : none;
  }

  std::uint64_t next;  ///< none behind the last pair

 private:
  std::span<const Pair> pairs_;
  std::size_t place_ = 0;
};

constexpr Pair pair_of(std::uint64_t its_key) noexcept {
  return {BoxId(its_key >> 32), BoxId(its_key & 0xffffffffU)};
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
  keys_ = std::move(other.keys_);
  log_ = std::move(other.log_);
  spare_ = std::move(other.spare_);
  scratch_ = std::move(other.scratch_);
  persisting_ = std::move(other.persisting_);
  handles_ = std::move(other.handles_);
  has_handles_ = other.has_handles_.load();
  has_persisting_ = other.has_persisting_.load();
  return *this;
}

void CurrentPairs::take(PairEvents& events, Generations generations,
                        const SlotColumn<std::uint64_t>& user_data) {
  const bool has_user_data = user_data.is_used();
  DeliveredEvents smaller;
  DeliveredEvents* next = &events_;
  if (watch_.wastes(events.begun.size() + events.ended.size(),
                    events_.begun.capacity() + events_.ended.capacity())) {
    next = &smaller;
    core::give_back(spare_, scratch_);
  }
  auto& [begun, ended, begun_data, ended_data] = *next;
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
  if (next == &smaller) events_ = std::move(smaller);
  has_persisting_ = false;
  events.clear();
}

/// Brings size_, the array and the log up to date, or throws and changes nothing.
void CurrentPairs::keep(const PairEvents& events) {
  const auto& [begun, ended] = events;
  const std::size_t count = begun.size() + ended.size();
  if (keeps_ && count > 0) {
    const bool are_many = count > keys_.size() / pairs_per_event;
    const std::size_t logged = log_.begun.size() + log_.ended.size();
    if (are_many || logged + count > std::max(short_log, keys_.size() / 2)) merge();
    if (are_many) {
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
      handles_.resize(keys_.size());
      for (std::size_t i = 0; i < keys_.size(); ++i) handles_[i] = handles_of(pair_of(keys_[i]), generations);
      has_handles_.store(true, std::memory_order_release);
    }
  }
  return handles_;
}

std::vector<Pair> CurrentPairs::slot_pairs() const {
  const std::lock_guard lock(reading_);
  merge();
  std::vector<Pair> pairs(keys_.size());
  std::transform(keys_.begin(), keys_.end(), pairs.begin(), pair_of);
  return pairs;
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
  apply(log_.begun, log_.ended);
  log_.clear();
}

/// Merges sorted events into the array, or throws and changes nothing. Copies eight pairs at a time and goes
/// on behind those that come before the next event, without branches: no predictor could foresee where that
/// is.
void CurrentPairs::apply(std::span<const Pair> begun, std::span<const Pair> ended) const {
  constexpr std::ptrdiff_t at_once = 8;
  const std::size_t needed = keys_.size() + begun.size() + at_once + 1;
  if (spare_.size() < needed) core::resize_by_eighths(spare_, needed);
  const std::uint64_t* held = keys_.data();
  const std::uint64_t* const held_end = held + keys_.size();
  KeyReader fresh(begun);
  KeyReader gone(ended);
  std::uint64_t* out = spare_.data();
  while (held_end - held >= at_once && std::min(fresh.next, gone.next) != KeyReader::none) {
    const std::uint64_t next = std::min(fresh.next, gone.next);
    std::ptrdiff_t count = 0;
    for (std::ptrdiff_t i = 0; i < at_once; ++i) count += static_cast<std::ptrdiff_t>(held[i] < next);
    std::memcpy(out, held, at_once * sizeof(*held));
    out[count] = next;  // overwritten if it does not begin here
    const bool begins = count < at_once && fresh.next < gone.next;
    const bool ends = count < at_once && gone.next < fresh.next;
    held += count + static_cast<std::ptrdiff_t>(ends);
    out += count + static_cast<std::ptrdiff_t>(begins);
    fresh.advance(begins);
    gone.advance(ends);
  }
  if (std::min(fresh.next, gone.next) == KeyReader::none) {
    out = std::copy(held, held_end, out);
    held = held_end;
  }
  while (held != held_end || fresh.next != KeyReader::none) {
    const std::uint64_t next = held != held_end ? *held : KeyReader::none;
    const bool begins = fresh.next < next;
    const bool ends = !begins && gone.next == next;
    *out = std::min(fresh.next, next);
    out += static_cast<std::ptrdiff_t>(!ends);
    held += static_cast<std::ptrdiff_t>(!begins);
    fresh.advance(begins);
    gone.advance(ends);
  }
  spare_.resize(static_cast<std::size_t>(out - spare_.data()));
  keys_.swap(spare_);
}

void CurrentPairs::shrink_to_fit() {
  merge();
  core::give_back(scratch_, spare_, handles_, persisting_);
  has_handles_ = keys_.empty();
  has_persisting_ = false;
  log_.shrink_to_fit();
  core::shrink(keys_, events_.begun, events_.ended, events_.begun_data, events_.ended_data);
}

std::size_t CurrentPairs::bytes() const {
  const std::lock_guard lock(reading_);
  return log_.bytes() + core::bytes_of(keys_, spare_, scratch_, handles_, persisting_, events_.begun,
                                       events_.ended, events_.begun_data, events_.ended_data);
}

void CurrentPairs::restore(std::span<const Pair> pairs, std::size_t size, const PairEvents& events,
                           Generations generations) {
  const auto handles_of_all = [generations](std::span<const Pair> all) {
    std::vector<HandlePair> handles;
    handles.reserve(all.size());
    for (const Pair pair : all) handles.push_back(handles_of(pair, generations));
    return handles;
  };
  keys_.resize(pairs.size());
  std::transform(pairs.begin(), pairs.end(), keys_.begin(), key);
  size_ = size;
  events_ = {handles_of_all(events.begun), handles_of_all(events.ended)};
  log_.clear();
  has_handles_ = false;
  has_persisting_ = false;
}

}  // namespace broadside::world
