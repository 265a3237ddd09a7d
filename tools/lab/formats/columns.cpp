// Resolves the columns of a table to boxes.
#include "lab/formats/columns.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

constexpr std::string_view axis_letters = "xyz";

bool is_one_of(std::string_view name, std::span<const std::string_view> list) {
  return std::find(list.begin(), list.end(), plain(name)) != list.end();
}

bool is_frame(std::string_view name) { return plain(name) == "frame"; }

bool is_box(std::string_view name) { return plain(name) == "box"; }

bool is_radius(std::string_view name) { return plain(name) == "radius" || plain(name) == "r"; }

/// Names for columns that identify a box across frames. The first of them that the table has is used.
constexpr auto track_names =
    std::to_array<std::string_view>({"trackid", "track", "objectid", "object", "id"});

/// Names of bounds in one field come before names of geometries, whose rows have to be examined.
constexpr auto geometry_names =
    std::to_array<std::string_view>({"bbox", "bounds", "envelope", "wkt", "geometry", "geom", "thegeom"});

constexpr int none = -1;

/// For each role of an axis, the column that has it.
using Found = std::array<int, roles>;

/// The two columns that give the bounds on an axis.
struct BoundsColumns {
  BoundsForm form;
  int first;
  int second;
};

int of(const Found& found, Role role) { return found[static_cast<std::size_t>(role)]; }

/// The fault if there are coordinates for three or more points, so that the first two are not bounds;
/// otherwise empty.
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

/// Whether an axis has only the begin and end of an interval. Beside other columns, they may be times.
bool is_interval(const Found& found) {
  return of(found, Role::begin) != none && of(found, Role::end) != none &&
         std::count(found.begin(), found.end(), none) == std::ptrdiff_t{roles} - 2;
}

bool is_empty(const Found& found) {
  return std::count(found.begin(), found.end(), none) == std::ptrdiff_t{roles};
}

std::optional<BoundsColumns> choose(const Found& found, int radius, bool are_chosen) {
  struct Way {
    BoundsForm form;
    Role first;
    Role second;
  };
  static constexpr auto ways = std::to_array<Way>({
      {BoundsForm::min_max, Role::min, Role::max},
      {BoundsForm::bottom_top, Role::bottom, Role::top},
      {BoundsForm::min_max, Role::zeroth, Role::first},
      {BoundsForm::min_max, Role::first, Role::second},
      {BoundsForm::centre_half_size, Role::centre, Role::half_size},
      {BoundsForm::centre_half_size, Role::position, Role::half_size},
      {BoundsForm::centre_size, Role::centre, Role::size},
      {BoundsForm::min_size, Role::min, Role::size},
      {BoundsForm::min_size, Role::bottom, Role::size},
      // With only a height, the top is the minimum, as on a screen.
      {BoundsForm::min_size, Role::top, Role::size},
  });
  for (const Way& way : ways) {
    if (of(found, way.first) != none && of(found, way.second) != none)
      return BoundsColumns{way.form, of(found, way.first), of(found, way.second)};
  }
  if (are_chosen && of(found, Role::position) != none && of(found, Role::size) != none)
    return BoundsColumns{BoundsForm::min_size, of(found, Role::position), of(found, Role::size)};
  if (is_interval(found))
    return BoundsColumns{BoundsForm::min_max, of(found, Role::begin), of(found, Role::end)};
  for (const Role role : {Role::centre, Role::position, Role::geographic}) {
    if (radius != none && of(found, role) != none && of(found, Role::size) == none)
      return BoundsColumns{BoundsForm::centre_radius, of(found, role), radius};
  }
  return std::nullopt;
}

/// The column of a position, if an axis has nothing else; otherwise `none`.
int point_of(Found found) {
  for (const Role time : {Role::begin, Role::end}) found[static_cast<std::size_t>(time)] = none;
  const int column =
      of(found, Role::position) != none ? of(found, Role::position) : of(found, Role::geographic);
  return std::count(found.begin(), found.end(), none) == std::ptrdiff_t{roles} - 1 ? column : none;
}

