// Rounds boxes of doubles to floats, written once for every instruction set.
//
// Coordinates are taken as they lie in memory: 2 D vectors are as many boxes as a vector has lanes. A box's
// minima are compared with its maxima by loading again D coordinates further on, so that nothing is shuffled.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/round_boxes.cpp"
#include "kernels/round_boxes.hpp"

#include <algorithm>
#include <limits>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <int D>
class BoxRounder {
 public:
  BoxRounder(std::span<const Box<D, double>> boxes, std::size_t first_place,
             const std::array<core::LinearRounding, D>& fit, Box<D>* floats)
      : boxes_(boxes), first_place_(first_place), fit_(fit), floats_(floats) {}

  RoundedBoxes round() {
    std::size_t done = 0;
#if HWY_HAVE_FLOAT64 && HWY_TARGET != HWY_SCALAR
    done = in_vectors();
#endif
    for (; done < boxes_.size() && result_.all_present; ++done) round_box(done);
    return result_;
  }

  bool round_few() {
    std::size_t done = 0;
#if HWY_HAVE_FLOAT64 && HWY_TARGET != HWY_SCALAR
    if (boxes_.size() > lanes) {
      set_axes();
      done = boxes_.size() - 1;
      round_some<false, false>(0, done / lanes * lanes);
      if (done % lanes != 0) round_some<false, false>(done - lanes, lanes);  // some of them again
    }
#endif
    for (; done < boxes_.size(); ++done) {
      floats_[done] = core::rounded(boxes_[done], fit_);
      result_.all_present = result_.all_present && is_present(boxes_[done]);
    }
    return result_.all_present;
  }

 private:
  void round_box(std::size_t i) {
    const std::span<const Box<D, double>> one = boxes_.subspan(i, 1);
    floats_[i] = core::rounded(one[0], fit_);
    result_.all_present = is_present(one[0]);
    result_.is_lossless = result_.is_lossless && core::is_lossless<D>(fit_, one, {floats_ + i, 1});
    result_.hash += core::hash_of<D>(one, first_place_ + i);
  }

#if HWY_HAVE_FLOAT64 && HWY_TARGET != HWY_SCALAR
  using Doubles = hn::CappedTag<double, 8>;
  using Words = hn::RebindToUnsigned<Doubles>;
  using Halves = hn::Repartition<std::uint32_t, Words>;
  using Floats = hn::Rebind<float, Doubles>;
  using Vector = hn::Vec<Doubles>;

  static constexpr std::size_t lanes = hn::MaxLanes(Doubles());
  static constexpr std::size_t vectors = 2 * D;
  static constexpr std::size_t coordinates = vectors * lanes;  // of as many boxes as a vector has lanes

  /// Boxes between two looks at whether one was not present, or has lost something.
  static constexpr std::size_t boxes_at_once = 512;

  /// A number for each coordinate of `lanes` boxes.
  template <typename T>
  struct alignas(64) Table {
    std::array<T, coordinates> values;
  };

  /// A number for each axis, again and again: as many as a vector has lanes, from any axis on.
  using AxisTable = std::array<double, lanes + D - 1>;

  static constexpr Table<std::uint64_t> is_min = [] {
    Table<std::uint64_t> table{};
    for (std::size_t k = 0; k < coordinates; ++k) table.values[k] = k % vectors < D ? ~std::uint64_t{0} : 0;
    return table;
  }();

  void set_axes() {
    for (std::size_t k = 0; k < origin_.size(); ++k) {
      const core::LinearRounding& axis = fit_[k % D];
      origin_[k] = axis.origin();
      scale_[k] = axis.scale();
      inverse_scale_[k] = axis.inverse_scale();
    }
  }

  /// Rounds all boxes but the last few. Returns how many.
  std::size_t in_vectors() {
    set_axes();
    for (std::size_t k = 0; k < coordinates; ++k) key_.values[k] = core::hash_key(first_place_ * vectors + k);
    std::size_t done = 0;
    // The last box is left out: the loads of maxima reach into the next box.
    while (done + lanes < boxes_.size() && result_.all_present) {
      const std::size_t count = std::min(boxes_at_once, (boxes_.size() - 1 - done) / lanes * lanes);
      if (result_.is_lossless)
        round_some<true, true>(done, count);
      else
        round_some<false, true>(done, count);
      done += count;
    }
    return done;
  }

