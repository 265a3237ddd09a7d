// The grid, frame after frame: boxes stay in their cells, and those that moved change cells.
//
// Sections VI-A and VI-B of the paper. A mover is compared with what is in the cells of its old box and of
// its new one, and then filed anew: by reinsertion, which takes it from all its cells and files it in the new
// ones, or by translation, which touches only the cells that it leaves or enters and brings its box up to
// date in the others. Where most boxes move, all pairs are found anew.
#include "algorithms/grid/tracker.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "algorithms/grid/cells.hpp"
#include "core/sample.hpp"
#include "interface/incremental_tracker.hpp"
#include "kernels/toggle.hpp"

namespace broadside::own {
namespace {

/// The fraction of changed boxes from which finding all pairs anew is not slower.
template <int D>
constexpr double worthwhile = D == 2 ? 0.4 : 0.3;

/// As many boxes in a cell as fill a block without too often needing a second one.
constexpr double boxes_per_cell = 12;

/// So many movers are looked at together, so that their cells are on the way when their turn comes.
constexpr std::size_t movers_at_once = 8;

template <int D>
class GridTracker final : public core::IncrementalTracker<D> {
  using Base = core::IncrementalTracker<D>;
  using Cells = GridCells<D>;
  using Block = typename Cells::Block;
  using Place = typename Cells::Place;

 public:
  GridTracker(typename Base::Way way, bool translates, std::optional<double> cell, int span,
              std::unique_ptr<PairFinder<D>> finder)
      : Base(way, worthwhile<D>, std::move(finder)), translates_(translates), cell_(cell), span_(span) {}

 private:
  struct Step {
    BoxId id;
    bool refiltered;
    bool was_present;
    bool is_present;
    bool stays;  // in all its cells
    Place before;
    Place now;
    std::uint32_t version;  // of the cells, for
    std::uint32_t count;    // the first blocks of its level's cells, or 0 where they are many
    std::array<Block*, Cells::most_near> blocks;
  };

  void follow(const Change<D>& change, PairSink& begun, PairSink& ended) override {
    if (change.rebuild || is_outgrown_) start(change);
    statistics_ = {};
    std::array<Step, movers_at_once> steps;
    std::size_t count = 0;
    const auto take_all = [&] {
      for (std::size_t i = 0; i < count; ++i) take(change, steps[i], begun, ended);
      count = 0;
    };
    for (const BoxId id : change.changed) {
      const Box<D>& before = change.before[index(id)];
      const Box<D>& now = change.now[index(id)];
      Step& step = steps[count];
      step.id = id;
      step.refiltered = Base::is_refiltered(change, id);
      if (!step.refiltered && before == now) continue;
      step.was_present = is_present(before);
      step.is_present = is_present(now);
      if (step.was_present) step.before = cells_.place_of(before);
      if (step.is_present) step.now = cells_.place_of(now);
      find_blocks(step);
      if (++count == steps.size()) take_all();
    }
    take_all();
    statistics_.references = cells_.references();
    statistics_.cells = cells_.cells();
    this->count(statistics_);
    look_at_sizes(change);
  }

  /// Looks up the blocks of the box's cells, which are few where it moves a little, and asks for them.
  void find_blocks(Step& step) {
    step.stays = false;
    step.count = 0;
    if (!step.was_present || !step.is_present || step.before.level != step.now.level) {
      if (step.was_present) cells_.prefetch(step.before);
      if (step.is_present) cells_.prefetch(step.now);
      return;
    }
    const int level = step.now.level;
    const CellRange<D> before = Cells::cells_at(level, step.before.finest);
    const CellRange<D> now = Cells::cells_at(level, step.now.finest);
    CellRange<D> both;
    std::int32_t changes = 0;
    for (int axis = 0; axis < D; ++axis) {
      changes |= (before.first[axis] ^ now.first[axis]) | (before.last[axis] ^ now.last[axis]);
      both.first[axis] = std::min(before.first[axis], now.first[axis]);
      both.last[axis] = std::max(before.last[axis], now.last[axis]);
    }
    step.stays = changes == 0 && translates_;
    step.version = cells_.version();
    step.count = cells_.find_near(level, both, step.blocks.data());
  }

