// One layer behind all languages: the kinds of boxes, and AnyKind, an object for boxes of any of them. A
// binding writes each of its functions once, as a body that visits the object.
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "bindings/c/broadside.h"

namespace broadside::bindings {

constexpr broadside_kind kind_with(int dimension, bool has_doubles) noexcept {
  if (dimension == 2) return has_doubles ? BROADSIDE_DOUBLE_2D : BROADSIDE_FLOAT_2D;
  return has_doubles ? BROADSIDE_DOUBLE_3D : BROADSIDE_FLOAT_3D;
}

constexpr int dimension_of(broadside_kind kind) noexcept {
  return kind == BROADSIDE_FLOAT_2D || kind == BROADSIDE_DOUBLE_2D ? 2 : 3;
}
constexpr bool has_doubles(broadside_kind kind) noexcept {
  return kind == BROADSIDE_DOUBLE_2D || kind == BROADSIDE_DOUBLE_3D;
}

template <int D, typename Real>
inline constexpr broadside_kind kind_of = kind_with(D, std::is_same_v<Real, double>);

/// Returns body.operator()<D, Real>() for a kind. Throws std::invalid_argument for a number that is none.
template <typename Body>
auto with_kind(broadside_kind kind, const Body& body) {
  switch (kind) {
    case BROADSIDE_FLOAT_2D:
      return body.template operator()<2, float>();
    case BROADSIDE_FLOAT_3D:
      return body.template operator()<3, float>();
    case BROADSIDE_DOUBLE_2D:
      return body.template operator()<2, double>();
    case BROADSIDE_DOUBLE_3D:
      return body.template operator()<3, double>();
  }
  throw std::invalid_argument("kind is " + std::to_string(kind) + "; expected one of broadside_kind, 0 to 3");
}

/// The text of a kind, such as "3D floats".
inline std::string text_of(broadside_kind kind) {
  return with_kind(kind, []<int D, typename Real>() {
    return std::to_string(D) + (std::is_same_v<Real, float> ? "D floats" : "D doubles");
  });
}

/// Thrown for boxes, or an object over boxes, of a valid kind that does not go with the others.
struct OtherKind : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Throws OtherKind if the kinds differ. `thing` begins the message, such as "boxes are".
inline void check_kind(broadside_kind found, broadside_kind expected, const char* thing) {
  if (found != expected)
    throw OtherKind(std::string(thing) + " " + text_of(found) + "; expected " + text_of(expected));
}

/// A Class<D, Real>; the kind decides which. An Object is made in place: it need not be movable.
template <template <int, typename> class Class>
class AnyKind {
  using Object = std::variant<Class<2, float>, Class<3, float>, Class<2, double>, Class<3, double>>;

 public:
  /// Throws std::invalid_argument for a number that is no kind.
  template <typename... Arguments>
  explicit AnyKind(broadside_kind kind, const Arguments&... arguments)
      : kind_(kind), object_(with_kind(kind, [&]<int D, typename Real>() {
          return Object(std::in_place_type<Class<D, Real>>, arguments...);
        })) {}

  broadside_kind kind() const noexcept { return kind_; }

  /// Returns body(object).
  template <typename Body>
  auto visit(const Body& body) {
    return std::visit(body, object_);
  }
  template <typename Body>
  auto visit(const Body& body) const {
    return std::visit(body, object_);
  }

  /// The object if it is of this kind. Otherwise throws OtherKind; `thing` begins its message.
  template <int D, typename Real>
  Class<D, Real>& get(const char* thing) {
    check_kind(kind_, kind_of<D, Real>, thing);
    return std::get<Class<D, Real>>(object_);
  }
  template <int D, typename Real>
  const Class<D, Real>& get(const char* thing) const {
    check_kind(kind_, kind_of<D, Real>, thing);
    return std::get<Class<D, Real>>(object_);
  }

 private:
  broadside_kind kind_;
  Object object_;
};

}  // namespace broadside::bindings