  /// Rounds `count` boxes, a multiple of `lanes`, from place `first` on.
  template <bool LooksForLoss, bool Hashes>
  HWY_INLINE void round_some(std::size_t first, std::size_t count) {
    const Doubles d;
    const Words words;
    const Halves halves;
    const auto* from = reinterpret_cast<const double*>(boxes_.data() + first);
    auto* to = reinterpret_cast<float*>(floats_ + first);
    const Vector largest = hn::Set(d, double{std::numeric_limits<float>::max()});
    auto wrong = hn::Zero(words);
    auto lost = hn::Zero(words);
    auto hash = hn::Zero(words);
    auto shift = hn::Set(words, core::hash_key(first * vectors));
    const auto step = hn::Set(words, core::hash_key(coordinates));
    for (std::size_t i = 0; i < count; i += lanes, from += coordinates, to += coordinates) {
      for (std::size_t v = 0; v < vectors; ++v) {
        const std::size_t k = v * lanes;
        const Vector value = hn::LoadU(d, from + k);
        const Vector origin = hn::LoadU(d, origin_.data() + k % D);
        const Vector scaled = hn::Mul(hn::Sub(value, origin), hn::LoadU(d, scale_.data() + k % D));
        const auto rounded = hn::DemoteTo(Floats(), hn::Max(hn::Min(scaled, largest), hn::Neg(largest)));
        hn::StoreU(rounded, Floats(), to + k);
        const auto is_ordered = hn::VecFromMask(d, hn::Le(value, hn::LoadU(d, from + k + D)));
        wrong = hn::Or(wrong,
                       hn::AndNot(hn::BitCast(words, is_ordered), hn::Load(words, is_min.values.data() + k)));
        if constexpr (LooksForLoss) {
          const Vector inverse = hn::LoadU(d, inverse_scale_.data() + k % D);
          const Vector back = hn::Add(origin, hn::Mul(hn::PromoteTo(d, rounded), inverse));
          lost = hn::Or(lost, hn::BitCast(words, hn::VecFromMask(d, hn::Ne(back, value))));
        }
        if constexpr (Hashes) {
          const auto key = hn::Add(hn::Load(words, key_.values.data() + k), shift);
          const auto bits = hn::BitCast(halves, hn::Add(value, hn::Zero(d)));
          const auto sum = hn::Add(bits, hn::BitCast(halves, key));
          const auto high = hn::BitCast(halves, hn::ShiftRight<32>(hn::BitCast(words, sum)));
          hash = hn::Add(hash, hn::MulEven(sum, high));
        }
      }
      shift = hn::Add(shift, step);
    }
    result_.all_present = result_.all_present && hn::AllTrue(words, hn::Eq(wrong, hn::Zero(words)));
    result_.is_lossless = result_.is_lossless && hn::AllTrue(words, hn::Eq(lost, hn::Zero(words)));
    result_.hash += hn::GetLane(hn::SumOfLanes(words, hash));
  }

  AxisTable origin_;
  AxisTable scale_;
  AxisTable inverse_scale_;
  Table<std::uint64_t> key_;
#endif

  std::span<const Box<D, double>> boxes_;
  std::size_t first_place_;
  const std::array<core::LinearRounding, D>& fit_;
  Box<D>* floats_;
  RoundedBoxes result_;
};

template <int D>
RoundedBoxes round(std::span<const Box<D, double>> boxes, std::size_t first_place,
                   const std::array<core::LinearRounding, D>& fit, Box<D>* floats) {
  return BoxRounder<D>(boxes, first_place, fit, floats).round();
}

template <int D>
bool round_few(std::span<const Box<D, double>> boxes, const std::array<core::LinearRounding, D>& fit,
               Box<D>* floats) {
  return BoxRounder<D>(boxes, 0, fit, floats).round_few();
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& round_2 = round<2>;
constexpr auto& round_3 = round<3>;
constexpr auto& round_few_2 = round_few<2>;
constexpr auto& round_few_3 = round_few<3>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(round_2);
HWY_EXPORT(round_3);
HWY_EXPORT(round_few_2);
HWY_EXPORT(round_few_3);

template <>
RoundedBoxes round_boxes<2>(std::span<const DoubleBox2> boxes, std::size_t first_place,
                            const std::array<core::LinearRounding, 2>& fit, Box<2>* floats) {
  return HWY_DYNAMIC_DISPATCH(round_2)(boxes, first_place, fit, floats);
}
template <>
RoundedBoxes round_boxes<3>(std::span<const DoubleBox3> boxes, std::size_t first_place,
                            const std::array<core::LinearRounding, 3>& fit, Box<3>* floats) {
  return HWY_DYNAMIC_DISPATCH(round_3)(boxes, first_place, fit, floats);
}

template <>
bool round_few_boxes<2>(std::span<const DoubleBox2> boxes, const std::array<core::LinearRounding, 2>& fit,
                        Box<2>* floats) {
  return HWY_DYNAMIC_DISPATCH(round_few_2)(boxes, fit, floats);
}
template <>
bool round_few_boxes<3>(std::span<const DoubleBox3> boxes, const std::array<core::LinearRounding, 3>& fit,
                        Box<3>* floats) {
  return HWY_DYNAMIC_DISPATCH(round_few_3)(boxes, fit, floats);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE
