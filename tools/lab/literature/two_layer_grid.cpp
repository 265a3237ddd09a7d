// Tsitsigkos, Lampropoulos, Bouros, Mamoulis and Terrovitis 2021, "A Two-layer Partitioning for Non-point
// Spatial Data" (ICDE; extended as Tsitsigkos et al. 2024, "Two-layer Space-oriented Partitioning for
// Non-point Data", IEEE TKDE 36(3), arXiv 2307.09256). A uniform grid has a box in each tile that it touches,
// and a tile divides its boxes into classes by where they begin: A in this tile, B before it on the second
// axis, C before it on the first, D before it on both. Two boxes of classes that begin before the tile on the
// same axis are also together in an earlier tile. So only nine of the sixteen combinations of classes are
// joined, and each pair is found exactly once without a reference point. Each combination is a join of its
// own ("mini-join"). This has both of the authors' optimisations: it does not compare a bound that the
// classes decide, and it sorts a class that begins before the tile on the sweep axis by its maxima, so that
// all boxes that reach a place are together at the back.
//
// Differences: in 3D there are three axes, eight classes and 27 combinations. A single set is joined with
// itself, in five combinations (14 in 3D). References of all classes store all bounds, where the authors drop
// the bounds that are never compared. The number of tiles has a default, and is halved if boxes would have
// too many references. Single-threaded.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lab/literature/cut_axis.hpp"
#include "lab/literature/literature.hpp"
#include "lab/literature/tile_partition.hpp"

namespace broadside::lab::literature {
namespace {

/// The default width of a tile in mean extents of the boxes; the minimum number of boxes per tile.
constexpr double extents_per_tile = 2;
constexpr double boxes_per_tile = 4;

/// With more references per box on average, tiles are made larger.
constexpr std::size_t max_references_per_box = 8;

/// Whether boxes of class P and of class Q that overlap on the first axis overlap on the others. A box that
/// begins before the tile begins before the end of any box that begins in it.
template <int D, BoxClass P, BoxClass Q>
bool meets_beside(const Box<D>& p, const Box<D>& q) noexcept {
  bool meets = true;
  for (int axis = 1; axis < D; ++axis) {
    if ((P & before_on(axis)) == 0) meets &= p.min[axis] <= q.max[axis];
    if ((Q & before_on(axis)) == 0) meets &= q.min[axis] <= p.max[axis];
  }
  return meets;
}

template <int D>
class TwoLayerGrid final : public Searcher<D> {
 public:
  explicit TwoLayerGrid(const Settings& settings)
      : tiles_(settings.is_auto("tiles") ? 0 : static_cast<std::size_t>(settings.integer("tiles"))) {}

  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    if (input.boxes.empty()) return std::nullopt;
    boxes_.assign(input.boxes.begin(), input.boxes.end());  // read twice, and must not change in between
    const std::span<const Box<D>> boxes = boxes_;
    const TileGrid<D> grid = fitting_grid(boxes);
    Checkpoint checkpoint(input.workers.checkpoint);
    if (input.left_count == 0) {
      left_.fill(grid, boxes, 0);
      for (std::size_t tile = 0; tile < grid.tiles(); ++tile) join_tile(tile, checkpoint, pairs);
    } else {
      left_.fill(grid, boxes.first(input.left_count), 0);
      right_.fill(grid, boxes.subspan(input.left_count), static_cast<std::uint32_t>(input.left_count));
      for (std::size_t tile = 0; tile < grid.tiles(); ++tile) join_tiles(tile, checkpoint, pairs);
    }
    return std::nullopt;
  }

 private:
  using Run = typename TilePartition<D>::Run;

