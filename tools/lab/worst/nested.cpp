// Families of boxes within boxes, and of clusters within clusters.
#include <algorithm>

#include "lab/worst/boxes.hpp"
#include "lab/worst/family.hpp"

namespace broadside::lab::worst {
namespace {

/// Groups of boxes, each box inside the previous one.
struct Dolls {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const auto depth = static_cast<std::size_t>(settings.integer("depth"));
    const double ratio = settings.number("ratio");
    const bool centred = settings.text("inner") == "centred";
    const double outer =
        side_for<D>(settings.number("neighbours") / static_cast<double>(depth * depth), 1 + count / depth);
    DoubleBoxes<D> boxes;
    Point<D> corner{};
    double side = outer;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % depth == 0) {
        corner = anywhere<D>(random);
        side = outer;
      } else {
        const double inner = side / ratio;
        for (double& coordinate : corner) coordinate += centred ? (side - inner) / 2 : 0;
        side = inner;
      }
      boxes.push_back(box_at<D>(corner, cube<D>(side)));
    }
    return boxes;
  }
};

/// Clusters of clusters of boxes.
struct Clusters {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const std::int64_t levels = settings.integer("levels");
    const auto branches = static_cast<std::uint64_t>(settings.integer("branches"));
    const double shrink = settings.number("shrink");
    const std::uint64_t places = random.bits();
    const double leaves = power(static_cast<double>(branches), static_cast<double>(levels));
    const double in_leaf = std::max(1.0, static_cast<double>(count) / leaves);
    const double leaf = power(shrink, static_cast<double>(-levels));
    const double side = leaf * std::min(0.3, power(settings.number("neighbours") / in_leaf, 1.0 / D) / 2);
    DoubleBoxes<D> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      Point<D> min{};
      double extent = 1;
      std::uint64_t node = places;
      for (std::int64_t level = 0; level < levels; ++level) {
        node = Random(node + 1 + random.below(branches)).bits();
        Random place(node);
        extent /= shrink;
        for (double& coordinate : min) coordinate += extent * (shrink - 1) * place.fraction();
      }
      for (double& coordinate : min) coordinate += leaf * random.fraction();
      boxes.push_back(box_at<D>(min, cube<D>(side)));
    }
    return boxes;
  }
};

/// Cantor dust: keeps the two ends of each interval, repeatedly.
struct Dust {
  template <int D>
  static DoubleBoxes<D> make(const Settings& settings, std::size_t count, Random& random) {
    const double kept = settings.number("kept");
    std::int64_t levels = settings.integer("more");
    for (std::size_t cells = 1; cells < count; cells *= D == 2 ? 4 : 8) ++levels;
    const double side = power(kept, static_cast<double>(levels)) * settings.number("fill");
    DoubleBoxes<D> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      Point<D> min{};
      double extent = 1;
      for (std::int64_t level = 0; level < levels; ++level) {
        for (double& coordinate : min) {
          if (random.chance(0.5)) coordinate += extent * (1 - kept);
        }
        extent *= kept;
      }
      boxes.push_back(box_at<D>(min, cube<D>(side)));
    }
    return boxes;
  }
};

}  // namespace

InputFamily dolls() {
  return family_of<Dolls>("dolls", "groups of boxes, each box inside the one before",
                          {neighbours(), count("depth", "boxes of a group", "8", 2, 16),
                           magnitude("ratio", "of a box's side to that of the next inside", "2", 1.01, 1e3),
                           choice("inner", "where a box lies in the one around it", {"centred", "corner"})});
}

InputFamily clusters() {
  return family_of<Clusters>("clusters", "clusters of clusters of boxes",
                             {neighbours(), count("levels", "clusters within each other", "4", 1, 12),
                              count("branches", "clusters in a cluster", "8", 2, 64),
                              magnitude("shrink", "size of a cluster over that of one in it", "20", 2, 1e4)});
}

InputFamily dust() {
  return family_of<Dust>("dust", "Cantor's dust: boxes at the ends of intervals at the ends of intervals",
                         {magnitude("kept", "of an interval, at each end", "0.3333", 0.01, 0.49),
                          number("fill", "a box's side over its interval", "0.9", 0.05, 1),
                          count("more", "levels beyond one box an interval", "1", 1, 12)});
}

}  // namespace broadside::lab::worst
