// Boxes as text, for messages.
#include "interface/box_text.hpp"

#include <limits>

#include "core/message.hpp"
#include "core/number_text.hpp"

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

template std::string text_of(const Box2&);
template std::string text_of(const Box3&);
template std::string text_of(const DoubleBox2&);
template std::string text_of(const DoubleBox3&);

}  // namespace broadside::core