  /// At most as many tiles as boxes, and not too many references.
  TileGrid<D> fitting_grid(std::span<const Box<D>> boxes) const {
    std::array<Extent, D> extents;
    for (int axis = 0; axis < D; ++axis) extents[axis] = extent_of<D>(boxes, axis);
    std::array<double, D> wanted =
        tiles_ == 0 ? standard_tiles(extents, boxes.size()) : square_tiles(extents);
    shrink(wanted, static_cast<double>(boxes.size()));
    for (;;) {
      TileGrid<D> grid;
      for (int axis = 0; axis < D; ++axis)
        grid.axes[axis] = extents[axis].cut(static_cast<std::size_t>(wanted[axis]));
      if (grid.tiles() == 1) return grid;
      std::size_t references = 0;
      for (const Box<D>& box : boxes) references += TileRange<D>(grid, box).count();
      if (references <= max_references_per_box * boxes.size()) return grid;
      for (double& tiles : wanted) tiles = std::max(1.0, tiles / 2);
    }
  }

  /// Square tiles, with the requested number along the longest axis.
  std::array<double, D> square_tiles(const std::array<Extent, D>& extents) const {
    const double longest = std::ranges::max(extents, {}, &Extent::length).length();
    std::array<double, D> tiles;
    for (int axis = 0; axis < D; ++axis)
      tiles[axis] =
          longest > 0 ? std::ceil(static_cast<double>(tiles_) * (extents[axis].length() / longest)) : 1;
    return tiles;
  }

  static std::array<double, D> standard_tiles(const std::array<Extent, D>& extents, std::size_t boxes) {
    const auto box_count = static_cast<double>(boxes);
    std::array<double, D> tiles;
    for (int axis = 0; axis < D; ++axis) {
      const double length = extents[axis].length();
      const double side = std::max(extents_per_tile * extents[axis].mean, length / box_count);
      tiles[axis] = length > 0 ? length / side : 1;
    }
    shrink(tiles, box_count / boxes_per_tile);
    return tiles;
  }

  /// Limits `tiles` to at least 1 on each axis and at most `max_tiles` in all, by the same factor on each
  /// axis if possible.
  static void shrink(std::array<double, D>& tiles, double max_tiles) {
    for (double& count : tiles) count = count > 1 ? count : 1;
    // Each step may reduce another axis to 1.
    for (int step = 0; step < D; ++step) {
      double all = 1;
      int divided = 0;
      for (const double count : tiles) {
        all *= count;
        divided += count > 1 ? 1 : 0;
      }
      if (all <= max_tiles || divided == 0) return;
      const double factor = std::pow(std::max(max_tiles, 1.0) / all, 1.0 / divided);
      for (double& count : tiles) count = std::max(1.0, count * factor);
    }
  }

  /// Joins a tile of the only set with itself.
  void join_tile(std::size_t tile, Checkpoint& checkpoint, PairSink& pairs) {
    left_.sort(tile, left_);
    join_within(left_.run(tile, 0), checkpoint, pairs);
    for_each_combination([&]<BoxClass P, BoxClass Q>() {
      if constexpr (P < Q) join<P, Q>(left_.run(tile, P), left_.run(tile, Q), checkpoint, pairs);
    });
    checkpoint.count(1);
  }

  /// Joins a tile of the left set with that of the right one.
  void join_tiles(std::size_t tile, Checkpoint& checkpoint, PairSink& pairs) {
    left_.sort(tile, right_);
    right_.sort(tile, left_);
    for_each_combination([&]<BoxClass P, BoxClass Q>() {
      join<P, Q>(left_.run(tile, P), right_.run(tile, Q), checkpoint, pairs);
    });
    checkpoint.count(1);
  }

  /// Calls `visit` with each two classes that are joined.
  template <typename Visit>
  static void for_each_combination(const Visit& visit) {
    const auto of_one = [&visit]<BoxClass P, BoxClass... Q>(std::integral_constant<BoxClass, P>,
                                                            std::integer_sequence<BoxClass, Q...>) {
      const auto of_both = [&visit]<BoxClass Other>() {
        if constexpr ((P & Other) == 0) visit.template operator()<P, Other>();
      };
      (of_both.template operator()<Q>(), ...);
    };
    constexpr std::make_integer_sequence<BoxClass, class_count<D>> classes;
    [&]<BoxClass... P>(std::integer_sequence<BoxClass, P...>) {
      (of_one(std::integral_constant<BoxClass, P>(), classes), ...);
    }
    (classes);
  }