  /// One changed box: its events, then its cells.
  void take(const Change<D>& change, const Step& step, PairSink& begun, PairSink& ended) {
    blocks_.clear();
    std::uint32_t levels = cells_.occupied();
    if (step.count > 0 && step.version == cells_.version()) {
      for (std::uint32_t i = 0; i < step.count; ++i) cells_.add_cell(*step.blocks[i], blocks_);
      levels &= ~(1U << step.now.level);
    }
    for (; levels != 0; levels &= levels - 1) gather(step, std::countr_zero(levels));
    const std::size_t room = (blocks_.size() + 1) * Block::places;
    // `ended_` grows last: where it has room both have, also after memory ran out in between.
    if (ended_.size() < room) {
      begun_.resize(2 * room);
      ended_.resize(2 * room);
    }
    for (const Block* block : blocks_) statistics_.tests += Cells::filled(*block);
    const Box<D>& now = change.now[index(step.id)];
    kernels::StepEvents events{begun_.data(), ended_.data()};
    kernels::take_step(kernels::mover_of(change.before[index(step.id)], now, step.id, step.refiltered),
                       blocks_.data(), blocks_.size(), events);
    statistics_.hits += events.hits;
    for (std::size_t i = 0; i < events.begun_count; ++i)
      Base::report_toggle(change, step.id, BoxId(begun_[i]), true, begun, ended);
    for (std::size_t i = 0; i < events.ended_count; ++i)
      Base::report_toggle(change, step.id, BoxId(ended_[i]), false, begun, ended);
    visited_ += blocks_.size();
    if (step.stays) return;
    if (translates_ && step.was_present && step.is_present && step.before.level == step.now.level) {
      translate(step, now);
    } else {
      if (step.was_present) cells_.erase(step.before, step.id);
      if (step.is_present) cells_.insert(step.now, now, step.id);
    }
    cells_.fit_tables();
  }

  void gather(const Step& step, int level) {
    CellRange<D> before{};
    CellRange<D> now{};
    if (step.was_present) before = Cells::cells_at(level, step.before.finest);
    if (step.is_present) {
      now = Cells::cells_at(level, step.now.finest);
      cells_.gather(level, now, nullptr, blocks_);
    }
    if (step.was_present && !(step.is_present && before == now))
      cells_.gather(level, before, step.is_present ? &now : nullptr, blocks_);
  }

  /// Takes the box from the cells that it has left and files it in those that it has entered.
  void translate(const Step& step, const Box<D>& box) {
    const int level = step.now.level;
    const CellRange<D> before = Cells::cells_at(level, step.before.finest);
    const CellRange<D> now = Cells::cells_at(level, step.now.finest);
    for_each_cell<D>(before, [&](const auto& cell) {
      if (!now.contains(cell)) cells_.erase(level, cell, step.id);
    });
    for_each_cell<D>(now, [&](const auto& cell) {
      if (!before.contains(cell)) cells_.insert(level, cell, box, step.id);
    });
  }

  void start(const Change<D>& change) {
    sizes_ = sizes_for(change);
    cells_.start(sizes_, span_, change.before, change.now);
    is_outgrown_ = false;
    visited_ = 0;
  }

