// The radix sort alone, beside std::sort, from 1,000 to 10,000,000 keys: sort [--benchmark_filter=...].
//
// Each time includes writing the keys, because each sort needs them anew.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/radix_sort.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::bench {
namespace {

std::vector<float> numbers(std::int64_t count) {
  lab::Random random(1);
  std::vector<float> values(static_cast<std::size_t>(count));
  for (float& value : values) value = static_cast<float>(random.between(0, 1));
  return values;
}

void write(std::span<const float> values, std::span<core::KeyedPlace> places) {
  for (std::uint32_t i = 0; i < values.size(); ++i) places[i] = {core::sort_key(values[i]), i};
}

void radix_sort(benchmark::State& state) {
  const std::vector<float> values = numbers(state.range(0));
  core::RadixSort sort;
  for (auto _ : state) {
    write(values, sort.places(values.size()));
    benchmark::DoNotOptimize(sort.sort().data());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void std_sort(benchmark::State& state) {
  const std::vector<float> values = numbers(state.range(0));
  std::vector<core::KeyedPlace> places(values.size());
  for (auto _ : state) {
    write(values, places);
    std::ranges::sort(places, {}, [](const core::KeyedPlace& place) {
      return std::uint64_t{place.key} << 32 | place.place;
    });
    benchmark::DoNotOptimize(places.data());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(radix_sort)->RangeMultiplier(10)->Range(1'000, 10'000'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(std_sort)->RangeMultiplier(10)->Range(1'000, 10'000'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace broadside::bench

BENCHMARK_MAIN();
