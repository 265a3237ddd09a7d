// Sinks that collect pairs in a vector, pass them to a function, count them, or hash them as a set.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "broadside/export.hpp"
#include "broadside/pair.hpp"

namespace broadside {

namespace detail {
/// Asks the system for large pages for memory that has not been written yet. A hint; it never fails.
BROADSIDE_PUBLIC void prefer_large_pages(void* begin, std::size_t bytes) noexcept;
}  // namespace detail

/// Appends every pair to the caller's vector, which must outlive the sink.
class BROADSIDE_CALLERS_VECTOR PairCollector final : public PairSink {
 public:
  /// With the first pair, the vector gets a capacity of at least `expected`.
  explicit PairCollector(std::vector<Pair>& pairs, std::size_t expected = 0)
      : pairs_(&pairs), expected_(expected) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    if (pairs.size() > pairs_->capacity() - pairs_->size()) grow(pairs_->size() + pairs.size());
    pairs_->insert(pairs_->end(), pairs.data(), pairs.data() + pairs.size());
  }

  /// At least doubles the vector's capacity, and asks for large pages.
  void grow(std::size_t size) {
    std::vector<Pair> larger;
    const std::size_t doubled = 2 * pairs_->capacity();
    const std::size_t enough = size > doubled ? size : doubled;
    larger.reserve(enough > expected_ ? enough : expected_);
    detail::prefer_large_pages(larger.data(), larger.capacity() * sizeof(Pair));
    larger.insert(larger.end(), pairs_->data(), pairs_->data() + pairs_->size());
    pairs_->swap(larger);
  }

  std::vector<Pair>* pairs_;
  std::size_t expected_;
};

/// Counts pairs without storing them. The count is complete when the search has returned.
class BROADSIDE_PUBLIC PairCounter final : public PairSink {
 public:
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

  [[nodiscard]] std::unique_ptr<PairSink> empty_clone() const override {
    return std::make_unique<PairCounter>();
  }
  void merge(PairSink& clone) override { count_ += static_cast<PairCounter&>(clone).count_; }

 private:
  void consume(std::span<const Pair> pairs) override { count_ += pairs.size(); }

  std::uint64_t count_ = 0;
};

/// A function of a Pair or of a std::span<const Pair>. Its return value is ignored.
template <typename Function>
concept PairCallback = std::invocable<Function&, Pair> || std::invocable<Function&, std::span<const Pair>>;

/// A receiver of pairs: a PairSink or a function.
template <typename Target>
concept PairTarget = std::derived_from<std::remove_reference_t<Target>, PairSink> || PairCallback<Target>;

/// Calls a function with each pair, or with each chunk of pairs, in the thread that called find().
/// PairFunction<Function&> stores a reference to the caller's function. An exception from the function ends
/// the search and leaves find().
template <PairCallback Function>
class PairFunction final : public PairSink {
 public:
  explicit PairFunction(Function function) : function_(std::forward<Function>(function)) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    if constexpr (std::invocable<Function&, Pair>) {
      for (const Pair pair : pairs) static_cast<void>(function_(pair));
    } else {
      static_cast<void>(function_(pairs));
    }
  }

  Function function_;
};

namespace detail {
/// Calls body(sink) with a sink that passes its pairs to `target`.
template <PairTarget Target, typename Body>
void with_sink(Target& target, const Body& body) {
  if constexpr (std::derived_from<Target, PairSink>) {
    body(static_cast<PairSink&>(target));
  } else {
    PairFunction<Target&> sink(target);
    body(static_cast<PairSink&>(sink));
  }
}
}  // namespace detail

/// A pair's contribution to the hash of a set.
[[nodiscard]] constexpr std::uint64_t hash(Pair pair) noexcept {
  return detail::mixed(key(pair) + 0x9e3779b97f4a7c15U);
}

/// Hashes and counts pairs as a set. The hash is the same for any order, and differs if a pair is missing,
/// extra or repeated (except with probability 2^-64).
class BROADSIDE_PUBLIC PairHasher final : public PairSink {
 public:
  [[nodiscard]] std::uint64_t hash() const noexcept { return hash_; }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

  [[nodiscard]] std::unique_ptr<PairSink> empty_clone() const override {
    return std::make_unique<PairHasher>();
  }
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