  /// The sizes of cells that suit the boxes of a sample.
  std::array<double, D> sizes_for(const Change<D>& change) {
    std::array<double, D> sizes;
    if (cell_) {
      sizes.fill(*cell_);
      return sizes;
    }
    const std::size_t count = this->take_sample(change.now, sample_, sampled_);
    // As many cells on an axis as there would be boxes if they stood in a square or a cube.
    double side = 1;
    const auto cube = [](double edge) { return D == 2 ? edge * edge : edge * edge * edge; };
    while (cube(side) < static_cast<double>(count)) side *= 1.1;
    std::array<double, D> range;
    for (int axis = 0; axis < D; ++axis) {
      range[axis] = static_cast<double>(sample_[axis].high) - sample_[axis].low;
      sizes[axis] = std::max<double>(sample_[axis].extent, range[axis] / (4 * side));
      if (!(sizes[axis] > 0)) sizes[axis] = 1;
    }
    const auto boxes_in_cell = [&](double factor) {
      auto boxes = static_cast<double>(count);
      for (int axis = 0; axis < D; ++axis) {
        const double extent = sample_[axis].extent;
        boxes *= std::min(1.0, (factor * sizes[axis] + extent) / (range[axis] + extent + 1e-300));
      }
      return boxes;
    };
    double factor = 1;
    while (factor < 1e4 && boxes_in_cell(factor) < boxes_per_cell) factor *= 1.1;
    for (double& size : sizes) size *= factor;
    return sizes;
  }

  /// Now and then, after work that pays for it: whether other cells would suit the boxes better by now.
  void look_at_sizes(const Change<D>& change) {
    if (cell_ || visited_ < cells_.references() + 16384) return;
    visited_ = 0;
    const std::array<double, D> better = sizes_for(change);
    for (int axis = 0; axis < D; ++axis)
      is_outgrown_ |= better[axis] > 2 * sizes_[axis] || 2 * better[axis] < sizes_[axis];
  }

  std::size_t structure_bytes() const noexcept override {
    return cells_.bytes() + blocks_.capacity() * sizeof(Block*) +
           (begun_.capacity() + ended_.capacity()) * sizeof(std::uint32_t);
  }

  bool translates_;
  std::optional<double> cell_;
  int span_;

  Cells cells_;
  std::array<double, D> sizes_{};
  bool is_outgrown_ = false;
  std::size_t visited_ = 0;  // blocks, since the last look at sizes
  std::vector<Block*> blocks_;
  std::vector<std::uint32_t> begun_;  // what one box's step toggles
  std::vector<std::uint32_t> ended_;
  core::Sample<D> sample_;
  std::vector<Box<D>> sampled_;
  Statistics statistics_;
};

}  // namespace

std::vector<Tunable> grid_tracking() {
  return {
      {.name = "update",
       .summary = "for tracking only: take a mover from all its cells and file it anew, or only where it "
                  "leaves and enters cells, or find all pairs anew",
       .standard = "auto",
       .type = Tunable::Type::choice,
       .choices = {"reinsert", "translate", "rebuild"}},
      {.name = "span",
       .summary = "for tracking only: how many cells a box may be wide before it goes to cells four times "
                  "as large",
       .standard = "1",
       .type = Tunable::Type::integer,
       .least = 1,
       .most = 16}};
}

template <int D>
std::unique_ptr<PairTracker<D>> make_grid_tracker(const Settings& settings,
                                                  std::unique_ptr<PairFinder<D>> finder) {
  using Way = typename core::IncrementalTracker<D>::Way;
  const std::string& update = settings.text("update");
  const Way way = update == "auto" ? Way::choose : update == "rebuild" ? Way::rebuild : Way::follow;
  std::optional<double> cell;
  if (!settings.is_auto("cell")) cell = settings.number("cell");
  return std::make_unique<GridTracker<D>>(way, update != "reinsert", cell,
                                          static_cast<int>(settings.integer("span")), std::move(finder));
}

template std::unique_ptr<PairTracker<2>> make_grid_tracker(const Settings&, std::unique_ptr<PairFinder<2>>);
template std::unique_ptr<PairTracker<3>> make_grid_tracker(const Settings&, std::unique_ptr<PairFinder<3>>);

}  // namespace broadside::own
