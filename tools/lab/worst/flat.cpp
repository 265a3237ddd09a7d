// Families of boxes that are long or flat: plates, shelves, lines and rows.
#include <algorithm>

#include "lab/worst/boxes.hpp"
#include "lab/worst/family.hpp"

namespace broadside::lab::worst {
namespace {

/// Regions side by side, each filled with parallel plates.
struct Plates {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const auto regions = static_cast<std::size_t>(settings.integer("regions"));
    const bool alternate = settings.text("axes") == "alternate";
    const bool lattice = settings.text("layout") == "lattice";
    const double ragged = settings.number("ragged");
    const double in_region = static_cast<double>(count) / static_cast<double>(regions);
    const double thickness = settings.number("neighbours") / (2 * std::max(in_region, 1.0));
    const auto side = static_cast<std::size_t>(
        std::ceil(lattice ? power(static_cast<double>(regions), 1.0 / D) : static_cast<double>(regions)));
    DoubleBoxes<D> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t region = i % regions;
      const int normal = alternate ? static_cast<int>(region % D) : 0;
      std::size_t cell = region;
      Point<D> min;
      Size<D> size;
      for (int axis = 0; axis < D; ++axis) {
        const double corner = lattice || axis == D - 1 ? 1.25 * static_cast<double>(cell % side) : 0;
        if (lattice || axis == D - 1) cell /= side;
        const double cut = ragged * random.fraction();
        min[axis] = corner + (axis == normal ? random.fraction() : cut * random.fraction());
        size[axis] = axis == normal ? thickness : 1 - cut;
      }
      boxes.push_back(box_at<D>(min, size));
    }
    return boxes;
  }
};

/// Wide flat boxes above one another, with small ones standing on them.
struct Shelves {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const auto shelves = std::min<std::size_t>(static_cast<std::size_t>(settings.integer("shelves")), count);
    const double height = 1 / static_cast<double>(shelves);
    const double tall = settings.number("tall") * height;
    const double items = static_cast<double>(count) / static_cast<double>(shelves);
    const double wide = std::min(0.5, power(settings.number("neighbours") / items, 1.0 / (D - 1)) / 2);
    const bool stands = settings.text("items") == "stand";
    DoubleBoxes<D> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_shelf = i < shelves;
      const double floor = static_cast<double>(i % shelves) * height;
      Point<D> min = anywhere<D>(random);
      Size<D> size = cube<D>(wide);
      if (is_shelf) {
        min.fill(0);
        size.fill(1 + wide);
      }
      min[D - 1] = is_shelf ? floor : floor + height * (stands ? 0.01 : 0.02);
      size[D - 1] = is_shelf ? height * 0.01 : tall * 0.9;
      boxes.push_back(box_at<D>(min, size));
    }
    return boxes;
  }
};

/// How many others a line of this length and width touches, if lines run along each of the first `axes` axes
/// in equal parts.
template <int D>
double touched(double length, double width, int axes, double count) {
  double sum = 0;
  for (int a = 0; a < axes; ++a) {
    for (int b = 0; b < axes; ++b) {
      double chance = 1;
      for (int axis = 0; axis < D; ++axis)
        chance *= std::min(1.0, (axis == a ? length : width) + (axis == b ? length : width));
      sum += chance;
    }
  }
  return count * sum / (axes * axes);
}

/// Long thin boxes along the axes.
struct Lines {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const int axes = std::min(static_cast<int>(settings.integer("axes")), D);
    const auto boxes_in_all = static_cast<double>(count);
    const double wanted = settings.number("neighbours");
    double length = settings.number("length");
    // In a plane, lines along both axes cross however thin they are.
    if (D == 2 && axes == 2) length = std::min(length, std::sqrt(wanted / std::max(boxes_in_all, 1.0)));
    double width = 1;
    for (int i = 0; i < 200 && touched<D>(length, width, axes, boxes_in_all) > wanted; ++i) width *= 0.8;
    width = std::min(width, length);
    const auto side = std::ceil(power(std::max(boxes_in_all, 1.0), 1.0 / (D - 1)));
    const bool lattice = settings.text("layout") == "lattice";
    DoubleBoxes<D> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const int along = static_cast<int>(random.below(static_cast<std::uint64_t>(axes)));
      Point<D> min = anywhere<D>(random);
      Size<D> size = cube<D>(width);
      size[along] = length;
      min[along] *= 1 - length;
      for (int axis = 0; lattice && axis < D; ++axis) {
        // Each axis has its own lattice, between the places of the others, because otherwise all lines would
        // cross.
        if (axis != along) min[axis] = (std::floor(min[axis] * side) + along / 3.0) / side;
      }
      boxes.push_back(box_at<D>(min, size));
    }
    return boxes;
  }
};

/// Boxes one after the other, in order.
struct Row {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const double step = 1 / static_cast<double>(std::max<std::size_t>(count, 1));
    const double overlap = settings.number("overlap");
    const std::string& shape = settings.text("shape");
    DoubleBoxes<D> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const double at = static_cast<double>(i) * step;
      Point<D> min;
      Size<D> size;
      for (int axis = 0; axis < D; ++axis) {
        const bool advances = shape == "diagonal" || axis == 0;
        const bool is_wall = shape == "walls" && !advances;
        const bool descends = shape == "diagonal" && axis == D - 1;
        min[axis] = advances ? (descends ? 1 - at : at) : is_wall ? 0 : step * random.fraction();
        size[axis] = is_wall ? 1 : step * overlap;
      }
      boxes.push_back(box_at<D>(min, size));
    }
    return boxes;
  }
};

}  // namespace

InputFamily plates() {
  return family_of<Plates>(
      "plates", "parallel plates in one region or in several side by side",
      {neighbours(), count("regions", "regions of plates", "2", 1, 300),
       choice("axes", "whether regions differ in the plates' axis", {"alternate", "same"}),
       choice("layout", "how the regions stand", {"lattice", "row"}),
       number("ragged", "how much plates differ in their width", "0", 0, 0.9)});
}

InputFamily shelves() {
  return family_of<Shelves>(
      "shelves", "wide flat boxes one above the other, and small ones on them",
      {neighbours(), count("shelves", "wide flat boxes", "30", 1, 3000),
       magnitude("tall", "height of the small ones over the shelves' distance", "0.5", 1e-3, 1),
       choice("items", "whether they touch their shelf", {"stand", "hover"})});
}

InputFamily lines() {
  return family_of<Lines>("lines", "long thin boxes along the axes",
                          {neighbours(), count("axes", "along the first of the axes", "3", 1, 3),
                           magnitude("length", "over the world's side", "1", 1e-3, 1),
                           choice("layout", "where they lie", {"random", "lattice"})});
}

InputFamily row() {
  return family_of<Row>("row", "boxes one after the other, along an axis or a diagonal, in order",
                        {magnitude("overlap", "a box's length over the distance to the next", "1.5", 0.01, 9),
                         choice("shape", "of the row", {"diagonal", "line", "walls"})});
}

}  // namespace broadside::lab::worst