  /// The forward scan of a class with itself: only A has no bit in common with itself.
  static void join_within(Run run, Checkpoint& checkpoint, PairSink& pairs) {
    for (auto p = run.begin(); p != run.end(); ++p) {
      auto q = p + 1;
      for (; q != run.end() && q->box.min[0] <= p->box.max[0]; ++q) {
        if (meets_beside<D, 0, 0>(p->box, q->box)) pairs.add(BoxId{p->id}, BoxId{q->id});
      }
      checkpoint.count(static_cast<std::uint64_t>(q - p));
    }
  }

  template <BoxClass P, BoxClass Q>
  static void join(Run left, Run right, Checkpoint& checkpoint, PairSink& pairs) {
    if (left.empty() || right.empty()) return;
    if constexpr ((P & before_on(0)) != 0)
      join_reaching<P, Q>(left, right, checkpoint, pairs);
    else if constexpr ((Q & before_on(0)) != 0)
      join_reaching<Q, P>(right, left, checkpoint, pairs);
    else
      join_scanning<P, Q>(left, right, checkpoint, pairs);
  }

  /// `before` begins before the tile on the sweep axis and is sorted by its maxima: it overlaps on this axis
  /// all boxes that begin in the tile up to these maxima.
  template <BoxClass Before, BoxClass In>
  static void join_reaching(Run before, Run in, Checkpoint& checkpoint, PairSink& pairs) {
    auto reaching = before.begin();
    for (const TileReference<D>& q : in) {
      while (reaching != before.end() && reaching->box.max[0] < q.box.min[0]) ++reaching;
      if (reaching == before.end()) return;
      for (auto p = reaching; p != before.end(); ++p) {
        if (meets_beside<D, Before, In>(p->box, q.box)) pairs.add(BoxId{p->id}, BoxId{q.id});
      }
      checkpoint.count(static_cast<std::uint64_t>(before.end() - reaching));
    }
  }

  /// The forward scan: takes the next box that begins first, from either class, and compares it with the
  /// other class's boxes from there on.
  template <BoxClass P, BoxClass Q>
  static void join_scanning(Run left, Run right, Checkpoint& checkpoint, PairSink& pairs) {
    auto p = left.begin();
    auto q = right.begin();
    while (p != left.end() && q != right.end()) {
      if (p->box.min[0] <= q->box.min[0]) {
        auto other = q;
        for (; other != right.end() && other->box.min[0] <= p->box.max[0]; ++other) {
          if (meets_beside<D, P, Q>(p->box, other->box)) pairs.add(BoxId{p->id}, BoxId{other->id});
        }
        checkpoint.count(static_cast<std::uint64_t>(other - q) + 1);
        ++p;
      } else {
        auto other = p;
        for (; other != left.end() && other->box.min[0] <= q->box.max[0]; ++other) {
          if (meets_beside<D, P, Q>(other->box, q->box)) pairs.add(BoxId{other->id}, BoxId{q->id});
        }
        checkpoint.count(static_cast<std::uint64_t>(other - p) + 1);
        ++q;
      }
    }
  }

  std::size_t tiles_;  // along the longest axis; 0 chooses the number by the boxes
  std::vector<Box<D>> boxes_;
  TilePartition<D> left_;  // all boxes, if there is one set
  TilePartition<D> right_;
};

}  // namespace

Algorithm two_layer_grid() {
  return {
      .name = "two_layer_grid",
      .summary = "two-layer partitioning: tiles whose boxes are in classes by where they begin",
      .source = "Tsitsigkos et al. 2021, A Two-layer Partitioning for Non-point Spatial Data",
      .kind = AlgorithmKind::literature,
      .tunables =
          {{.name = "tiles",
            .summary =
                "square tiles along the longest axis; fewer if boxes would be in more than 8 on average",
            .default_value = "auto",
            .type = Tunable::Type::integer,
            .min = 1,
            .max = 1e6}},
      .in_2d = {.searcher = make_strategy<TwoLayerGrid<2>>},
      .in_3d = {.searcher = make_strategy<TwoLayerGrid<3>>},
  };
}

}  // namespace broadside::lab::literature
