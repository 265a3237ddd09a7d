// The box of a geometry in one field.
#include "lab/formats/csv/geometry_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/csv/text.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

/// A kind of geometry: its points lie in this many lists in each other.
struct Kind {
  std::string_view name;
  int depth;
};
constexpr auto kinds = std::to_array<Kind>({{"POINT", 1},
                                            {"LINESTRING", 1},
                                            {"POLYGON", 2},
                                            {"MULTIPOINT", 1},
                                            {"MULTILINESTRING", 2},
                                            {"MULTIPOLYGON", 3},
                                            {"TRIANGLE", 2},
                                            {"TIN", 3},
                                            {"POLYHEDRALSURFACE", 3},
                                            {"GEOMETRYCOLLECTION", 0}});
constexpr std::string_view kind_list =
    "POINT, LINESTRING, POLYGON, MULTIPOINT, MULTILINESTRING, MULTIPOLYGON, GEOMETRYCOLLECTION or bounds";

/// Collections in collections beyond this are refused: reading them takes the stack.
constexpr int most_nested = 32;

/// Reads a text from left to right. Each read_...() is false once something is wrong, which `fault` tells.
template <int D, typename Real>
class GeometryText {
 public:
  GeometryText(std::string_view text, BoundsForm form) : rest_(text), form_(form) {}

  bool read() {
    skip();
    if (rest_.starts_with('{')) {
      if (rest_.find("\"coordinates\"") != std::string_view::npos)
        return fail(", which is GeoJSON", "well-known text, or a file of GeoJSON");
      return fail(", which is a struct", "a column for each of its fields, such as bbox.xmin");
    }
    if (rest_.size() > 8 && rest_.starts_with('0') &&
        rest_.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos)
      return fail(", which is well-known binary", "well-known text, as ST_AsText writes it");
    const bool is_named = !rest_.empty() && std::isalpha(static_cast<unsigned char>(rest_.front())) != 0;
    if (is_named && form_ != BoundsForm::min_max)
      return fail(", which is no list of numbers", "one, in the order that --columns names");
    if (!(is_named ? read_named() : read_numbers())) return false;
    skip();
    return rest_.empty() || fail(fmt::format(", with {} behind its end", shown(rest_)), "nothing there");
  }

  const Box<D, Real>& box() const noexcept { return box_; }
  const GeometryFault& fault() const noexcept { return fault_; }

 private:
  bool fail(std::string found, std::string expected) {
    if (fault_.found.empty()) fault_ = {std::move(found), std::move(expected)};
    return false;
  }

  bool read_numbers() {
    // Minima and maxima are read as they are; what is computed from a size is computed in double.
    if constexpr (!std::is_same_v<Real, double>) {
      if (form_ == BoundsForm::min_max) return read_bounds<Real>();
    }
    return read_bounds<double>();
  }

