// Names of columns and their meanings.
#include "lab/readers/csv_columns.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "lab/readers/shown.hpp"

namespace broadside::lab::readers {
namespace {

/// What a column says of an axis. `position` leaves open of what; the numbered ones are minimum and maximum,
/// counted from 0 or from 1.
enum class Role : std::uint8_t { min, max, centre, size, half_size, position, zeroth, first, second, third };
constexpr std::size_t roles = 10;

struct Meaning {
  Role role;
  int axis;
};

constexpr std::string_view axes = "xyz";

/// Names that stand before an axis, or behind it.
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

/// Names with the axis in them.
struct Whole {
  std::string_view text;
  Meaning meaning;
};
constexpr auto wholes = std::to_array<Whole>({
    {"left", {Role::min, 0}},
    {"right", {Role::max, 0}},
    {"bottom", {Role::min, 1}},
    {"top", {Role::max, 1}},
    {"west", {Role::min, 0}},
    {"east", {Role::max, 0}},
    {"south", {Role::min, 1}},
    {"north", {Role::max, 1}},
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

std::optional<Meaning> meaning_of(std::string_view name) {
  const std::string text = plain(name);
  for (const Whole& whole : wholes) {
    if (text == whole.text) return whole.meaning;
  }
  if (text.empty()) return std::nullopt;
  for (const Word& word : words) {
    for (const auto& [letter, rest] :
         {std::pair(text.front(), std::string_view(text).substr(1)),
          std::pair(text.back(), std::string_view(text).substr(0, text.size() - 1))}) {
      const std::size_t axis = axes.find(letter);
      if (axis != std::string_view::npos && rest == word.text)
        return Meaning{word.role, static_cast<int>(axis)};
    }
  }
  return std::nullopt;
}

bool is_frame(std::string_view name) { return plain(name) == "frame"; }

bool is_box(std::string_view name) { return plain(name) == "box"; }

constexpr int none = -1;

/// For each role of an axis, the column that has it.
using Found = std::array<int, roles>;

/// The two columns that give the bounds on an axis.
struct Choice {
  BoundsForm form;
  int first;
  int second;
};

int of(const Found& found, Role role) { return found[static_cast<std::size_t>(role)]; }

/// What is wrong if numbers count three points or more, whose first two are no bounds; nothing otherwise.
std::string points_of(const Found& found, std::span<const std::string_view> names) {
  std::string list;
  int count = 0;
  for (const Role role : {Role::zeroth, Role::first, Role::second, Role::third}) {
    if (of(found, role) == none) continue;
    list += fmt::format("{}{}", list.empty() ? "" : ", ",
                        shown(names[static_cast<std::size_t>(of(found, role))]));
    ++count;
  }
  return count < 3 ? "" : fmt::format("columns {} may be those of {} points", list, count);
}

/// On a screen y grows downwards: a top that comes with a height and nothing else is where the box begins.
void read_as_screen(Found& y, std::span<const std::string_view> names) {
  const int top = of(y, Role::max);
  if (top == none || plain(names[static_cast<std::size_t>(top)]) != "top" || of(y, Role::size) == none)
    return;
  for (const Role role : {Role::min, Role::centre, Role::position}) {
    if (of(y, role) != none) return;
  }
  std::swap(y[static_cast<std::size_t>(Role::min)], y[static_cast<std::size_t>(Role::max)]);
}

std::optional<Choice> choose(const Found& found) {
  struct Way {
    BoundsForm form;
    Role first;
    Role second;
  };
  static constexpr auto ways = std::to_array<Way>({
      {BoundsForm::min_max, Role::min, Role::max},
      {BoundsForm::min_max, Role::zeroth, Role::first},
      {BoundsForm::min_max, Role::first, Role::second},
      {BoundsForm::centre_half_size, Role::centre, Role::half_size},
      {BoundsForm::centre_half_size, Role::position, Role::half_size},
      {BoundsForm::centre_size, Role::centre, Role::size},
      {BoundsForm::min_size, Role::min, Role::size},
  });
  for (const Way& way : ways) {
    if (of(found, way.first) != none && of(found, way.second) != none)
      return Choice{way.form, of(found, way.first), of(found, way.second)};
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

bool CsvColumns::is_computed() const noexcept {
  return std::any_of(forms.begin(), forms.begin() + dimension,
                     [](BoundsForm form) { return form != BoundsForm::min_max; });
}

std::string CsvColumns::wanted() const {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (places[i] != ignored) list += (list.empty() ? "" : ",") + names[i];
  }
  return list;
}

bool is_column_name(std::string_view name) { return is_frame(name) || is_box(name) || meaning_of(name); }

std::string resolve(std::span<const std::string_view> names, CsvColumns& columns) {
  columns = {};
  columns.names.assign(names.begin(), names.end());
  columns.places.assign(names.size(), CsvColumns::ignored);
  columns.has_frames = std::ranges::any_of(names, is_frame);

  std::array<Found, 3> found;
  for (Found& of_axis : found) of_axis.fill(none);
  int frame = none;
  int box = none;
  for (std::size_t i = 0; i < names.size(); ++i) {
    int* column = nullptr;
    if (const std::optional<Meaning> meaning = meaning_of(names[i]))
      column = &found[static_cast<std::size_t>(meaning->axis)][static_cast<std::size_t>(meaning->role)];
    else if (is_frame(names[i]))
      column = &frame;
    else if (columns.has_frames && is_box(names[i]))
      column = &box;
    else
      continue;
    if (*column != none)
      return fmt::format("columns {} and {} mean the same", shown(names[static_cast<std::size_t>(*column)]),
                         shown(names[i]));
    *column = static_cast<int>(i);
  }

  read_as_screen(found[1], names);

  const auto place = [&columns](int column, int where) {
    columns.places[static_cast<std::size_t>(column)] = where;
  };
  if (columns.has_frames) {
    if (box == none)
      return fmt::format("column {} without a column 'box'", shown(names[static_cast<std::size_t>(frame)]));
    place(frame, CsvColumns::frame);
    place(box, CsvColumns::box);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const Found& of_axis = found[static_cast<std::size_t>(axis)];
    const char letter = axes[static_cast<std::size_t>(axis)];
    if (of(of_axis, Role::min) == none || of(of_axis, Role::max) == none) {
      std::string points = points_of(of_axis, names);
      if (!points.empty()) return points;
    }
    if (const std::optional<Choice> choice = choose(of_axis)) {
      columns.forms[static_cast<std::size_t>(axis)] = choice->form;
      columns.dimension = std::max(2, axis + 1);
      place(choice->first, CsvColumns::first + axis);
      place(choice->second, CsvColumns::second + axis);
      continue;
    }
    const int position = of_axis[static_cast<std::size_t>(Role::position)];
    const int size = of_axis[static_cast<std::size_t>(Role::size)];
    // Beside bounds on the other two, z and depth need not be those of a box.
    if (position != none && size != none && (axis < 2 || columns.is_computed()))
      return fmt::format("column {} may be a minimum or a centre",
                         shown(names[static_cast<std::size_t>(position)]));
    // Maps have depths, and points a z, that are no bounds; what is half a pair of bounds is likely a slip.
    const auto known = std::ranges::find_if(of_axis, [&](int column) {
      return column != none && column != position && column != of(of_axis, Role::third) &&
             (column != size || axis < 2);
    });
    if (known != of_axis.end())
      return fmt::format("column {} alone does not give bounds on the {} axis",
                         shown(names[static_cast<std::size_t>(*known)]), letter);
    if (axis < 2) return fmt::format("no columns that give bounds on the {} axis", letter);
  }
  return {};
}

std::string positional(std::size_t count, CsvColumns& columns) {
  static constexpr std::array<std::string_view, 4> flat = {"min_x", "min_y", "max_x", "max_y"};
  static constexpr std::array<std::string_view, 6> solid = {"min_x", "min_y", "min_z",
                                                            "max_x", "max_y", "max_z"};
  if (count == flat.size()) return resolve(flat, columns);
  if (count == solid.size()) return resolve(solid, columns);
  return fmt::format("{} column{} of numbers and no names", count, count == 1 ? "" : "s");
}

}  // namespace broadside::lab::readers