/// The column with the first of these names that occurs.
int first_of(std::span<const std::string_view> names, std::span<const std::string_view> wanted) {
  for (const std::string_view want : wanted) {
    const auto name = std::find_if(names.begin(), names.end(),
                                   [want](std::string_view text) { return plain(text) == want; });
    if (name != names.end()) return static_cast<int>(name - names.begin());
  }
  return none;
}

/// The column of a radius. Beside g and b, r is a colour.
int radius_of(std::span<const std::string_view> names) {
  const auto find = [names](std::string_view wanted) { return first_of(names, {&wanted, 1}); };
  const bool is_colour = find("g") != none && find("b") != none;
  return is_colour || find("radius") != none ? find("radius") : find("r");
}

/// The fault of an axis without bounds; empty for a z axis that needs no bounds.
std::string problem_of(const Found& found, std::size_t axis, std::span<const std::string_view> names,
                       bool is_computed) {
  const int position = of(found, Role::position);
  const int size = of(found, Role::size);
  // If the other two axes have bounds, z and depth may be unrelated to the box.
  if (position != none && size != none && (axis < 2 || is_computed))
    return fmt::format("column {} may be a minimum or a centre",
                       shown(names[static_cast<std::size_t>(position)]));
  // Maps have depths, and points a z, that are not bounds. Half of a pair of bounds is probably a mistake.
  const auto known = std::find_if(found.begin(), found.end(), [&](int column) {
    return column != none && column != position && column != of(found, Role::geographic) &&
           column != of(found, Role::third) && column != of(found, Role::begin) &&
           column != of(found, Role::end) && (column != size || axis < 2);
  });
  if (known != found.end())
    return fmt::format("column {} alone does not give bounds on the {} axis",
                       shown(names[static_cast<std::size_t>(*known)]), axis_letters[axis]);
  return axis < 2 ? fmt::format("no columns that give bounds on the {} axis", axis_letters[axis]) : "";
}

/// Resolves the columns as points, if they have nothing but positions; false if they have more or less.
bool resolve_points(const std::array<Found, 3>& found, BoxColumns& columns) {
  const int x = point_of(found[0]);
  const int y = point_of(found[1]);
  const int z = point_of(found[2]);
  if (x == none || y == none) return false;
  columns.forms.fill(BoundsForm::point);
  columns.places[static_cast<std::size_t>(x)] = BoxColumns::first;
  columns.places[static_cast<std::size_t>(y)] = BoxColumns::first + 1;
  if (z != none) {
    columns.places[static_cast<std::size_t>(z)] = BoxColumns::first + 2;
    columns.dimension = 3;
  }
  return true;
}

/// Finds the columns that boxes are made of. Returns the fault, if any.
std::string resolve_bounds(std::span<const std::string_view> names, const std::array<Found, 3>& found,
                           bool are_chosen, BoxColumns& columns) {
  const BoxColumns before = columns;
  const auto place = [&columns](int column, int where) {
    columns.places[static_cast<std::size_t>(column)] = where;
  };
  const int radius = radius_of(names);
  const int geometry = first_of(names, geometry_names);
  std::string problem;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Found& of_axis = found[axis];
    if ((of(of_axis, Role::min) == none || of(of_axis, Role::max) == none) &&
        (of(of_axis, Role::bottom) == none || of(of_axis, Role::top) == none)) {
      std::string points = points_of(of_axis, names);
      if (!points.empty()) return points;
    }
    if (const std::optional<BoundsColumns> choice = choose(of_axis, radius, are_chosen)) {
      const int of_form = static_cast<int>(axis);
      columns.forms[axis] = choice->form;
      columns.dimension = std::max(2, of_form + 1);
      place(choice->first, BoxColumns::first + of_form);
      place(choice->second,
            choice->form == BoundsForm::centre_radius ? BoxColumns::radius : BoxColumns::second + of_form);
    } else if (axis == 1 && is_interval(found[0]) && is_empty(of_axis) && is_empty(found[2]) &&
               geometry == none) {
      columns.forms[axis] = BoundsForm::flat;
    } else if (problem.empty()) {
      problem = problem_of(of_axis, axis, names, columns.is_computed());
    }
  }
  if (problem.empty()) return {};
  columns = before;
  if (geometry != none) {
    columns.has_geometry = true;
    place(geometry, BoxColumns::geometry);
    return {};
  }
  if (!resolve_points(found, columns)) return problem;
  // A z beside other columns need not belong to a point.
  return point_of(found[2]) == none ? problem_of(found[2], 2, names, true) : "";
}

}  // namespace

