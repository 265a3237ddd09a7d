// SlotColumn: a value for each slot of a world, which takes no memory until one is needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/grow.hpp"

namespace broadside::world {

/// Values by slot. Before use() every slot has T{} and the column takes no memory; afterwards it has a value
/// for each slot.
template <typename T>
class SlotColumn {
 public:
  bool is_used() const noexcept { return is_used_; }

  /// The values by slot; none before use().
  std::span<const T> values() const noexcept { return values_; }

  T get(std::uint32_t slot) const noexcept { return is_used_ ? values_[slot] : T{}; }

  void set(std::uint32_t slot, const T& value) noexcept {
    if (is_used_) values_[slot] = value;
  }

  /// Makes room for `added` slots beyond `slots`, and for use() if it `begins`, so that neither throws.
  void reserve(std::size_t slots, std::size_t added, bool begins) {
    if (begins || is_used_) core::make_room(values_, slots - values_.size() + added);
  }

  /// Begins to keep values, for `slots` slots.
  void use(std::size_t slots) {
    values_.resize(slots);
    is_used_ = true;
  }

  /// Appends a slot.
  void append() noexcept {
    if (is_used_) values_.emplace_back();
  }

  /// Drops the slots from `slots` on.
  void shorten(std::size_t slots) noexcept {
    if (is_used_) values_.resize(slots);
  }

  /// Takes the values of a snapshot.
  void restore(std::vector<T> values) noexcept {
    values_ = std::move(values);
    is_used_ = true;
  }

  void shrink_to_fit() { values_.shrink_to_fit(); }
  std::size_t bytes() const noexcept { return core::bytes_of(values_); }

 private:
  std::vector<T> values_;
  bool is_used_ = false;
};

}  // namespace broadside::world
