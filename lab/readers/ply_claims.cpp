// What the header of a PLY file claims: "element NAME COUNT", and the "property" lines of each.
#include "lab/readers/ply_claims.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "lab/readers/format.hpp"

namespace broadside::lab {
namespace {

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::uint64_t least_bytes = 0;  // that one of it takes
};

/// The next word of `line`, which loses it; empty at the end.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view blanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

/// The bytes of a number of this type in a binary file; 0 for a type that is none.
std::uint64_t bytes_of(std::string_view type) {
  struct Type {
    std::string_view name;
    std::uint64_t bytes;
  };
  static constexpr std::array<Type, 16> types = {{{"char", 1},
                                                  {"int8", 1},
                                                  {"uchar", 1},
                                                  {"uint8", 1},
                                                  {"short", 2},
                                                  {"int16", 2},
                                                  {"ushort", 2},
                                                  {"uint16", 2},
                                                  {"int", 4},
                                                  {"int32", 4},
                                                  {"uint", 4},
                                                  {"uint32", 4},
                                                  {"float", 4},
                                                  {"float32", 4},
                                                  {"double", 8},
                                                  {"float64", 8}}};
  const auto* const found = std::ranges::find(types, type, &Type::name);
  return found == types.end() ? 0 : found->bytes;
}

std::uint64_t count_of(std::string_view word) {
  std::uint64_t count = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  const bool is_too_large = error == std::errc::result_out_of_range;
  return is_too_large ? std::numeric_limits<std::uint64_t>::max() : count;
}

}  // namespace

void check_ply_claims(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with("ply")) return;
  std::vector<Element> elements;
  bool is_text = false;
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::string_view word = next_word(line);
    if (word == "end_header") break;
    if (word == "format") {
      is_text = next_word(line) == "ascii";
    } else if (word == "element") {
      const std::string_view element = next_word(line);
      elements.push_back({element, count_of(next_word(line))});
    } else if (word == "property" && !elements.empty()) {
      std::string_view type = next_word(line);
      // Of a list, the number of its values is always there.
      if (type == "list") type = next_word(line);
      // As text: a digit, and what parts it from the next.
      elements.back().least_bytes += is_text ? 2 : bytes_of(type);
    }
  }
  for (const Element& element : elements) {
    const std::uint64_t least = std::max(element.least_bytes, std::uint64_t{1});
    // The last number of a text needs nothing behind it.
    const std::uint64_t most = (rest.size() + 1) / least;
    if (element.count > most) {
      throw FileError(
          fmt::format("{}: claims {} of the element '{}', which {} bytes cannot hold; expected at most {}",
                      name, element.count, element.name, rest.size(), most));
    }
  }
}

}  // namespace broadside::lab
