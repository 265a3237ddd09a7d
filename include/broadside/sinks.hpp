// Ready-made sinks: pairs into a vector, into a function, counted, or hashed as a set.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "broadside/export.hpp"
#include "broadside/pair.hpp"

namespace broadside {

namespace detail {
/// Asks for large pages for memory that has not been written yet: a hint, which never fails.
BROADSIDE_PUBLIC void prefer_large_pages(void* begin, std::size_t bytes) noexcept;
}  // namespace detail

/// Appends every pair to the caller's vector, which must outlive the sink.
class BROADSIDE_CALLERS_VECTOR PairCollector final : public PairSink {
 public:
  explicit PairCollector(std::vector<Pair>& pairs) : pairs_(&pairs) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    if (pairs.size() > pairs_->capacity() - pairs_->size()) grow(pairs_->size() + pairs.size());
    pairs_->insert(pairs_->end(), pairs.data(), pairs.data() + pairs.size());
  }

  /// Doubles the vector's memory at least, and asks for large pages for it.
  void grow(std::size_t size) {
    std::vector<Pair> larger;
    larger.reserve(std::max(size, 2 * pairs_->capacity()));
    detail::prefer_large_pages(larger.data(), larger.capacity() * sizeof(Pair));
    larger.insert(larger.end(), pairs_->data(), pairs_->data() + pairs_->size());
    pairs_->swap(larger);
  }

  std::vector<Pair>* pairs_;
};

/// Counts pairs and keeps none. The count is complete once the search that fills the sink has returned.
class BROADSIDE_PUBLIC PairCounter final : public PairSink {
 public:
  std::uint64_t count() const noexcept { return count_; }

  std::unique_ptr<PairSink> empty_clone() const override { return std::make_unique<PairCounter>(); }
  void merge(PairSink& clone) override { count_ += static_cast<PairCounter&>(clone).count_; }

 private:
  void consume(std::span<const Pair> pairs) override { count_ += pairs.size(); }

  std::uint64_t count_ = 0;
};

/// Calls a function with each chunk of pairs, in the thread that called find().
class BROADSIDE_PUBLIC PairFunction final : public PairSink {
 public:
  explicit PairFunction(std::function<void(std::span<const Pair>)> function)
      : function_(std::move(function)) {}

 private:
  void consume(std::span<const Pair> pairs) override { function_(pairs); }

  std::function<void(std::span<const Pair>)> function_;
};

/// One pair's contribution to the hash of a set: the finaliser of MurmurHash3 over its key.
constexpr std::uint64_t hash(Pair pair) noexcept {
  std::uint64_t bits = key(pair) + 0x9e3779b97f4a7c15U;
  bits = (bits ^ bits >> 33) * 0xff51afd7ed558ccdU;
  bits = (bits ^ bits >> 33) * 0xc4ceb9fe1a85ec53U;
  return bits ^ bits >> 33;
}

/// Hashes and counts pairs as a set: the same for any order, different for a pair that is missing, extra or
/// repeated (but for a chance of 2^-64).
class BROADSIDE_PUBLIC PairHasher final : public PairSink {
 public:
  std::uint64_t hash() const noexcept { return hash_; }
  std::uint64_t count() const noexcept { return count_; }

  std::unique_ptr<PairSink> empty_clone() const override { return std::make_unique<PairHasher>(); }
  void merge(PairSink& clone) override {
    const auto& other = static_cast<const PairHasher&>(clone);
    hash_ += other.hash_;
    count_ += other.count_;
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) hash_ += broadside::hash(pair);
    count_ += pairs.size();
  }

  std::uint64_t hash_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace broadside
