// IgnoredPairs, over its hash table.
#include <memory>
#include <utility>

#include "broadside/filter.hpp"

#include "core/pair_set.hpp"

namespace broadside {

IgnoredPairs::IgnoredPairs() noexcept = default;
IgnoredPairs::IgnoredPairs(const IgnoredPairs& other)
    : set_(other.set_ == nullptr ? nullptr : std::make_unique<core::PairSet>(*other.set_)) {}
IgnoredPairs::IgnoredPairs(IgnoredPairs&& other) noexcept = default;
IgnoredPairs& IgnoredPairs::operator=(IgnoredPairs other) noexcept {
  set_ = std::move(other.set_);
  return *this;
}
IgnoredPairs::~IgnoredPairs() = default;

bool IgnoredPairs::insert(Pair pair) {
  if (pair.first == pair.second) return false;
  if (set_ == nullptr) set_ = std::make_unique<core::PairSet>();
  return set_->insert(pair);
}

bool IgnoredPairs::erase(Pair pair) noexcept { return set_ != nullptr && set_->erase(pair); }

bool IgnoredPairs::contains(Pair pair) const noexcept { return set_ != nullptr && set_->contains(pair); }

std::size_t IgnoredPairs::size() const noexcept { return set_ == nullptr ? 0 : set_->size(); }

void IgnoredPairs::clear() noexcept { set_.reset(); }

std::size_t IgnoredPairs::bytes() const noexcept { return set_ == nullptr ? 0 : set_->bytes(); }

std::span<const std::uint64_t> IgnoredPairs::keys() const noexcept {
  return set_ == nullptr ? std::span<const std::uint64_t>() : set_->keys();
}

}  // namespace broadside
