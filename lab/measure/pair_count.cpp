// Whether boxes have so many pairs that a measurement would fill the machine.
#include "lab/measure/pair_count.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/reference.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {

template <int D, typename Real>
void check_pair_count(BoxSpan<D, Real> boxes) {
  constexpr double most = 250e6;  // 2 GB
  std::vector<Box<D, Real>> some;
  for (const std::size_t i : sample_of(boxes.size(), 1'000)) some.push_back(boxes[i]);
  const double scale =
      static_cast<double>(boxes.size()) / static_cast<double>(std::max<std::size_t>(some.size(), 1));
  const double pairs = static_cast<double>(reference_pairs<D, Real>(some).size()) * scale * scale;
  if (pairs > most) {
    throw std::runtime_error(fmt::format(
        "{} boxes with about {:.1e} pairs; expected at most {:.1e}, since pairs are kept to be checked",
        grouped(boxes.size()), pairs, most));
  }
}

template void check_pair_count<2, float>(BoxSpan<2, float>);
template void check_pair_count<3, float>(BoxSpan<3, float>);
template void check_pair_count<2, double>(BoxSpan<2, double>);
template void check_pair_count<3, double>(BoxSpan<3, double>);

}  // namespace broadside::lab