bool BoxColumns::is_computed() const noexcept {
  if (has_geometry) return computes_bounds(geometry_form);
  return std::any_of(forms.begin(), forms.begin() + dimension, computes_bounds);
}

std::string BoxColumns::wanted() const {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (places[i] != ignored) list += (list.empty() ? "" : ",") + names[i];
  }
  return list;
}

bool is_column_name(std::string_view name) {
  return is_frame(name) || is_box(name) || is_radius(name) || meaning_of(name);
}

bool gives_bounds(std::string_view name) {
  return is_radius(name) || meaning_of(name) || is_geometry_name(name);
}

bool is_geometry_name(std::string_view name) { return is_one_of(name, geometry_names); }

std::string resolve(std::span<const std::string_view> names, BoxColumns& columns, bool are_chosen) {
  columns = {};
  columns.names.assign(names.begin(), names.end());
  columns.places.assign(names.size(), BoxColumns::ignored);
  columns.has_frames = std::any_of(names.begin(), names.end(), is_frame);

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

  const auto place = [&columns](int column, int where) {
    columns.places[static_cast<std::size_t>(column)] = where;
  };
  if (columns.has_frames) {
    const int track = box == none ? first_of(names, track_names) : none;
    columns.has_tracks = box == none;
    place(frame, BoxColumns::frame);
    if (box != none) place(box, BoxColumns::box);
    if (track != none) place(track, BoxColumns::track);
  }
  return resolve_bounds(names, found, are_chosen, columns);
}

void settle_top(BoxColumns& columns, bool top_is_min) {
  constexpr int y = 1;
  if (columns.forms[y] != BoundsForm::bottom_top) return;
  columns.forms[y] = BoundsForm::min_max;
  if (!top_is_min) return;
  std::swap(*std::find(columns.places.begin(), columns.places.end(), BoxColumns::first + y),
            *std::find(columns.places.begin(), columns.places.end(), BoxColumns::second + y));
}

std::string positional(std::size_t count, BoxColumns& columns) {
  static constexpr std::array<std::string_view, 4> flat = {"min_x", "min_y", "max_x", "max_y"};
  static constexpr std::array<std::string_view, 6> solid = {"min_x", "min_y", "min_z",
                                                            "max_x", "max_y", "max_z"};
  if (count == flat.size()) return resolve(flat, columns);
  if (count == solid.size()) return resolve(solid, columns);
  return fmt::format("{} column{} of numbers and no names", count, count == 1 ? "" : "s");
}

