// Joins boxes that do not fit into memory: they are filed by parts of space in a work folder, and one part
// after the other is joined.
#pragma once

#include <compare>
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
#include "broadside/pair.hpp"

namespace broadside {

/// Two boxes of more than 2^32: their places in the order in which they were read.
struct LargePair {
  std::uint64_t first;
  std::uint64_t second;

  friend constexpr auto operator<=>(const LargePair&, const LargePair&) = default;
};

/// Boxes that are read piece by piece, and once more where that is asked for.
template <int D, typename Real = float>
class BoxSource {
 public:
  virtual ~BoxSource() = default;

  /// The first piece comes next, again.
  virtual void begin() = 0;

  /// Puts the next boxes into `boxes`, however many, in the stead of what it holds; false where there are no
  /// more. The boxes are the same each time.
  virtual bool next(std::vector<Box<D, Real>>& boxes) = 0;

  /// About how many boxes there are; 0 where that is not known.
  virtual std::uint64_t estimated_size() const { return 0; }
};

/// What a join is doing.
enum class OutOfCoreStage : std::uint8_t {
  reading,  ///< and filing the boxes; counted in boxes
  joining,  ///< parts; counted in boxes of parts
  sorting   ///< and handing on the pairs; counted in pairs
};

struct OutOfCoreOptions {
  /// Where parts and pairs are kept, made where it is not there. It takes up to the size of the boxes and 4
  /// bytes for each, a few percent more for those on cuts, and 8 bytes a pair (16 with large ids).
  std::filesystem::path folder;

  /// How much memory the join may take, in bytes, beside the program itself; at least min_memory.
  std::uint64_t memory = std::uint64_t{1} << 30;
  static constexpr std::uint64_t min_memory = std::uint64_t{1} << 18;

  std::string algorithm{default_algorithm};  ///< the spec by which parts are joined
  std::size_t threads = 0;                   ///< as in Workers; the standard executor's

  /// What tells these boxes from others: a work folder is only gone on with for the same. A path with its
  /// size and date, say.
  std::string identity{};

  /// Whether places are kept in 64 bits although 32 would do. Where there are more boxes they always are.
  bool has_large_ids = false;

  /// Called now and then with what is done of how much; `total` is 0 where that is not known. What it throws
  /// ends the join, which can be gone on with.
  std::function<void(OutOfCoreStage, std::uint64_t done, std::uint64_t total)> progress{};

  /// Called with what the user should know and what stops nothing: that a part was damaged and is made again.
  std::function<void(std::string_view)> say{};
};

/// A work folder that cannot be used, or a disk that is full. The text names the file, what was found and
/// what was expected. What had been done is kept.
class BROADSIDE_PUBLIC OutOfCoreError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Finds every pair of overlapping boxes of one source, or of a box of one and a box of another, within a
/// limit of memory.
///
/// Each step that is finished is written down in the work folder. A join that ended early, by whatever cause,
/// goes on where it was when it is made again with the same folder and the same boxes: the boxes are read
/// once more only if they had not been read to the end. Everything in the folder has a checksum; what is
/// damaged is made again from the source. Two joins cannot use one folder at the same time: the second one
/// throws.
///
/// Pairs do not depend on the limit, on threads or on how often the join was ended.
template <int D, typename Real = float>
class BROADSIDE_PUBLIC OutOfCoreJoin {
 public:
  /// The sources must outlive the join. Throws OutOfCoreError if the folder cannot be used, is in use, or
  /// belongs to other boxes; std::invalid_argument for too little memory; InvalidSpec.
  OutOfCoreJoin(BoxSource<D, Real>& boxes, OutOfCoreOptions options);
  OutOfCoreJoin(BoxSource<D, Real>& left, BoxSource<D, Real>& right, OutOfCoreOptions options);
  ~OutOfCoreJoin();
  OutOfCoreJoin(const OutOfCoreJoin&) = delete;
  OutOfCoreJoin& operator=(const OutOfCoreJoin&) = delete;

  /// Reads the boxes and joins them, as far as that has not been done. Throws OutOfCoreError, InvalidInput
  /// with the place of a box among all of its source, and what a source or `progress` throws.
  void run();

  /// After run(): the number of pairs, of boxes in the one source and in the other, and whether places need
  /// 64 bits.
  std::uint64_t pairs() const;
  std::uint64_t boxes() const;
  std::uint64_t right_boxes() const;
  bool has_large_ids() const;

  /// After run(): hands on all pairs, sorted by first and second place; a pair of one source has first <
  /// second. The first throws InvalidFrame where ids are large. May be called again. Throws as run() does.
  void sorted(const std::function<void(std::span<const Pair>)>& take);
  void sorted(const std::function<void(std::span<const LargePair>)>& take);

  /// Likewise, in the order in which parts were joined: sorted within pieces alone.
  void unsorted(const std::function<void(std::span<const Pair>)>& take);
  void unsorted(const std::function<void(std::span<const LargePair>)>& take);

  /// Removes what the join has put into the folder, and the folder if it is then empty. Nothing but the
  /// destructor may be called afterwards.
  void remove_folder();

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace broadside
