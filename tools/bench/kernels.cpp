// The kernels alone, by the length of a run of boxes and by instruction set: kernels
// [--benchmark_filter=...].
//
// A box has about eight candidates on the swept axis, whatever the length of the run. Times are those of a
// whole call; box pairs tested per second and pairs found per second are printed beside them.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "broadside/executor.hpp"
#include "broadside/sinks.hpp"

#include "kernels/run.hpp"
#include "kernels/sweep.hpp"
#include "lab/scenes/random.hpp"

namespace broadside::bench {
namespace {

template <int D>
kernels::RunBuffer<D> run_of(std::size_t count, std::uint64_t seed) {
  lab::Random random(seed);
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = static_cast<float>(random.between(0, axis == 0 ? static_cast<double>(count) / 8 : 4));
      box.max[axis] = box.min[axis] + 1;
    }
  }
  std::ranges::sort(boxes, {}, [](const Box<D>& box) { return box.min[0]; });
  kernels::RunBuffer<D> run;
  run.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) run.append(boxes[i], BoxId{i});
  return run;
}

/// Times one kernel, `call(a, b, pairs)`, with the kernels of one instruction set.
template <int D, typename Call>
void time_kernel(benchmark::State& state, const std::string& name, Call call) {
  limit_instruction_set(name);
  const auto count = static_cast<std::size_t>(state.range(0));
  kernels::RunBuffer<D> a = run_of<D>(count, 1);
  kernels::RunBuffer<D> b = run_of<D>(count, 2);
  PairCounter pairs;
  std::uint64_t tests = 0;
  for (auto _ : state) tests += call(a.view(nullptr), b.view(nullptr), pairs);
  pairs.flush();
  state.counters["tests"] = {static_cast<double>(tests), benchmark::Counter::kIsRate};
  state.counters["pairs"] = {static_cast<double>(pairs.count()), benchmark::Counter::kIsRate};
  limit_instruction_set("");
}

template <int D>
void register_kernels(const std::string& target) {
  using Run = kernels::Run<D>;
  const std::string end = "/" + std::to_string(D) + "D/" + target;
  const auto add = [&](const std::string& name, auto call) {
    benchmark::RegisterBenchmark((name + end).c_str(), time_kernel<D, decltype(call)>, target, call)
        ->RangeMultiplier(4)
        ->Range(16, 4096);
  };
  add("sweep_run", [](const Run& a, const Run&, PairSink& pairs) { return kernels::sweep(a, pairs); });
  add("sweep_runs", [](const Run& a, const Run& b, PairSink& pairs) { return kernels::sweep(a, b, pairs); });
  add("compare_run",
      [](const Run& a, const Run&, PairSink& pairs) { return kernels::compare_all(a, pairs); });
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  for (const std::string& target : broadside::instruction_sets()) {
    broadside::bench::register_kernels<2>(target);
    broadside::bench::register_kernels<3>(target);
  }
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
