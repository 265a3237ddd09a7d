// Section VI-B of paper.md: the references of boxes that changed are put into other cells, then Algorithm 4
// searches all cells. What was mended, and why, is in docs/paper/errata.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "paper/listings/coherent_follower.hpp"
#include "paper/listings/followers.hpp"
#include "paper/listings/grid_listing.hpp"

namespace broadside::paper {
namespace {

/// How a box that changed gets into its new cells.
enum class Reposition {
  rebuild,                 ///< with all others: the grid is built anew
  search_delete_reinsert,  ///< VI-A: all cells are looked through for it, it is deleted, and hashed into its
                           ///< new ones
  reinsert,                ///< VI-B: "one hash to find an object and another hash to place it"
  translate                ///< VI-B: its references go to neighbouring cells
};

Reposition reposition_of(const Settings& settings) {
  const std::string& text = settings.text("update");
  if (text == "search_delete_reinsert") return Reposition::search_delete_reinsert;
  if (text == "reinsert") return Reposition::reinsert;
  return text == "translate" ? Reposition::translate : Reposition::rebuild;
}

/// Whether a coordinate that goes from `from` to `to` surely stays in its cell, by the paper's rule: the
/// offset in the cell is the position modulo the cell's size, and the change is compared with it. Erratum T7:
/// in the direction of the change. Where the arithmetic cannot tell a position from a border, it does not
/// stay.
bool stays(double from, double to, double begin, double size) {
  if (!std::isfinite(from) || !std::isfinite(to)) return from == to;
  const double position = from - begin;
  double offset = std::fmod(position, size);
  if (offset < 0) offset += size;
  const double rounding =
      8 * std::numeric_limits<double>::epsilon() * (std::abs(position) + std::abs(to - begin) + size);
  const auto is_inside = [&](double at) { return at > rounding && at < size - rounding; };
  return is_inside(offset) && is_inside(offset + (to - from));
}

class GridListingFollower final : public CoherentFollower<2> {
 public:
  explicit GridListingFollower(const Settings& settings)
      : CoherentFollower(settings), reposition_(reposition_of(settings)), grid_(settings) {}

 private:
  void build() override {
    grid_.initialize(boxes());
    grid_.algorithm_3_spanning_add_element(boxes());
    references_ = 0;
    for (const std::vector<BoxId>& cell : grid_.cells()) references_ += static_cast<double>(cell.size());
    counts().moved += static_cast<std::uint64_t>(references_);
  }

  bool mend(std::span<const BoxId> movers, std::span<const Box2> now) override {
    if (reposition_ == Reposition::rebuild) return false;
    if (reposition_ == Reposition::search_delete_reinsert) delete_from_all_cells(movers);
    for (const BoxId id : movers) {
      const Box2& from = boxes()[index(id)];
      const Box2& to = now[index(id)];
      const bool is_done = reposition_ == Reposition::translate && is_present(from) && is_present(to)
                               ? translate(id, from, to)
                               : reinsert(id, from, to);
      if (!is_done) return false;
      boxes()[index(id)] = to;
    }
    return true;
  }

  Statistics search(PairSink& pairs) override {
    Statistics statistics;
    grid_.algorithm_4_spi(boxes(), pairs, checkpoint(), statistics);
    return statistics;
  }

  std::size_t structure_bytes() const noexcept override { return grid_.bytes() + is_mover_.capacity(); }

  /// Looks through all cells once for all movers (erratum T10: the paper looks for one at a time).
  void delete_from_all_cells(std::span<const BoxId> movers) {
    is_mover_.assign(boxes().size(), 0);
    for (const BoxId id : movers) is_mover_[index(id)] = 1;
    for (std::vector<BoxId>& cell : grid_.cells()) {
      counts().visited += cell.size() + 1;
      const auto gone = std::erase_if(cell, [this](BoxId id) { return is_mover_[index(id)] != 0; });
      counts().moved += gone;
      references_ -= static_cast<double>(gone);
    }
  }

  /// False if the grid may not hold that many references.
  bool reinsert(BoxId id, const Box2& from, const Box2& to) {
    if (is_present(from) && reposition_ != Reposition::search_delete_reinsert)
      for_cells(grid_.cells_of(from), [&](auto column, auto row) { erase(id, column, row); });
    if (!is_present(to)) return true;
    const CellRange cells = grid_.cells_of(to);
    if (!has_room(references(cells))) return false;
    for_cells(cells, [&](auto column, auto row) { insert(id, column, row); });
    return true;
  }

  /// Likewise. Only the references in cells that the box leaves go to those it enters: to move one to a cell
  /// that has a reference to the same box would change nothing.
  bool translate(BoxId id, const Box2& from, const Box2& to) {
    const World& world = grid_.world();
    const std::array<double, 2> begin = {world.left, world.top};
    bool is_same = true;
    for (int axis = 0; axis < 2 && is_same; ++axis) {
      is_same = stays(from.min[axis], to.min[axis], begin[axis], grid_.size()) &&
                stays(from.max[axis], to.max[axis], begin[axis], grid_.size());
    }
    if (is_same) return true;
    const CellRange old_cells = grid_.cells_of(from);
    const CellRange cells = grid_.cells_of(to);
    if (!has_room(references(cells))) return false;
    for_cells_outside(old_cells, cells, [&](auto column, auto row) { erase(id, column, row); });
    for_cells_outside(cells, old_cells, [&](auto column, auto row) { insert(id, column, row); });
    return true;
  }

  template <typename Visit>
  static void for_cells(const CellRange& cells, Visit visit) {
    for (std::size_t column = cells.first_column; column <= cells.last_column; ++column) {
      for (std::size_t row = cells.first_row; row <= cells.last_row; ++row) visit(column, row);
    }
  }

  /// Those of `cells` that are not among `others`.
  template <typename Visit>
  static void for_cells_outside(const CellRange& cells, const CellRange& others, Visit visit) {
    for (std::size_t column = cells.first_column; column <= cells.last_column; ++column) {
      const bool is_shared = others.first_column <= column && column <= others.last_column;
      for (std::size_t row = cells.first_row; row <= cells.last_row; ++row) {
        if (is_shared && others.first_row <= row && row <= others.last_row)
          row = others.last_row;
        else
          visit(column, row);
      }
    }
  }

  bool has_room(std::size_t more) const {
    return grid_.may_hold(references_ + static_cast<double>(more), present());
  }

  void erase(BoxId id, std::size_t column, std::size_t row) {
    std::vector<BoxId>& cell = grid_.g(column, row);
    const auto place = std::ranges::find(cell, id);
    const auto looked_at = static_cast<std::uint64_t>(place - cell.begin()) + 1;
    counts().visited += looked_at;
    checkpoint().count(looked_at);
    *place = cell.back();
    cell.pop_back();
    ++counts().moved;
    --references_;
  }

  void insert(BoxId id, std::size_t column, std::size_t row) {
    grid_.g(column, row).push_back(id);
    ++counts().visited;
    ++counts().moved;
    ++references_;
  }

  Reposition reposition_;
  GridListing grid_;
  double references_ = 0;
  std::vector<std::uint8_t> is_mover_;
};

}  // namespace

std::unique_ptr<Follower<2>> make_grid_follower(const Settings& settings) {
  return std::make_unique<GridListingFollower>(settings);
}

}  // namespace broadside::paper
