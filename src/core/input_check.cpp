// Rejects invalid boxes before anything has changed.
#include "core/input_check.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/float_environment.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "kernels/all_present.hpp"

namespace broadside::core {

template <int D, typename Real>
std::string text_of(const Box<D, Real>& box) {
  const auto point_text = [](const std::array<Real, D>& point) {
    std::string text;
    for (int axis = 0; axis < D; ++axis) {
      text += axis == 0 ? "(" : ", ";
      text += text_of(point[axis], std::numeric_limits<Real>::max_digits10);
    }
    return text += ")";
  };
  return message({"min ", point_text(box.min), " and max ", point_text(box.max)});
}

template <int D, typename Real>
std::string fault_of(const Box<D, Real>& box, const std::string& name, bool may_be_absent) {
  return message({name, " has ", text_of(box), "; expected numbers with min <= max on every axis",
                  may_be_absent ? ", or the absent box (min = +inf, max = -inf)" : ""});
}

template <int D, typename Real>
void check_box(const Box<D, Real>& box, std::size_t index, const char* which) {
  if (is_invalid(box)) throw InvalidInput(index, fault_of(box, message({which, "box ", index}), true));
}

template <int D, typename Real>
std::size_t check_boxes(std::span<const Box<D, Real>> boxes, std::size_t from, BadInput bad_input,
                        const char* which) {
  if (kernels::all_present(boxes.subspan(from))) return 0;
  std::size_t absent = 0;
  for (std::size_t i = from; i < boxes.size(); ++i) {
    if (is_present(boxes[i])) continue;
    if (bad_input == BadInput::reject) check_box(boxes[i], i, which);
    ++absent;
  }
  return absent;
}

void check_count(std::size_t count) {
  constexpr std::size_t max_count = std::numeric_limits<std::uint32_t>::max();
  if (count > max_count) throw InvalidFrame(message({count, " boxes; expected at most ", max_count}));
}

template <int D, typename Real>
bool is_whole(const Frame<D, Real>& frame, std::size_t known) {
  if (known == 0 || frame.boxes.size() != known || frame.changed.size() != known) return false;
  std::uint32_t differing = 0;
  for (std::size_t i = 0; i < known; ++i)
    differing |= index(frame.changed[i]) ^ static_cast<std::uint32_t>(i);
  return differing == 0;
}

template <int D, typename Real>
void check_frame(const Frame<D, Real>& frame, std::size_t known, bool checks_all, BadInput bad_input,
                 bool lists_all) {
  const std::span<const Box<D, Real>> boxes = frame.boxes;
  const std::size_t size = std::max(boxes.size(), known);
  check_count(boxes.size());
  if (!frame.filters.empty() && frame.filters.size() != boxes.size()) {
    throw InvalidFrame(message({frame.filters.size(), " filters for a frame of ", boxes.size(),
                                " boxes; expected one for each box, or none"}));
  }
  std::size_t first = checks_all ? 0 : std::min(known, boxes.size());
  if (lists_all) first = 0;
  for (const BoxId id : lists_all ? std::span<const BoxId>() : frame.changed) {
    if (index(id) >= size) {
      throw InvalidFrame(message({"changed box ", index(id), " of a frame of ", boxes.size(),
                                  " boxes; expected an index in this or the previous frame"}));
    }
    if (index(id) < first && is_invalid(boxes[index(id)])) first = index(id);
  }
  if (bad_input == BadInput::reject) check_boxes(boxes, first);
}

template std::string text_of(const Box2&);
template std::string text_of(const Box3&);
template std::string text_of(const DoubleBox2&);
template std::string text_of(const DoubleBox3&);
template std::string fault_of(const Box<2>&, const std::string&, bool);
template std::string fault_of(const Box<3>&, const std::string&, bool);
template std::string fault_of(const DoubleBox2&, const std::string&, bool);
template std::string fault_of(const DoubleBox3&, const std::string&, bool);
template bool is_whole(const Frame<2>&, std::size_t);
template bool is_whole(const Frame<3>&, std::size_t);
template bool is_whole(const Frame<2, double>&, std::size_t);
template bool is_whole(const Frame<3, double>&, std::size_t);
template void check_frame(const Frame<2>&, std::size_t, bool, BadInput, bool);
template void check_frame(const Frame<3>&, std::size_t, bool, BadInput, bool);
template void check_frame(const Frame<2, double>&, std::size_t, bool, BadInput, bool);
template void check_frame(const Frame<3, double>&, std::size_t, bool, BadInput, bool);
template void check_box(const Box<2>&, std::size_t, const char*);
template void check_box(const Box<3>&, std::size_t, const char*);
template void check_box(const DoubleBox2&, std::size_t, const char*);
template void check_box(const DoubleBox3&, std::size_t, const char*);
template std::size_t check_boxes(std::span<const Box<2>>, std::size_t, BadInput, const char*);
template std::size_t check_boxes(std::span<const Box<3>>, std::size_t, BadInput, const char*);
template std::size_t check_boxes(std::span<const DoubleBox2>, std::size_t, BadInput, const char*);
template std::size_t check_boxes(std::span<const DoubleBox3>, std::size_t, BadInput, const char*);

}  // namespace broadside::core
