// Parses a geometry in one field, and computes its box.
#include "lab/formats/csv/geometry_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/text.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab::readers {
namespace {

constexpr auto kinds = std::to_array<std::string_view>({"POINT", "LINESTRING", "POLYGON", "MULTIPOINT",
                                                        "MULTILINESTRING", "MULTIPOLYGON", "TRIANGLE", "TIN",
                                                        "POLYHEDRALSURFACE", "GEOMETRYCOLLECTION"});
constexpr std::string_view kind_list =
    "POINT, LINESTRING, POLYGON, MULTIPOINT, MULTILINESTRING, MULTIPOLYGON, GEOMETRYCOLLECTION or bounds";

/// More deeply nested lists are refused, because the parser is recursive.
constexpr int max_nested = 40;

/// A recursive-descent parser. Each read_...() returns false after an error, which `geometry` describes.
class GeometryText {
 public:
  GeometryText(std::string_view text, BoundsForm form) : rest_(text), form_(form) {}

  TextGeometry read() {
    read_all();
    return std::move(geometry_);
  }

 private:
  bool fail(std::string found, std::string expected) {
    geometry_.found = std::move(found);
    geometry_.expected = std::move(expected);
    return false;
  }

  bool read_all() {
    skip();
    if (rest_.starts_with('{'))
      return rest_.find("\"coordinates\"") != std::string_view::npos
                 ? fail(", which is GeoJSON", "well-known text, or a file of GeoJSON")
                 : fail(", which is a struct", "a column for each of its fields, such as bbox.xmin");
    if (rest_.size() > 8 && rest_.starts_with('0') &&
        rest_.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos)
      return fail(", which is well-known binary", "well-known text, as ST_AsText writes it");
    const bool is_named = !rest_.empty() && std::isalpha(static_cast<unsigned char>(rest_.front())) != 0;
    if (is_named && form_ != BoundsForm::min_max)
      return fail(", which is no list of numbers", "one, in the order that --columns names");
    if (!(is_named ? read_named() : read_bounds())) return false;
    skip();
    return rest_.empty() || fail(fmt::format(", with {} behind its end", shown(rest_)), "nothing there");
  }

  void skip() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }

  /// Consumes a character, with blanks before it, if it comes next.
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

  /// Consumes a word if it comes next.
  bool take_word(std::string_view wanted) {
    const std::string_view before = rest_;
    if (word() == wanted) return true;
    rest_ = before;
    return false;
  }

  /// Reads numbers up to a bracket or, unless commas separate them, up to a comma.
  bool read_numbers(bool has_commas) {
    numbers_.clear();
    do {
      skip();
      const std::string_view text = rest_.substr(0, rest_.find_first_of(" \t,()[]"));
      rest_.remove_prefix(text.size());
      if (double number = 0; parse_number(text, number)) {
        numbers_.push_back(number);
      } else {
        const NumberFault fault = number_fault(text);
        return fail(fmt::format(", with {}{}", shown(text), fault.found.empty() ? "" : ", " + fault.found),
                    fault.expected.empty() ? "a number" : fault.expected);
      }
      skip();
    } while ((has_commas && take(',')) ||
             (!rest_.empty() && std::string_view(",()[]").find(rest_.front()) == std::string_view::npos));
    return true;
  }

  /// "[0, 0, 1, 1]": minima, then maxima, or in the order of `form_`.
  bool read_bounds() {
    const char close = take('[') ? ']' : take('(') ? ')' : '\0';
    return read_numbers(true) && (close == '\0' || expect(close)) && take_bounds();
  }

  bool take_bounds() {
    if (numbers_.size() != 4 && numbers_.size() != 6)
      return fail(fmt::format(", which is {}", counted(numbers_.size(), "number", "numbers")),
                  "4 or 6, minima and then maxima");
    const std::size_t axes = numbers_.size() / 2;
    geometry_.dimension = static_cast<int>(axes);
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const auto [min, max] = bounds_of(form_, numbers_[axis], numbers_[axes + axis]);
      geometry_.box.min[axis] = min;
      geometry_.box.max[axis] = max;
    }
    return true;
  }

  bool read_named() {
    if (const std::size_t end = rest_.find(';'); rest_.starts_with("SRID=") && end != std::string_view::npos)
      rest_.remove_prefix(end + 1);
    if (!take_word("BOX") && !take_word("BOX2D") && !take_word("BOX3D")) return read_geometry(0);
    // "(0 0,1 1)": a box's corners.
    return expect('(') && read_numbers(true) && expect(')') && take_bounds();
  }

  /// "POLYGON Z ((0 0 9, ...))".
  bool read_geometry(int nested) {
    std::string name = word();
    std::size_t numbers = 0;  // numbers per point, if the text says it
    for (const std::string_view suffix : {"ZM", "Z", "M"}) {
      const bool is_known = std::find(kinds.begin(), kinds.end(), name) != kinds.end();
      if (numbers != 0 || (is_known ? !take_word(suffix) : !name.ends_with(suffix))) continue;
      if (!is_known) name.resize(name.size() - suffix.size());
      numbers = 2 + suffix.size();
    }
    if (std::find(kinds.begin(), kinds.end(), name) == kinds.end())
      return fail(fmt::format(", with {}", shown(name)), std::string(kind_list));
    return read_list(numbers, name == "GEOMETRYCOLLECTION", nested);
  }

  /// "(1 2, 3 4)", "((1 2), EMPTY)" or the geometries of a collection.
  bool read_list(std::size_t numbers, bool is_collection, int nested) {
    if (take_word("EMPTY")) return true;
    if (nested == max_nested)
      return fail(fmt::format(", with lists nested more than {} deep", nested), "fewer");
    if (!expect('(')) return false;
    do {
      skip();
      const bool is_list = rest_.starts_with('(') || rest_.starts_with('E') || rest_.starts_with('e');
      if (!(is_collection ? read_geometry(nested + 1)
            : is_list     ? read_list(numbers, false, nested + 1)
                          : read_point(numbers)))
        return false;
    } while (take(','));
    return expect(')');
  }

  bool read_point(std::size_t wanted) {
    if (!read_numbers(false)) return false;
    if (numbers_.size() < 2 || numbers_.size() > 4 || (wanted != 0 && numbers_.size() != wanted))
      return fail(fmt::format(", with a point of {}", counted(numbers_.size(), "number", "numbers")),
                  wanted == 0 ? "2 to 4" : fmt::format("{}", wanted));
    for (std::size_t axis = 0; axis < 2; ++axis) {
      geometry_.box.min[axis] = std::min(geometry_.box.min[axis], numbers_[axis]);
      geometry_.box.max[axis] = std::max(geometry_.box.max[axis], numbers_[axis]);
    }
    return true;
  }

  std::string_view rest_;
  BoundsForm form_;
  std::vector<double> numbers_;  // read last
  TextGeometry geometry_;
};

}  // namespace

TextGeometry read_geometry_text(std::string_view text, BoundsForm form) {
  return GeometryText(text, form).read();
}

}  // namespace broadside::lab::readers
