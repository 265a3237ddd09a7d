// Boxes as text, for messages.
#include "interface/box_text.hpp"

#include <limits>
#include <locale>
#include <sstream>

namespace broadside::core {

template <int D, typename Real>
std::string text_of(const Box<D, Real>& box) {
  std::ostringstream text;
  text.imbue(std::locale::classic());  // the global locale may be another
  text.precision(std::numeric_limits<Real>::max_digits10);
  const auto print = [&text](const std::array<Real, D>& point) {
    for (int axis = 0; axis < D; ++axis) text << (axis == 0 ? "(" : ", ") << point[axis];
    text << ')';
  };
  text << "min ";
  print(box.min);
  text << " and max ";
  print(box.max);
  return text.str();
}

template std::string text_of(const Box2&);
template std::string text_of(const Box3&);
template std::string text_of(const DoubleBox2&);
template std::string text_of(const DoubleBox3&);

}  // namespace broadside::core
