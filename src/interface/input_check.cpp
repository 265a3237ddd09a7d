// Refuses boxes that no algorithm may see, before anything has changed.
#include "interface/input_check.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "broadside/error.hpp"

#include "core/float_environment.hpp"
#include "interface/box_text.hpp"

namespace broadside::core {

template <int D, typename Real>
std::string fault_of(const Box<D, Real>& box, const std::string& name, bool may_be_absent) {
  return name + " has " + text_of(box) + "; expected numbers with min <= max on every axis" +
         (may_be_absent ? ", or the absent box (min = +inf, max = -inf)" : "");
}

template <int D, typename Real>
void check_box(const Box<D, Real>& box, std::size_t index) {
  if (is_invalid(box)) throw InvalidInput(index, fault_of(box, "box " + std::to_string(index), true));
}

template <int D, typename Real>
std::size_t check_boxes(std::span<const Box<D, Real>> boxes, std::size_t from, BadInput bad_input) {
  std::size_t absent = 0;
  for (std::size_t i = from; i < boxes.size(); ++i) {
    if (is_present(boxes[i])) continue;
    if (bad_input == BadInput::reject) check_box(boxes[i], i);
    ++absent;
  }
  return absent;
}

void check_count(std::size_t count) {
  constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
  if (count > most)
    throw InvalidFrame(std::to_string(count) + " boxes; expected at most " + std::to_string(most));
}

template std::string fault_of(const Box<2>&, const std::string&, bool);
template std::string fault_of(const Box<3>&, const std::string&, bool);
template std::string fault_of(const DoubleBox2&, const std::string&, bool);
template std::string fault_of(const DoubleBox3&, const std::string&, bool);
template void check_box(const Box<2>&, std::size_t);
template void check_box(const Box<3>&, std::size_t);
template void check_box(const DoubleBox2&, std::size_t);
template void check_box(const DoubleBox3&, std::size_t);
template std::size_t check_boxes(std::span<const Box<2>>, std::size_t, BadInput);
template std::size_t check_boxes(std::span<const Box<3>>, std::size_t, BadInput);
template std::size_t check_boxes(std::span<const DoubleBox2>, std::size_t, BadInput);
template std::size_t check_boxes(std::span<const DoubleBox3>, std::size_t, BadInput);

}  // namespace broadside::core
