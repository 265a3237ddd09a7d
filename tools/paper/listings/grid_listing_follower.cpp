// Section VI-B of paper.md: moves the references of changed boxes to other cells, then Algorithm 4 searches
// all cells. docs/paper/errata.md lists the corrections and their reasons.
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

/// How a changed box gets into its new cells.
enum class Reposition {
  rebuild,                 ///< with all others: the grid is rebuilt
  search_delete_reinsert,  ///< VI-A: all cells are searched for it; it is deleted, and hashed into its new
                           ///< cells
  search_once,             ///< erratum T10: one search of all cells for all movers
  reinsert,                ///< VI-B: "one hash to find an object and another hash to place it"
  translate                ///< VI-B: its references go to neighbouring cells
};

Reposition reposition_of(const Settings& settings) {
  const std::string& text = settings.text("update");
  if (text == "search_delete_reinsert") return Reposition::search_delete_reinsert;
  if (text == "search_once") return Reposition::search_once;
  if (text == "reinsert") return Reposition::reinsert;
  return text == "translate" ? Reposition::translate : Reposition::rebuild;
}

/// Whether a coordinate that moves from `from` to `to` certainly stays in its cell, by the paper's rule:
/// compares the change with the offset in the cell, which is the position modulo the cell's size. Erratum T7:
/// in the direction of the change. If the arithmetic cannot distinguish a position from a border, the
/// coordinate does not stay.
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
    if (reposition_ == Reposition::search_once) delete_all(movers);
    for (const BoxId id : movers) {
      if (!reposition(id, boxes()[index(id)], now[index(id)])) return false;
      boxes()[index(id)] = now[index(id)];
    }
    return true;
  }

  Statistics search(PairSink& pairs) override {
    Statistics statistics;
    grid_.algorithm_4_spi(boxes(), pairs, checkpoint(), statistics);
    return statistics;
  }

  std::size_t structure_bytes() const noexcept override { return grid_.bytes() + is_mover_.capacity(); }

  /// False if the grid may not hold that many references.
  bool reposition(BoxId id, const Box2& from, const Box2& to) {
    const bool remains = is_present(from) && is_present(to);
    if (reposition_ == Reposition::translate && remains) return translate(id, from, to);
    if (reposition_ == Reposition::search_delete_reinsert) {
      if (is_present(from)) search_and_delete(id);
    } else if (reposition_ != Reposition::search_once && is_present(from)) {
      const CellRange old_cells = grid_.cells_of(from);
      if (is_present(to) && grid_.cells_of(to) == old_cells) return true;
      for_cells(old_cells, [&](auto column, auto row) { erase(id, column, row); });
    }
    if (!is_present(to)) return true;
    const CellRange cells = grid_.cells_of(to);
    if (!has_room(references(cells))) return false;
    for_cells(cells, [&](auto column, auto row) { insert(id, column, row); });
    return true;
  }

  /// Searches all cells for one box: a flag does not say how many cells it is in.
  void search_and_delete(BoxId id) {
    std::uint64_t looked_at = 0;
    for (std::vector<BoxId>& cell : grid_.cells()) {
      const auto place = std::find(cell.begin(), cell.end(), id);
      looked_at += static_cast<std::uint64_t>(place - cell.begin()) + 1;
      if (place != cell.end()) take_out(cell, place);
    }
    counts().visited += looked_at;
    checkpoint().count(looked_at);
  }

  void delete_all(std::span<const BoxId> movers) {
    is_mover_.assign(boxes().size(), 0);
    for (const BoxId id : movers) is_mover_[index(id)] = 1;
    for (std::vector<BoxId>& cell : grid_.cells()) {
      counts().visited += cell.size() + 1;
      const auto gone = std::erase_if(cell, [this](BoxId id) { return is_mover_[index(id)] != 0; });
      counts().moved += gone;
      references_ -= static_cast<double>(gone);
    }
  }

  /// Likewise. Only references in cells that the box leaves move to cells that it enters: moving one to a
  /// cell that already has a reference to the box would change nothing.
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

  /// The cells of `cells` that are not among `others`.
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
    const auto place = std::find(cell.begin(), cell.end(), id);
    const auto looked_at = static_cast<std::uint64_t>(place - cell.begin()) + 1;
    counts().visited += looked_at;
    checkpoint().count(looked_at);
    take_out(cell, place);
  }

  void take_out(std::vector<BoxId>& cell, std::vector<BoxId>::iterator place) {
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
