// filters_of_keys(): filters that let boxes pair only if their keys are equal, or only if they differ.
// only_different() combines both, for two kinds of keys.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

namespace broadside {

/// Which boxes may pair by their keys. A key is, for example, an image, a class, a chromosome or a layer.
enum class KeyRule : std::uint8_t {
  same,      ///< only boxes with equal keys
  different  ///< only boxes with unequal keys
};

/// A key: an integer, an enumerator, or something that converts to a std::string_view. Floats are not keys,
/// since a NaN equals nothing.
template <typename Key>
concept BoxKey = std::integral<Key> || std::is_enum_v<Key> || std::convertible_to<Key, std::string_view>;

/// A range of keys, one for each box.
template <typename Keys>
concept KeyRange = std::ranges::input_range<const Keys> && BoxKey<std::ranges::range_value_t<Keys>>;

namespace detail {

/// Numbers keys from 1 on, in the order in which they first occur, with a hash table with linear probing
/// (Knuth, TAOCP 3, 6.4).
template <typename Key>
class KeyNumbers {
 public:
  std::int32_t number(const Key& key) {
    NumberedKey* slot = &slot_of(key);
    if (slot->number != 0) return slot->number;
    if (count_ == std::numeric_limits<std::int32_t>::max())
      throw InvalidFrame("2147483648 different keys; expected at most 2147483647");
    if (2 * (static_cast<std::size_t>(count_) + 1) > table_.size()) {
      grow();
      slot = &slot_of(key);
    }
    *slot = {key, ++count_};
    return count_;
  }

 private:
  struct NumberedKey {
    Key key{};
    std::int32_t number = 0;  // 0 if the slot is free
  };

  static std::size_t hash(const Key& key) noexcept {
    if constexpr (std::is_integral_v<Key> || std::is_enum_v<Key>)
      return static_cast<std::size_t>(mixed(static_cast<std::uint64_t>(key)));
    else
      return std::hash<Key>()(key);
  }

  /// The slot of the key, or the free one for it.
  NumberedKey& slot_of(const Key& key) {
    std::size_t at = hash(key) & (table_.size() - 1);
    while (table_[at].number != 0 && table_[at].key != key) at = (at + 1) & (table_.size() - 1);
    return table_[at];
  }

  void grow() {
    std::vector<NumberedKey> larger(4 * table_.size());
    table_.swap(larger);
    for (NumberedKey& old : larger) {
      if (old.number != 0) slot_of(old.key) = std::move(old);
    }
  }

  std::vector<NumberedKey> table_ = std::vector<NumberedKey>(64);  // its size is a power of two
  std::int32_t count_ = 0;
};

/// Makes filters with a group for each key, numbered in the order in which keys first occur.
template <typename Key>
class KeyFilters {
 public:
  explicit KeyFilters(KeyRule rule) : rule_(rule) {}

  template <typename Keys>
  std::vector<Filter> filters(const Keys& keys, std::span<const Filter> given) {
    std::vector<Filter> made;
    if constexpr (std::ranges::sized_range<const Keys>) made.reserve(std::ranges::size(keys));
    std::size_t count = 0;
    for (const auto& key : keys) {
      // Set in the vector: a copy would wait for what has just been written.
      if (given.empty())
        set_group(group(key), made.emplace_back());
      else if (count < given.size())
        set_group(group(key), made.emplace_back(given[count]));
      ++count;
    }
    if (!given.empty() && given.size() != count) {
      throw InvalidFrame(std::to_string(given.size()) + " filters for " + std::to_string(count) +
                         " keys; expected one for each key, or none");
    }
    return made;
  }

 private:
  /// Strings are stored as copies: a range may make each key anew.
  using Stored = std::conditional_t<std::is_integral_v<Key> || std::is_enum_v<Key>, Key, std::string>;

  std::int32_t group(const Key& key) {
    if constexpr (std::is_same_v<Stored, std::string>) {
      const std::string_view text = key;
      if (last_ != 0 && text == last_key_) return last_;  // equal keys often follow each other
      last_key_ = text;
    } else {
      if (last_ != 0 && key == last_key_) return last_;
      last_key_ = key;
    }
    return last_ = numbers_.number(last_key_);
  }

  void set_group(std::int32_t group, Filter& filter) const {
    if (filter.group != 0)
      throw InvalidFrame("a filter of group " + std::to_string(filter.group) +
                         " with keys, which take the place of groups; expected group 0");
    filter.group = rule_ == KeyRule::same ? group : -group;
    if (rule_ != KeyRule::same) return;
    if (filter.category != Filter{}.category || filter.mask != Filter{}.mask)
      throw InvalidFrame("a filter with a category or a mask, and KeyRule::same; expected one or the other");
    filter.category = 0;
    filter.mask = 0;
  }

  KeyRule rule_;
  KeyNumbers<Stored> numbers_;
  Stored last_key_{};
  std::int32_t last_ = 0;  // the group of last_key_; 0 before the first key
};

}  // namespace detail

/// Makes a filter for each box from its key. `filters`, one for each box or none, are applied as well: with
/// KeyRule::different, two boxes pair if their keys differ and `filters` accept each other. With
/// KeyRule::same, `filters` may only say which boxes are static.
///
/// Throws InvalidFrame, naming what is wrong, if `filters` has another length, has groups (keys take their
/// place) or, with KeyRule::same, has categories or masks.
///
///     find_pairs(boxes, {.filters = filters_of_keys(KeyRule::same, images)});
template <KeyRange Keys>
[[nodiscard]] std::vector<Filter> filters_of_keys(KeyRule rule, const Keys& keys,
                                                  std::span<const Filter> filters = {}) {
  return detail::KeyFilters<std::ranges::range_value_t<Keys>>(rule).filters(keys, filters);
}

/// The same for two sets: equal keys match across the sets.
template <KeyRange Left, KeyRange Right>
requires std::same_as<std::ranges::range_value_t<Left>, std::ranges::range_value_t<Right>>
[[nodiscard]] std::pair<std::vector<Filter>, std::vector<Filter>> filters_of_keys(
    KeyRule rule, const Left& left, const Right& right, std::span<const Filter> filters = {},
    std::span<const Filter> right_filters = {}) {
  detail::KeyFilters<std::ranges::range_value_t<Left>> of_both(rule);
  std::vector<Filter> left_made = of_both.filters(left, filters);
  return {std::move(left_made), of_both.filters(right, right_filters)};
}

/// A sink that passes a pair on to `target` if the keys of its boxes, left[pair.first] and
/// right[pair.second], differ. For pairs of one set, pass the same array twice. With filters of other keys it
/// finds, for example, pairs of different classes in the same image. The arrays and `target` must outlive
/// the sink.
///
///     PairCollector found(pairs);
///     auto different = only_different(classes, classes, found);
///     find_pairs(boxes, different, {.filters = filters_of_keys(KeyRule::same, images)});
template <typename Left, typename Right>
[[nodiscard]] auto only_different(const Left& left, const Right& right, PairSink& target) {
  return PairFunction([&left, &right, &target](std::span<const Pair> pairs) {
    while (!pairs.empty()) {
      const std::size_t count = pairs.size() < PairSink::max_room ? pairs.size() : PairSink::max_room;
      Pair* const out = target.room(count);
      std::size_t passed = 0;
      for (const Pair pair : pairs.first(count)) {
        out[passed] = pair;
        passed += left[index(pair.first)] != right[index(pair.second)] ? 1U : 0U;
      }
      target.commit(passed);
      pairs = pairs.subspan(count);
    }
    target.flush();  // because a search flushes only this sink
  });
}

}  // namespace broadside