std::vector<std::string> other_meanings(const BoxColumns& columns, bool are_named) {
  const auto axes = static_cast<std::size_t>(columns.dimension);
  const bool has_bounds =
      !columns.has_geometry && std::all_of(columns.forms.begin(), columns.forms.begin() + columns.dimension,
                                           [](BoundsForm form) { return form == BoundsForm::min_max; });
  if (!has_bounds) return {};
  // `bound` returns the name of a minimum (0) or a maximum (1) on an axis.
  const auto named = [&](const auto& bound) {
    std::string list;
    std::size_t end = 0;
    for (std::size_t i = 0; i < columns.places.size(); ++i) {
      const int place = columns.places[i];
      std::string name = "-";
      if (place >= BoxColumns::first && place < BoxColumns::first + 3)
        name = bound(0, static_cast<std::size_t>(place - BoxColumns::first));
      else if (place >= BoxColumns::second && place < BoxColumns::second + 3)
        name = bound(1, static_cast<std::size_t>(place - BoxColumns::second));
      else if (place != BoxColumns::ignored || plain(columns.names[i]) == "id")
        name = columns.names[i];
      list += (i == 0 ? "" : ",") + name;
      if (name != "-") end = list.size();
    }
    list.resize(end);
    return list;
  };
  std::vector<std::string> lists;
  // A maximum before its minimum, such as top before bottom if y grows upwards, is not a size.
  const auto column_at = [&](int place) {
    return std::find(columns.places.begin(), columns.places.end(), place);
  };
  bool may_be_sizes = !are_named;
  for (int axis = 0; axis < columns.dimension; ++axis)
    may_be_sizes &= column_at(BoxColumns::first + axis) < column_at(BoxColumns::second + axis);
  if (may_be_sizes)
    lists.push_back(named([](int bound, std::size_t axis) {
      return std::string(1, bound == 0 ? axis_letters[axis] : "whd"[axis]);
    }));
  for (std::size_t exchanged = 1; exchanged < std::size_t{1} << axes; ++exchanged)
    lists.push_back(named([exchanged](int bound, std::size_t axis) {
      const bool is_min = (bound == 0) != ((exchanged >> axis & 1) != 0);
      return fmt::format("{}_{}", is_min ? "min" : "max", axis_letters[axis]);
    }));
  return lists;
}

std::vector<std::string> corner_or_centre(std::span<const std::string_view> names) {
  const auto has_size = [names](int axis) {
    return std::any_of(names.begin(), names.end(), [axis](std::string_view name) {
      const std::optional<Meaning> meaning = meaning_of(name);
      return meaning && meaning->role == Role::size && meaning->axis == axis;
    });
  };
  std::string corner;
  std::string centre;
  std::size_t end = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<Meaning> meaning = meaning_of(names[i]);
    const bool is_position = meaning && meaning->role == Role::position && has_size(meaning->axis);
    const bool is_kept = is_position || (meaning && meaning->role == Role::size) || is_frame(names[i]) ||
                         is_one_of(names[i], track_names);
    if (is_kept) end = i + 1;
    corner += fmt::format(",{}", is_kept ? names[i] : "-");
    centre += fmt::format(
        ",{}", is_position ? fmt::format("c{}", axis_letters[static_cast<std::size_t>(meaning->axis)])
               : is_kept   ? std::string(names[i])
                           : "-");
  }
  // Drops the ',-' of the columns after the last named one.
  for (std::size_t i = end; i < names.size(); ++i) {
    corner.resize(corner.size() - 2);
    centre.resize(centre.size() - 2);
  }
  if (end == 0) return {};
  return {corner.substr(1), centre.substr(1)};
}

std::vector<std::string> unnamed_meanings(std::size_t count) {
  switch (count) {
    case 4:
      return {"min_x,max_x,min_y,max_y"};
    case 5:
      // YOLO's labels: a box after or before its class, number or score.
      return {"-,cx,cy,w,h", "-,left,top,right,bottom", "left,top,right,bottom"};
    case 6:
      return {"-,cx,cy,w,h", "-,-,left,top,right,bottom", "-,left,top,right,bottom", "left,top,right,bottom"};
    case 8:
      return {"-,x,y,w,h", "frame,id,left,top,width,height"};  // Make Sense
    case 7:
    case 9:
    case 10:
      return {"frame,id,left,top,width,height"};  // MOT Challenge
    case 15:
    case 16:
      return {"-,-,-,-,left,top,right,bottom"};  // KITTI's labels of objects
    case 17:
    case 18:
      return {"frame,id,-,-,-,-,left,top,right,bottom"};  // and of tracks
    default:
      return {};
  }
}

}  // namespace broadside::lab::readers
