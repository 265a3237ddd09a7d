// Common names of table columns, and their meaning.

#include <array>
#include <cctype>
#include <string>

#include "lab/formats/columns.hpp"

namespace broadside::lab::readers {
namespace {

/// Names of axes; if one begins with another, the longer one comes first.
struct AxisNames {
  std::string_view text;
  int axis;
};
constexpr auto axis_names = std::to_array<AxisNames>({
    {"x", 0},
    {"y", 1},
    {"z", 2},
    {"longitude", 0},
    {"latitude", 1},
    {"long", 0},
    {"lon", 0},
    {"lng", 0},
    {"lat", 1},
});

/// Words before or after an axis.
struct Word {
  Role role;
  std::string_view text;
};
constexpr auto words = std::to_array<Word>({
    {Role::min, "min"},
    {Role::min, "minimum"},
    {Role::min, "lower"},
    {Role::min, "low"},
    {Role::min, "lo"},
    {Role::max, "max"},
    {Role::max, "maximum"},
    {Role::max, "upper"},
    {Role::max, "high"},
    {Role::max, "hi"},
    {Role::min, "start"},
    {Role::max, "end"},
    {Role::centre, "center"},
    {Role::centre, "centre"},
    {Role::centre, "c"},
    {Role::centre, "mid"},
    {Role::size, "size"},
    {Role::size, "length"},
    {Role::size, "d"},
    {Role::half_size, "half"},
    {Role::half_size, "h"},
    {Role::half_size, "halfsize"},
    {Role::half_size, "halfextent"},
    {Role::half_size, "halfextents"},
    {Role::position, ""},
    {Role::position, "pos"},
    {Role::position, "position"},
    {Role::zeroth, "0"},
    {Role::first, "1"},
    {Role::second, "2"},
    {Role::third, "3"},
});

/// Names of corners and sides, before or after an axis: the y of an upper left corner is a top.
struct Corner {
  std::string_view text;
  std::optional<Role> x;
  std::optional<Role> y;
};
constexpr auto corners = std::to_array<Corner>({
    {"left", Role::min, std::nullopt},
    {"right", Role::max, std::nullopt},
    {"bottom", std::nullopt, Role::bottom},
    {"top", std::nullopt, Role::top},
    {"tl", Role::min, Role::top},
    {"br", Role::max, Role::bottom},
    {"ul", Role::min, Role::top},
    {"lr", Role::max, Role::bottom},
    {"ll", Role::min, Role::bottom},
    {"ur", Role::max, Role::top},
    {"topleft", Role::min, Role::top},
    {"bottomright", Role::max, Role::bottom},
    {"upperleft", Role::min, Role::top},
    {"lowerright", Role::max, Role::bottom},
});

/// Names that include the axis.
struct Whole {
  std::string_view text;
  Meaning meaning;
};
constexpr auto wholes = std::to_array<Whole>({
    {"left", {Role::min, 0}},
    {"right", {Role::max, 0}},
    {"bottom", {Role::bottom, 1}},
    {"top", {Role::top, 1}},
    {"west", {Role::min, 0}},
    {"east", {Role::max, 0}},
    {"south", {Role::min, 1}},
    {"north", {Role::max, 1}},
    {"start", {Role::begin, 0}},
    {"begin", {Role::begin, 0}},
    {"end", {Role::end, 0}},
    {"chromstart", {Role::begin, 0}},
    {"chromend", {Role::end, 0}},
    {"width", {Role::size, 0}},
    {"height", {Role::size, 1}},
    {"depth", {Role::size, 2}},
    {"w", {Role::size, 0}},
    {"h", {Role::size, 1}},
    {"d", {Role::size, 2}},
    {"halfwidth", {Role::half_size, 0}},
    {"halfheight", {Role::half_size, 1}},
    {"halfdepth", {Role::half_size, 2}},
});

std::optional<Meaning> meaning_of_plain(std::string_view text) {
  for (const Whole& whole : wholes) {
    if (text == whole.text) return whole.meaning;
  }
  for (const Word& word : words) {
    for (const AxisNames& axis : axis_names) {
      if (text.size() != axis.text.size() + word.text.size()) continue;
      const bool is_before = text.starts_with(axis.text) && text.ends_with(word.text);
      const bool is_behind = text.starts_with(word.text) && text.ends_with(axis.text);
      if (!is_before && !is_behind) continue;
      const bool is_geographic = word.role == Role::position && axis.text.size() > 1;
      return Meaning{is_geographic ? Role::geographic : word.role, axis.axis};
    }
  }
  for (const Corner& corner : corners) {
    for (const auto& [role, axis] : {std::pair(corner.x, 0), std::pair(corner.y, 1)}) {
      const char letter = "xy"[axis];
      if (role && text.size() == corner.text.size() + 1 &&
          ((text.starts_with(letter) && text.ends_with(corner.text)) ||
           (text.ends_with(letter) && text.starts_with(corner.text))))
        return Meaning{*role, axis};
    }
  }
  return std::nullopt;
}

}  // namespace

std::string plain(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (std::string_view("_-. ").find(c) == std::string_view::npos)
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return text;
}

std::optional<Meaning> meaning_of(std::string_view name) {
  const std::string text = plain(name);
  std::optional<Meaning> meaning = meaning_of_plain(text);
  for (const std::string_view box : {"bbox", "bb"}) {
    if (!meaning && text.starts_with(box))
      meaning = meaning_of_plain(std::string_view(text).substr(box.size()));
  }
  return meaning;
}

}  // namespace broadside::lab::readers
