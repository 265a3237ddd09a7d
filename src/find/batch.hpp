// BatchSearch searches many worlds, whose boxes lie in one array, one world at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"
#include "broadside/spec.hpp"

#include "core/parallel.hpp"
#include "find/search.hpp"

namespace broadside::find {

/// Throws InvalidFrame unless the offsets begin with 0, never descend and end with the number of boxes.
void check_offsets(std::span<const std::size_t> offsets, std::size_t boxes);

/// Makes offsets of counts: the first is 0, and each of the others the sum of the counts up to its own.
void sum_up(std::span<std::size_t> offsets);

/// Passes pairs on and counts them. It is no FilterSink, so a search by several threads cannot bypass it.
class CountingSink final : public PairSink {
 public:
  explicit CountingSink(PairSink& target) : target_(&target) {}

  /// The number of pairs since the last call.
  std::size_t take_count() {
    flush();
    return std::exchange(count_, 0);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    count_ += pairs.size();
    target_->put(pairs);
  }

  PairSink* target_;
  std::size_t count_ = 0;
};

/// Writes the pairs of worlds [begin, end) to `pairs`, and how many each has to `counts`: write(world,
/// worker, sink) writes those of one. Several threads share the worlds.
template <typename Write>
void write_worlds(core::Parallel& parallel, std::size_t begin, std::size_t end, PairSink& pairs,
                  std::span<std::size_t> counts, const Write& write) {
  parallel.search(end - begin, pairs, [&](core::Range some, std::size_t worker, PairSink& sink) {
    CountingSink counting(sink);
    for (std::size_t world = begin + some.begin; world < begin + some.end; ++world) {
      write(world, worker, counting);
      counts[world] = counting.take_count();
    }
    return Statistics{};
  });
}

/// Keeps its memory from call to call.
template <int D, typename Real>
class BatchSearch {
 public:
  /// Throws InvalidSpec.
  explicit BatchSearch(const Spec& spec);

  /// The number of threads that the spec asks for.
  std::size_t threads() const noexcept { return threads_; }

  /// Checks the boxes of worlds with valid offsets, and returns how many are not present. Throws
  /// InvalidInput unless bad boxes are quarantined. Its message also names the world.
  static std::size_t check(std::span<const Box<D, Real>> boxes, std::span<const std::size_t> offsets,
                           const Workers& workers, BadInput bad_input);

  /// Writes the pairs of all worlds to `pairs`, and how many each has to `counts`. `absent` is the number of
  /// boxes that are not present.
  void find(std::span<const Box<D, Real>> boxes, std::span<const std::size_t> offsets, const Workers& workers,
            const PairFilters& filters, std::size_t absent, PairSink& pairs, std::span<std::size_t> counts);

 private:
  const Algorithm* algorithm_;
  Settings settings_;
  std::size_t threads_;
  core::Parallel parallel_;
  std::vector<std::unique_ptr<Search<D, Real>>> searches_;  // by worker; null until it has a world
};

}  // namespace broadside::find
