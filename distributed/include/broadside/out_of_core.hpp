// Joins boxes that do not fit into memory: partitions them into files in a work folder, then joins one part
// after another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/export.hpp"
#include "broadside/finder.hpp"
#include "broadside/large_pair.hpp"
#include "broadside/pair.hpp"

namespace broadside {

namespace detail {

/// The interface through which a join reads a BoxSource.
template <int D, typename Real>
class BoxPieces {
 public:
  virtual ~BoxPieces() = default;

  /// Calls `visit` with the boxes from the first on, piece by piece, until it returns false.
  virtual void visit(const std::function<bool(std::span<const Box<D, Real>>)>& visit) = 0;

  /// The approximate number of boxes; 0 if unknown.
  virtual std::uint64_t estimated_size() const { return 0; }
};

}  // namespace detail

/// A source of boxes that is read in pieces, once or several times. A box's id is its index in the source.
template <int D, typename Real = float>
class BROADSIDE_CALLERS_VECTOR BoxSource : public detail::BoxPieces<D, Real> {
 public:
  /// Makes next() start at the first box again.
  virtual void rewind() = 0;

  /// Replaces `boxes` by the next boxes, any number of them; false if none are left. Every pass must give
  /// the same boxes.
  virtual bool next(std::vector<Box<D, Real>>& boxes) = 0;

 private:
  void visit(const std::function<bool(std::span<const Box<D, Real>>)>& visit) final {
    std::vector<Box<D, Real>> piece;
    rewind();
    while (next(piece) && visit(piece)) {
    }
  }
};

/// The stages of a join.
enum class OutOfCoreStage : std::uint8_t {
  reading,  ///< reads and partitions the boxes; progress counts boxes
  joining,  ///< joins the parts; progress counts boxes of parts
  sorting   ///< delivers the pairs; progress counts pairs
};

struct OutOfCoreOptions {
  /// Work folder for parts and pairs; created if missing, and refused if it holds anything else. It needs the
  /// size of the boxes plus 4 bytes per box, a few per cent more for boxes on cuts, and 8 bytes per pair (16
  /// with large ids).
  std::filesystem::path folder;

  /// Limit of the memory that the join allocates, in bytes; at least min_memory.
  std::uint64_t memory = std::uint64_t{1} << 30;
  static constexpr std::uint64_t min_memory = std::uint64_t{1} << 18;

  std::string algorithm{default_algorithm};  ///< spec of the algorithm that joins the parts
  std::size_t threads = 0;                   ///< as in Workers; uses the standard executor

  /// Identifies the boxes, for example by path, size and date of their file. A work folder is resumed only
  /// for the same identity, and never for an empty one.
  std::string identity{};

  /// Only count the pairs: they cannot be visited afterwards.
  bool counts_only = false;

  /// Use 64-bit ids even if 32 bits suffice. They are always used above 2^32 boxes.
  bool has_large_ids = false;

  /// Called now and then with the completed and the total amount of work; the total is 0 if unknown. An
  /// exception from it stops the join, which can be resumed.
  std::function<void(OutOfCoreStage, std::uint64_t done, std::uint64_t total)> progress{};

  /// Called with a message when the join recovers from something, such as a corrupt part.
  std::function<void(std::string_view)> warn{};
};

/// The work folder cannot be used, or the disk is full. The message names the file, what was found and what
/// was expected. Finished work is kept.
class BROADSIDE_PUBLIC OutOfCoreError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Finds all overlapping pairs of boxes within one source, or between two, within a memory limit.
///
/// The work folder's manifest records each finished step. A join that ended early, for whatever reason,
/// resumes when it is constructed again with the same folder and identity. It reads the boxes again only if
/// it had not read all of them. All files have checksums; a corrupt part is recreated from the source. A
/// second join that uses the same folder at the same time throws.
///
/// The pairs do not depend on the memory limit, on threads, or on how often the join was interrupted. Not
/// thread-safe.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC OutOfCoreJoin {
 public:
  /// Each source is a BoxSource, and must outlive the join. Throws OutOfCoreError if the folder is unusable,
  /// in use, or holds a join of other boxes; std::invalid_argument for too little memory; InvalidSpec.
  OutOfCoreJoin(detail::BoxPieces<D, Real>& boxes, OutOfCoreOptions options);
  OutOfCoreJoin(detail::BoxPieces<D, Real>& left, detail::BoxPieces<D, Real>& right,
                OutOfCoreOptions options);
  ~OutOfCoreJoin();
  OutOfCoreJoin(const OutOfCoreJoin&) = delete;
  OutOfCoreJoin& operator=(const OutOfCoreJoin&) = delete;

  /// Whether an earlier run has read all boxes of this join, so that run() resumes it.
  bool is_resumed() const;

  /// Reads and joins the boxes, resuming after the steps already done. Throws OutOfCoreError, InvalidInput
  /// with the box's id, and whatever a source or `progress` throws.
  void run();

  /// After run(): the number of pairs, and of boxes in either source. Before run(), pairs() and the visits
  /// throw std::logic_error.
  std::uint64_t pairs() const;
  std::uint64_t boxes() const;
  std::uint64_t right_boxes() const;

  /// After run(): whether ids have 64 bits.
  bool has_large_ids() const;

  /// After run(): visits all pairs, sorted by first and second id. Within one source first < second. Needs a
  /// visitor of LargePair if ids have 64 bits and of Pair otherwise; throws InvalidFrame for the other one.
  /// May be called repeatedly. Throws as run() does; a corrupt part is recreated before the first pair is
  /// visited.
  void visit_sorted(const std::function<void(std::span<const Pair>)>& visit);
  void visit_sorted(const std::function<void(std::span<const LargePair>)>& visit);

  /// As visit_sorted(), but sorted only within each part, which is faster. The order depends on boxes and
  /// memory limit.
  void visit_unsorted(const std::function<void(std::span<const Pair>)>& visit);
  void visit_unsorted(const std::function<void(std::span<const LargePair>)>& visit);

  /// Removes the join's files from the work folder, and the folder if it is then empty. Only the destructor
  /// may be called afterwards.
  void remove_folder();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace broadside