  void skip() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }

  /// Takes a character, with blanks before it, if it is next.
  bool take(char c) {
    skip();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool expect(char c) {
    return take(c) || fail(rest_.empty() ? ", which ends early" : fmt::format(", with {}", shown(rest_)),
                           fmt::format("'{}' there", c));
  }

  std::string word() {
    skip();
    std::string word;
    while (!rest_.empty() && (std::isalnum(static_cast<unsigned char>(rest_.front())) != 0)) {
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(rest_.front())));
      rest_.remove_prefix(1);
    }
    return word;
  }

  /// Takes a word if it is this one.
  bool take_word(std::string_view wanted) {
    const std::string_view before = rest_;
    if (word() == wanted) return true;
    rest_ = before;
    return false;
  }

  template <typename Number>
  bool read_number(Number& number) {
    skip();
    const std::string_view text = rest_.substr(0, rest_.find_first_of(" \t,()[]"));
    rest_.remove_prefix(text.size());
    if (parse_number(text, number)) return true;
    const NumberFault fault = number_fault(text);
    return fail(fmt::format(", with {}{}", shown(text), fault.found.empty() ? "" : ", " + fault.found),
                fault.expected.empty() ? "a number" : fault.expected);
  }

  bool has_number() {
    skip();
    return !rest_.empty() && std::string_view(",()[]").find(rest_.front()) == std::string_view::npos;
  }

  bool read_named() {
    if (const std::size_t end = rest_.find(';'); rest_.starts_with("SRID=") && end != std::string_view::npos)
      rest_.remove_prefix(end + 1);
    const std::string_view before = rest_;
    const std::string name = word();
    if (name == "BOX" || name == "BOX2D" || name == "BOX3D") return read_corners();
    rest_ = before;
    return read_geometry(0);
  }

  /// "(0 0,1 1)": a box's corners.
  bool read_corners() {
    return expect('(') && read_corner(box_.min) && expect(',') && read_corner(box_.max) && expect(')');
  }

  bool read_corner(std::array<Real, D>& corner) {
    for (Real& number : corner) {
      if (!read_number(number)) return false;
    }
    return !has_number() || fail(", with corners of more numbers", fmt::format("{}", D));
  }

  /// "[0, 0, 1, 1]": minima and maxima, or what `form_` says. A Number is Real where nothing is computed.
  template <typename Number>
  bool read_bounds() {
    const char close = take('[') ? ']' : take('(') ? ')' : '\0';
    std::vector<Number> numbers;
    do {
      Number number{};
      if (!read_number(number)) return false;
      numbers.push_back(number);
    } while (take(',') || has_number());
    if (close != '\0' && !expect(close)) return false;
    if (numbers.size() != 2 * D)
      return fail(fmt::format(", which is {} number{}", numbers.size(), numbers.size() == 1 ? "" : "s"),
                  fmt::format("{}, minima and then maxima", 2 * D));
    for (std::size_t axis = 0; axis < D; ++axis) {
      const auto [min, max] =
          bounds_of(form_, static_cast<double>(numbers[axis]), static_cast<double>(numbers[D + axis]));
      box_.min[axis] = static_cast<Real>(min);
      box_.max[axis] = static_cast<Real>(max);
    }
    return true;
  }

  /// "POLYGON Z ((0 0 9, ...))".
  bool read_geometry(int nested) {
    if (D == 3) return fail(", which is in 2D", "6 numbers, as in the rows before");
    std::string name = word();
    std::string more;
    const auto find = [&name] { return std::ranges::find(kinds, std::string_view(name), &Kind::name); };
    auto kind = find();
    for (const std::string_view suffix : {"ZM", "Z", "M"}) {
      if (kind != kinds.end() || !name.ends_with(suffix)) continue;
      more = suffix;
      name.resize(name.size() - suffix.size());
      kind = find();
    }
    if (kind == kinds.end())
      return fail(fmt::format(", with '{}'", plainly(name + more)), std::string(kind_list));
    for (const std::string_view suffix : {"ZM", "Z", "M"}) {
      if (more.empty() && take_word(suffix)) more = suffix;
    }
    numbers_ = more.empty() ? 0 : 2 + static_cast<int>(more.size());
    if (take_word("EMPTY")) return true;
    if (name == "GEOMETRYCOLLECTION") return read_collection(nested);
    if (name == "POINT") return expect('(') && read_point() && expect(')');
    return read_list(kind->depth, name == "MULTIPOINT");
  }

  bool read_collection(int nested) {
    if (nested == most_nested)
      return fail(fmt::format(", with collections nested more than {} deep", nested), "fewer");
    if (!expect('(')) return false;
    do {
      if (!read_geometry(nested + 1)) return false;
    } while (take(','));
    return expect(')');
  }

  bool read_list(int depth, bool has_brackets) {
    if (!expect('(')) return false;
    do {
      if (depth > 1 || has_brackets) {
        if (take_word("EMPTY")) continue;
      }
      if (depth > 1) {
        if (!read_list(depth - 1, false)) return false;
      } else if (has_brackets && take('(')) {
        if (!read_point() || !expect(')')) return false;
      } else if (!read_point()) {
        return false;
      }
    } while (take(','));
    return expect(')');
  }

  bool read_point() {
    std::array<Real, 4> numbers{};
    int count = 0;
    while (count < 4 && (count < 2 || has_number())) {
      if (!read_number(numbers[static_cast<std::size_t>(count)])) return false;
      ++count;
    }
    if (has_number() || (numbers_ != 0 && count != numbers_))
      return fail(fmt::format(", with a point of {}{} numbers", count, has_number() ? " and more" : ""),
                  numbers_ == 0 ? "2 to 4" : fmt::format("{}", numbers_));
    for (std::size_t axis = 0; axis < 2; ++axis) {
      box_.min[axis] = std::min(box_.min[axis], numbers[axis]);
      box_.max[axis] = std::max(box_.max[axis], numbers[axis]);
    }
    return true;
  }

  std::string_view rest_;
  BoundsForm form_;
  int numbers_ = 0;  // of a point; 0: not said
  Box<D, Real> box_ = absent_box<D, Real>();
  GeometryFault fault_;
};

}  // namespace

template <int D, typename Real>
GeometryFault read_geometry_text(std::string_view text, Box<D, Real>& box, BoundsForm form) {
  GeometryText<D, Real> geometry(text, form);
  geometry.read();
  box = geometry.box();
  return geometry.fault();
}

template GeometryFault read_geometry_text(std::string_view, Box<2, float>&, BoundsForm);
template GeometryFault read_geometry_text(std::string_view, Box<3, float>&, BoundsForm);
template GeometryFault read_geometry_text(std::string_view, Box<2, double>&, BoundsForm);
template GeometryFault read_geometry_text(std::string_view, Box<3, double>&, BoundsForm);

int dimension_of_geometry_text(std::string_view text) {
  DoubleBox3 box;
  return read_geometry_text(text, box).found.empty() ? 3 : 2;
}

}  // namespace broadside::lab::readers
