// Families of uniform boxes, and of boxes whose sizes or places differ by orders of magnitude.
#include <algorithm>

#include "lab/worst/boxes.hpp"
#include "lab/worst/family.hpp"

namespace broadside::lab::worst {
namespace {

struct Even {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    DoubleBoxes<D> boxes = even_boxes<D>(count, settings.number("neighbours"), random);
    const double squeeze = settings.number("squeeze");
    for (Box<D, double>& box : boxes) {
      box.min[D - 1] *= squeeze;
      box.max[D - 1] *= squeeze;
    }
    return boxes;
  }
};

/// Sizes, places or both follow a power law.
struct Magnitudes {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    return settings.text("of") == "sizes" ? sizes<D>(settings, count, random)
                                          : places<D>(settings, count, random);
  }

  /// In a cube in which they touch the wanted number of others.
  template <int D>
  static DoubleBoxes<D> sizes(const Settings& settings, std::size_t count, Random& random) {
    const double decades = settings.number("decades");
    const bool rare = settings.text("large") == "rare";
    std::vector<Size<D>> all(count);
    for (Size<D>& size : all) {
      size = modest_size<D>(random);
      const double fraction = random.fraction();
      // A hundredth of the boxes is larger than 10^-(decades / 10) of the largest.
      const double scale = power(10, -decades * (rare ? 1 - power(fraction + 1e-9, 40) : fraction));
      for (double& extent : size) extent *= scale;
    }
    const double side = world_side<D>(all, settings.number("neighbours"));
    DoubleBoxes<D> boxes;
    for (Size<D>& size : all) {
      for (double& extent : size) extent /= side > 0 ? side : 1;
      boxes.push_back(box_at<D>(anywhere<D>(random), size));
    }
    return boxes;
  }

  /// The logarithm of each coordinate is uniform, and each box is as large as its distance from the axes
  /// allows.
  template <int D>
  static DoubleBoxes<D> places(const Settings& settings, std::size_t count, Random& random) {
    const double decades = settings.number("decades");
    const bool both_sides = settings.text("sides") == "both";
    const bool together = settings.text("of") == "distances";
    const double natural = 2.302585 * decades;  // the natural logarithm of the whole range
    const int free_axes = together ? 1 : D;
    const double part = std::min(
        0.5, natural *
                 power(settings.number("neighbours") / static_cast<double>(std::max<std::size_t>(count, 1)),
                       1.0 / free_axes) /
                 2);
    DoubleBoxes<D> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      Point<D> min;
      Size<D> size;
      const double distance = power(10, -decades * random.fraction());
      for (int axis = 0; axis < D; ++axis) {
        // Numbers from 1 to 2 on the other axes, so that all boxes at the same distance are near each other.
        const double value = !together   ? power(10, -decades * random.fraction())
                             : axis == 0 ? distance
                                         : distance * random.between(1, 2);
        size[axis] = value * part;
        min[axis] = both_sides && random.chance(0.5) ? -value - size[axis] : value;
      }
      boxes.push_back(box_at<D>(min, size));
    }
    return boxes;
  }
};

/// Heaps of boxes, each at one place, surrounded by uniform boxes.
struct Heaps {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const auto heaps = static_cast<double>(settings.integer("heaps"));
    // All heaps together have at most 5 pairs per box.
    const double max_in_heap = std::sqrt(10 * static_cast<double>(count) / heaps);
    const auto in_heap = static_cast<std::size_t>(settings.number("part") * max_in_heap);
    const auto in_heaps = std::min(count, in_heap * static_cast<std::size_t>(heaps));
    const double side = settings.text("boxes") == "points" ? 0 : side_for<D>(1, count);
    DoubleBoxes<D> boxes = even_boxes<D>(count - in_heaps, 1, random);
    Point<D> place{};
    for (std::size_t i = 0; i < in_heaps; ++i) {
      if (i % in_heap == 0) place = anywhere<D>(random);
      boxes.push_back(box_at<D>(place, cube<D>(side)));
    }
    return boxes;
  }
};

/// A few huge boxes among many small ones.
struct Giants {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const auto giants = std::min(static_cast<std::size_t>(settings.integer("giants")), count);
    // Each touches `covered` / giants of all boxes.
    const double part = std::min(1.0, settings.number("covered") / static_cast<double>(giants));
    const bool bars = settings.text("shape") == "bars";
    DoubleBoxes<D> boxes = even_boxes<D>(count - giants, settings.number("neighbours"), random);
    for (std::size_t i = 0; i < giants; ++i) {
      Size<D> size = cube<D>(power(part, 1.0 / (bars ? D - 1 : D)));
      if (bars) size[i % D] = 1;
      Point<D> min = anywhere<D>(random);
      for (int axis = 0; axis < D; ++axis) min[axis] *= 1 - size[axis];
      boxes.push_back(box_at<D>(min, size));
    }
    return boxes;
  }
};

}  // namespace

InputFamily even() {
  return family_of<Even>("even", "boxes of about one size, anywhere alike",
                         {neighbours(), magnitude("squeeze", "of the last axis", "1", 1e-12, 1)});
}

InputFamily magnitudes() {
  return family_of<Magnitudes>(
      "magnitudes", "sizes or places of every order of magnitude",
      {neighbours(), choice("of", "what differs", {"places", "sizes", "distances"}),
       number("decades", "orders of magnitude", "20", 1, 60),
       choice("sides", "whether coordinates have both signs", {"one", "both"}),
       choice("large", "whether large boxes are as many as small ones", {"alike", "rare"})});
}

InputFamily heaps() {
  return family_of<Heaps>("heaps", "heaps of boxes in one place each among even ones",
                          {count("heaps", "places", "1", 1, 3000),
                           number("part", "of the boxes that 5 pairs a box allow", "1", 0.1, 1),
                           choice("boxes", "in a heap", {"boxes", "points"})});
}

InputFamily giants() {
  return family_of<Giants>("giants", "a few huge boxes among many small ones",
                           {neighbours(), count("giants", "huge boxes", "5", 1, 3000),
                            number("covered", "how many huge boxes lie over a place on average", "4", 0.1, 6),
                            choice("shape", "of the huge ones", {"cubes", "bars"})});
}

}  // namespace broadside::lab::worst
