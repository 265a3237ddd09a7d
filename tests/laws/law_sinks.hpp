// Sinks for the equivalence tests: one that fails when it is full, and one that hashes the order of pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

namespace broadside::laws {

inline constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

struct SinkIsFull final : std::runtime_error {
  SinkIsFull() : std::runtime_error("the sink is full") {}
};

/// Collects up to `room` pairs, and throws at the next one.
class LimitedCollector final : public PairSink {
 public:
  explicit LimitedCollector(std::size_t room) : room_(room) {}

  const std::vector<Pair>& pairs() const { return pairs_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) {
      if (pairs_.size() == room_) throw SinkIsFull();
      pairs_.push_back(pair);
    }
  }

  std::size_t room_;
  std::vector<Pair> pairs_;
};

/// Hashes pairs as a sequence: another order gives another hash.
class OrderHasher final : public PairSink {
 public:
  std::uint64_t hash = 0;
  std::uint64_t count = 0;

 private:
  void consume(std::span<const Pair> pairs) override {
    for (const Pair pair : pairs) hash = hash * 0x9e3779b97f4a7c15U + broadside::hash(pair);
    count += pairs.size();
  }
};

}  // namespace broadside::laws
