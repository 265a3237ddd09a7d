// Pairs of boxes of doubles, by a finder of floats and a last test in double.
#include "doubles/double_finder.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

#include "core/filter_sink.hpp"
#include "core/rounding.hpp"
#include "interface/last_test.hpp"
#include "kernels/last_test.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside::core {
namespace {

/// Up to this many boxes have few pairs, false ones included.
constexpr std::size_t few_boxes = 256;

/// Boxes that are rounded, looked at and hashed while a core's cache holds them.
constexpr std::size_t boxes_at_once = 256;

/// Passes on the pairs that overlap in double, for finders whose kernels do not look. The order stays.
template <int D>
class ExactSink final : public FilterSink {
 public:
  ExactSink(std::span<const Box<D, double>> boxes, PairSink& target) : FilterSink(target), boxes_(boxes) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<ExactSink>(boxes_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    while (!pairs.empty()) {
      const std::span<const Pair> some = pairs.first(std::min(pairs.size(), max_room));
      std::array<std::uint8_t, max_room> overlaps;
      kernels::set_overlap_flags(boxes_, some, overlaps.data());
      const std::uint8_t* next = overlaps.data();
      pass_on(some, [&next](Pair pair, Pair& to) {
        to = pair;
        return *next++ != 0;
      });
      pairs = pairs.subspan(some.size());
    }
  }

  std::span<const Box<D, double>> boxes_;
};

}  // namespace

template <int D>
DoubleFinder<D>::DoubleFinder(std::unique_ptr<PairFinder<D>> finder) : finder_(std::move(finder)) {
  this->set_workers(finder_->workers());
}

template <int D>
void DoubleFinder<D>::find_valid(std::span<const Box<D, double>> boxes, PairSink& pairs) {
  const bool is_exact = round(boxes);
  LastTest<D>* const last_test = finder_->last_test();
  const bool in_kernels = last_test != nullptr && boxes.size() <= kernels::touching_bit;
  const std::span<const Box<D>> floats = floats_;
  if (last_test != nullptr) last_test->set_doubles(in_kernels && !is_exact ? boxes.data() : nullptr);
  if (is_exact || in_kernels) {
    this->search_with(*finder_, floats, pairs);
    return;
  }
  ExactSink<D> in_double(boxes, pairs);
  this->search_with(*finder_, floats, in_double);
  in_double.flush();
}

template <int D>
bool DoubleFinder<D>::round(std::span<const Box<D, double>> boxes) {
  const std::array<LinearRounding, D> fit = fit_linear<D>(boxes);
  renew(floats_, boxes.size());
  parallel_.start(this->workers(), boxes.size());
  std::atomic<bool> all_exact = true;
  std::atomic<std::uint64_t> hash = 0;
  parallel_.for_ranges(boxes.size(), [&](Range range, std::size_t) {
    bool is_exact = true;
    std::uint64_t of_range = 0;
    for (std::size_t begin = range.begin; begin < range.end; begin += boxes_at_once) {
      const std::size_t count = std::min(boxes_at_once, range.end - begin);
      const std::span<const Box<D, double>> some = boxes.subspan(begin, count);
      const std::span<Box<D>> floats = std::span(floats_).subspan(begin, count);
      round_linear<D>(fit, some, floats);
      is_exact = is_exact && is_lossless<D>(fit, some, floats);
      of_range += hash_of<D>(some, begin);
    }
    if (!is_exact) all_exact.store(false, std::memory_order_relaxed);
    hash.fetch_add(of_range, std::memory_order_relaxed);
  });
  if (all_exact) return true;
  if (boxes.size() <= few_boxes || !makes_false_pairs<D>(fit, boxes, this->left_count(), hash)) return false;
  const std::array<QuantileRounding, D> quantiles = fit_quantiles<D>(boxes, hash);
  parallel_.for_ranges(boxes.size(), [&](Range range, std::size_t) {
    for (std::size_t i = range.begin; i < range.end; ++i)
      floats_[i] = rounded(
          boxes[i], [&](int axis) -> const auto& { return quantiles[axis]; });
  });
  return false;
}

template <int D>
Outline<D, double> DoubleFinder<D>::lay_out(std::span<const Box<D, double>> boxes) {
  const std::array<LinearRounding, D> fit = fit_linear<D>(boxes);
  std::vector<Box<D>> floats(boxes.size());
  round_linear<D>(fit, boxes, floats);
  finder_->set_workers(this->workers());
  const Outline<D> laid_out = outline(*finder_, floats);
  Outline<D, double> outline{laid_out.kind, laid_out.caption, laid_out.swept_axis, {}};
  for (const auto& level : laid_out.levels) {
    auto& parts = outline.levels.emplace_back(level.size());
    for (std::size_t i = 0; i < level.size(); ++i) {
      for (int axis = 0; axis < D; ++axis) {
        parts[i].min[axis] = fit[axis].back(level[i].min[axis]);
        parts[i].max[axis] = fit[axis].back(level[i].max[axis]);
      }
    }
  }
  return outline;
}

template class DoubleFinder<2>;
template class DoubleFinder<3>;

}  // namespace broadside::core
