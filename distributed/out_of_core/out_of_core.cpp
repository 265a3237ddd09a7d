// A join within a limit of memory: boxes are filed by parts of space, parts are joined one after the other,
// and their sorted pairs are merged.
#include "broadside/out_of_core.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/partition.hpp"

#include "blocks.hpp"
#include "pair_runs.hpp"
#include "work_folder.hpp"

namespace broadside {
namespace {

using out_of_core::BlockReader;
using out_of_core::BlockWriter;
using out_of_core::Damaged;
using out_of_core::Manifest;
using out_of_core::Part;
using out_of_core::Run;
using out_of_core::WorkFolder;

/// How much memory a part's box takes while it is joined, beside itself and its place: docs/lab-notes.md has
/// the measurements.
template <int D, typename Real>
constexpr std::uint64_t join_bytes_a_box = 2 * sizeof(Box<D, float>) + sizeof(Box<D, Real>) + 16;

/// Boxes of a part on disk: a block is the place of the first one, the boxes, and how far behind the first
/// the place of each is.
template <int D, typename Real>
class BoxFile {
 public:
  BoxFile(std::filesystem::path path, std::size_t boxes_a_block)
      : writer_(std::move(path)), boxes_a_block_(boxes_a_block) {}

  /// Places ascend.
  void add(const Box<D, Real>& box, std::uint64_t place) {
    if (boxes_.size() == boxes_a_block_ || (!boxes_.empty() && place - first_ > UINT32_MAX)) write();
    if (boxes_.empty()) first_ = place;
    boxes_.push_back(box);
    behind_.push_back(static_cast<std::uint32_t>(place - first_));
    ++count_;
  }

  /// What is still to be written.
  void write() {
    if (boxes_.empty()) return;
    block_.resize(sizeof(first_) + boxes_.size() * sizeof(Box<D, Real>));
    std::memcpy(block_.data(), &first_, sizeof(first_));
    std::memcpy(block_.data() + sizeof(first_), boxes_.data(), block_.size() - sizeof(first_));
    writer_.append(block_, std::as_bytes(std::span(behind_)));
    boxes_.clear();
    behind_.clear();
  }

  std::uint64_t count() const noexcept { return count_; }
  std::uint64_t blocks() const noexcept { return writer_.blocks(); }

 private:
  BlockWriter writer_;
  std::size_t boxes_a_block_;
  std::vector<Box<D, Real>> boxes_;
  std::vector<std::uint32_t> behind_;
  std::vector<std::byte> block_;
  std::uint64_t first_ = 0;
  std::uint64_t count_ = 0;
};

/// Calls visit(box, place) for the boxes of a block.
template <int D, typename Real, typename Visit>
void for_each_box(std::span<const std::byte> block, const Visit& visit) {
  std::uint64_t first = 0;
  constexpr std::size_t bytes_a_box = sizeof(Box<D, Real>) + sizeof(std::uint32_t);
  const std::size_t count = (block.size() - sizeof(first)) / bytes_a_box;
  std::memcpy(&first, block.data(), sizeof(first));
  const std::byte* const boxes = block.data() + sizeof(first);
  const std::byte* const behind = boxes + count * sizeof(Box<D, Real>);
  for (std::size_t i = 0; i < count; ++i) {
    Box<D, Real> box;
    std::uint32_t offset = 0;
    std::memcpy(&box, boxes + i * sizeof(box), sizeof(box));
    std::memcpy(&offset, behind + i * sizeof(offset), sizeof(offset));
    visit(box, first + offset);
  }
}

/// Files boxes by the parts that they touch, on several threads.
template <int D, typename Real>
class Filing {
 public:
  Filing(const Partition<D, Real>& partition, std::vector<BoxFile<D, Real>>& files, std::size_t threads)
      : partition_(partition), files_(files), executor_(standard_executor()) {
    const std::size_t most = executor_ == nullptr ? 1 : executor_->threads();
    tasks_.resize(threads == 0 ? most : std::min(threads, most));
  }

  /// `place(i)` is that of boxes[i].
  template <typename Place>
  void add(std::span<const Box<D, Real>> boxes, const Place& place) {
    const auto look = [&](std::size_t task) {
      std::vector<Touch>& touches = tasks_[task];
      touches.clear();
      const std::size_t end = boxes.size() * (task + 1) / tasks_.size();
      for (std::size_t i = boxes.size() * task / tasks_.size(); i < end; ++i)
        if (is_present(boxes[i]))
          partition_.for_each_part(boxes[i], [&](std::size_t part) {
            touches.push_back({static_cast<std::uint32_t>(part), static_cast<std::uint32_t>(i)});
          });
    };
    if (tasks_.size() == 1)
      look(0);
    else
      executor_->run(tasks_.size(), look);
    for (const std::vector<Touch>& touches : tasks_)
      for (const Touch touch : touches) files_[touch.part].add(boxes[touch.box], place(touch.box));
  }

 private:
  struct Touch {
    std::uint32_t part;
    std::uint32_t box;
  };

  const Partition<D, Real>& partition_;
  std::vector<BoxFile<D, Real>>& files_;
  Executor* executor_;
  std::vector<std::vector<Touch>> tasks_;
};

/// One side's boxes of a part, in memory.
template <int D, typename Real>
struct Loaded {
  std::vector<Box<D, Real>> boxes;
  std::vector<std::uint64_t> places;
  std::vector<std::uint8_t> begins_before;

  void reserve(std::size_t count) {
    boxes.reserve(count);
    places.reserve(count);
    begins_before.reserve(count);
  }
  void clear() {
    boxes.clear();
    places.clear();
    begins_before.clear();
  }
};

/// Pairs of places, sorted in memory and written to runs.
template <typename P>
class RunWriter {
 public:
  RunWriter(const WorkFolder& folder, Part& part, std::uint64_t memory)
      : folder_(folder), part_(part), most_(std::max<std::uint64_t>(memory / (2 * sizeof(P)), 4096)) {
    part_.runs.clear();
    part_.pairs = 0;
  }

  /// Called by several threads.
  void add(std::span<const P> pairs) {
    const std::lock_guard lock(mutex_);
    if (pairs_.size() + pairs.size() > most_) write();
    pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
  }

  void write() {
    if (pairs_.empty()) return;
    out_of_core::sort(pairs_, scratch_);
    part_.pairs += pairs_.size();
    part_.runs.push_back(out_of_core::write_run<P>(folder_.pair_file(part_, part_.runs.size()), pairs_));
    pairs_.clear();
  }

 private:
  const WorkFolder& folder_;
  Part& part_;
  std::size_t most_;
  std::mutex mutex_;
  std::vector<P> pairs_;
  std::vector<P> scratch_;
};

/// Takes pairs of a part's boxes, keeps those that belong to the part, and hands them to a run as pairs of
/// places.
template <typename P>
class PlacePairs final : public PairSink {
 public:
  struct Sides {
    const std::uint64_t* left;
    const std::uint64_t* right;
    const std::uint8_t* left_begins_before;
    const std::uint8_t* right_begins_before;
    bool is_ordered;  ///< of one source: the lower place comes first
  };

  PlacePairs(const Sides& sides, RunWriter<P>& run) : sides_(sides), run_(&run) {
    pairs_.reserve(2 * max_room);
  }

  std::unique_ptr<PairSink> empty_clone() const override {
    return std::make_unique<PlacePairs>(sides_, *run_);
  }
  void merge(PairSink&) override {}

 private:
  void consume(std::span<const Pair> pairs) override {
    pairs_.clear();
    for (const Pair pair : pairs) {
      const std::size_t a = index(pair.first);
      const std::size_t b = index(pair.second);
      if ((sides_.left_begins_before[a] & sides_.right_begins_before[b]) != 0) continue;
      std::uint64_t first = sides_.left[a];
      std::uint64_t second = sides_.right[b];
      if (sides_.is_ordered && second < first) std::swap(first, second);
      if constexpr (std::is_same_v<P, Pair>)
        pairs_.push_back(
            {BoxId(static_cast<std::uint32_t>(first)), BoxId(static_cast<std::uint32_t>(second))});
      else
        pairs_.push_back({first, second});
    }
    run_->add(pairs_);
  }

  Sides sides_;
  RunWriter<P>* run_;
  std::vector<P> pairs_;
};

}  // namespace

template <int D, typename Real>
class OutOfCoreJoin<D, Real>::Work {
 public:
  using Region = typename Partition<D, Real>::Region;

  Work(std::vector<BoxSource<D, Real>*> sources, OutOfCoreOptions options)
      : sources_(std::move(sources)), options_(checked(std::move(options))), folder_(options_.folder) {
    finder_ = make_finder<D, Real>(options_.algorithm);
    Workers workers = finder_->workers();
    workers.threads = options_.threads;
    finder_->set_workers(workers);
    const std::string kind = std::to_string(D) + "D " + (sizeof(Real) == 4 ? "float" : "double") + " " +
                             std::to_string(sources_.size());
    if (std::optional<Manifest> found = folder_.read()) {
      manifest_ = std::move(*found);
      is_read_ = true;
      if (manifest_.kind != kind || manifest_.identity != options_.identity)
        throw OutOfCoreError(folder_.path().string() + ": holds the join of " + manifest_.identity + " (" +
                             manifest_.kind + "); expected " + options_.identity + " (" + kind +
                             "). Name another folder, or remove this one to begin anew");
    }
    manifest_.kind = kind;
    manifest_.identity = options_.identity;
    folder_.remove_others(manifest_);
  }

  void run() {
    if (!is_read_) {
      try {
        read_all();
      } catch (...) {
        // Nothing can be gone on with, and the disk may be full of it.
        folder_.remove_others(manifest_);
        throw;
      }
    }
    std::uint64_t done = 0;
    for (std::size_t place = 0; place < manifest_.parts.size();) {
      const Part& part = manifest_.parts[place];
      report(OutOfCoreStage::joining, done, boxes_of_parts());
      if (part.is_joined) {
        done += part.boxes[0] + part.boxes[1];
        ++place;
      } else if (is_too_large(part) && !part.is_whole) {
        mending(place, [&] { split(place); });
      } else {
        mending(place, [&] { join(place); });
      }
    }
    report(OutOfCoreStage::joining, done, boxes_of_parts());
  }

  const Manifest& manifest() const noexcept { return manifest_; }

  std::uint64_t pairs() const {
    std::uint64_t pairs = 0;
    for (const Part& part : manifest_.parts) pairs += part.pairs;
    return pairs;
  }

  template <typename P>
  void hand_on(bool is_sorted, const std::function<void(std::span<const P>)>& take) {
    if (manifest_.has_large_ids != std::is_same_v<P, LargePair>)
      throw InvalidFrame(
          "OutOfCoreJoin: pairs of boxes of " + std::string(manifest_.has_large_ids ? "64" : "32") +
          " bits; expected a function that takes " + (manifest_.has_large_ids ? "LargePair" : "Pair"));
    check_runs();
    std::vector<Run> runs;
    for (const Part& part : manifest_.parts)
      for (std::size_t run = 0; run < part.runs.size(); ++run)
        runs.push_back({folder_.pair_file(part, run), part.runs[run]});
    std::uint64_t done = 0;
    const std::uint64_t all = pairs();
    const std::function<void(std::span<const P>)> counted = [&](std::span<const P> pairs) {
      take(pairs);
      report(OutOfCoreStage::sorting, done += pairs.size(), all);
    };
    if (is_sorted)
      out_of_core::merge_runs<P>(runs, options_.memory / 2, counted);
    else
      out_of_core::read_runs<P>(runs, counted);
  }

  void remove_folder() { folder_.remove(); }

 private:
  static OutOfCoreOptions checked(OutOfCoreOptions options) {
    if (options.memory < OutOfCoreOptions::min_memory)
      throw std::invalid_argument("OutOfCoreOptions: memory of " + std::to_string(options.memory) +
                                  " bytes; expected at least " +
                                  std::to_string(OutOfCoreOptions::min_memory));
    return options;
  }

  void report(OutOfCoreStage stage, std::uint64_t done, std::uint64_t total) const {
    if (options_.progress) options_.progress(stage, done, total);
  }

  std::uint64_t boxes_of_parts() const {
    std::uint64_t boxes = 0;
    for (const Part& part : manifest_.parts) boxes += part.boxes[0] + part.boxes[1];
    return boxes;
  }

  /// How many boxes a part may have to be joined at once: half of the memory is theirs, and a quarter is the
  /// pairs'.
  std::uint64_t most_boxes() const {
    return options_.memory / 2 / (join_bytes_a_box<D, Real> + sizeof(Box<D, Real>) + 9);
  }

  bool is_too_large(const Part& part) const { return part.boxes[0] + part.boxes[1] > most_boxes(); }

  Region region_of(const Part& part) const {
    Region region;
    for (std::size_t axis = 0; axis < D; ++axis) {
      region.low[axis] = static_cast<Real>(part.low.at(axis));
      region.high[axis] = static_cast<Real>(part.high.at(axis));
    }
    return region;
  }

  /// How many parts `boxes` boxes are cut into: some more than just fit, since parts differ and boxes on cuts
  /// are in several.
  std::size_t parts_for(std::uint64_t boxes) const {
    return static_cast<std::size_t>(
               std::min<std::uint64_t>(1 + boxes + boxes / 2, most_parts() * most_boxes()) / most_boxes()) +
           1;
  }

  /// More would have blocks too small for a disk.
  std::uint64_t most_parts() const { return std::clamp<std::uint64_t>(options_.memory >> 18, 4, 1024); }

  std::vector<BoxFile<D, Real>> files_for(const std::vector<Part>& parts, std::size_t side) const {
    const std::size_t bytes_a_box = sizeof(Box<D, Real>) + sizeof(std::uint32_t);
    const std::size_t bytes = std::min<std::size_t>(options_.memory / 4 / parts.size(), std::size_t{1} << 20);
    std::vector<BoxFile<D, Real>> files;
    // A block is copied to be written.
    for (const Part& part : parts)
      files.emplace_back(folder_.box_file(part, side), bytes / (2 * bytes_a_box) + 1);
    return files;
  }

  static std::vector<Part> parts_of(const Partition<D, Real>& partition, const std::string& prefix) {
    std::vector<Part> parts(partition.size());
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const Region& region = partition.region(part);
      parts[part].name = prefix + std::to_string(part);
      parts[part].low.assign(region.low.begin(), region.low.end());
      parts[part].high.assign(region.high.begin(), region.high.end());
    }
    return parts;
  }

  void finish(std::vector<Part>& parts, std::size_t side, std::vector<BoxFile<D, Real>>& files) const {
    for (std::size_t part = 0; part < parts.size(); ++part) {
      files[part].write();
      parts[part].boxes[side] = files[part].count();
      parts[part].blocks[side] = files[part].blocks();
    }
  }

  /// Parts in which no pair can be are left out, with their files.
  void leave_out_empty(std::vector<Part>& parts) const {
    const bool is_between = sources_.size() == 2;
    std::erase_if(parts, [&](const Part& part) {
      if (part.boxes[0] > 0 && (!is_between || part.boxes[1] > 0)) return false;
      for (std::size_t side = 0; side < sources_.size(); ++side)
        std::filesystem::remove(folder_.box_file(part, side));
      return true;
    });
  }

  /// Files all boxes of the sources by parts, which are made from the first boxes.
  void read_all() {
    std::uint64_t estimated = 0;
    for (BoxSource<D, Real>* const source : sources_) estimated += source->estimated_size();
    check_space(estimated);
    // What the cuts are made from: the first pieces, of either source.
    const std::size_t most_sampled = std::max<std::size_t>(most_boxes() / 8, 4096);
    std::vector<Box<D, Real>> piece;
    std::vector<Box<D, Real>> sample;
    bool is_all = true;
    for (std::size_t side = 0; side < sources_.size(); ++side) {
      const std::size_t most = most_sampled * (side + 1) / sources_.size();
      sources_[side]->begin();
      while (true) {
        if (sample.size() >= most) {
          is_all = false;
          break;
        }
        if (!sources_[side]->next(piece)) break;
        sample.insert(sample.end(), piece.begin(), piece.end());
      }
    }
    if (is_all) estimated = sample.size();
    // Of an unknown number there are many; parts that turn out too large are cut again.
    const std::size_t parts_wanted = estimated == 0
                                         ? static_cast<std::size_t>(std::min<std::uint64_t>(64, most_parts()))
                                     : estimated <= most_boxes() ? 1
                                                                 : parts_for(estimated);
    const Partition<D, Real> partition(thinned(std::move(sample)), parts_wanted);
    std::vector<Part> parts = parts_of(partition, "");
    std::uint64_t done = 0;
    for (std::size_t side = 0; side < sources_.size(); ++side) {
      std::vector<BoxFile<D, Real>> files = files_for(parts, side);
      Filing<D, Real> filing(partition, files, options_.threads);
      std::uint64_t first = 0;
      sources_[side]->begin();
      while (sources_[side]->next(piece)) {
        check(piece, first);
        filing.add(piece, [first](std::size_t i) { return first + i; });
        first += piece.size();
        report(OutOfCoreStage::reading, done += piece.size(), estimated);
      }
      manifest_.boxes[side] = first;
      finish(parts, side, files);
    }
    constexpr std::uint64_t most_small = std::uint64_t{UINT32_MAX} + 1;
    manifest_.has_large_ids =
        options_.has_large_ids || std::max(manifest_.boxes[0], manifest_.boxes[1]) > most_small;
    leave_out_empty(parts);
    manifest_.parts = std::move(parts);
    folder_.write(manifest_);
    is_read_ = true;
  }

  /// At most so many that the cuts cost little beside the reading.
  static std::vector<Box<D, Real>> thinned(std::vector<Box<D, Real>> sample) {
    constexpr std::size_t most = std::size_t{1} << 16;
    if (sample.size() <= most) return sample;
    std::vector<Box<D, Real>> some(most);
    for (std::size_t i = 0; i < most; ++i) some[i] = sample[i * sample.size() / most];
    return some;
  }

  void check(std::span<const Box<D, Real>> boxes, std::uint64_t first) const {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (is_present(boxes[i]) || is_absent(boxes[i])) continue;
      const std::uint64_t place = first + i;
      throw InvalidInput(
          static_cast<std::size_t>(place),
          "box " + std::to_string(place) + " has a NaN or min > max; expected min <= max, or the absent box");
    }
  }

  void check_space(std::uint64_t boxes) const {
    const std::uint64_t needed = boxes * (sizeof(Box<D, Real>) + sizeof(std::uint32_t));
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(folder_.path(), error);
    if (error || needed <= space.available) return;
    throw OutOfCoreError(folder_.path().string() + ": has " + std::to_string(space.available) +
                         " bytes free; expected at least " + std::to_string(needed) + " for " +
                         std::to_string(boxes) + " boxes, and more for pairs");
  }

  /// Does something with a part's boxes; where they turn out damaged, they are taken from the source again.
  template <typename Step>
  void mending(std::size_t place, const Step& step) {
    try {
      step();
    } catch (const Damaged& damaged) {
      if (options_.say)
        options_.say(std::string(damaged.what()) + "; part " + manifest_.parts[place].name +
                     " is made again");
      file_again(manifest_.parts[place]);
      try {
        step();
      } catch (const Damaged& again) {
        throw OutOfCoreError(std::string(again.what()) +
                             ", just after it was written; expected a disk that keeps "
                             "what it is given");
      }
    }
  }

  void file_again(Part& part) {
    const Region region = region_of(part);
    const Part before = part;
    for (std::size_t side = 0; side < sources_.size(); ++side) {
      BoxFile<D, Real> file(folder_.box_file(part, side), std::size_t{1} << 15);
      std::vector<Box<D, Real>> piece;
      std::uint64_t first = 0;
      sources_[side]->begin();
      while (sources_[side]->next(piece)) {
        for (std::size_t i = 0; i < piece.size(); ++i)
          if (is_present(piece[i]) && region.touches(piece[i])) file.add(piece[i], first + i);
        first += piece.size();
        report(OutOfCoreStage::reading, first, manifest_.boxes[side]);
      }
      file.write();
      part.boxes[side] = file.count();
      part.blocks[side] = file.blocks();
    }
    if (part.boxes != before.boxes)
      throw OutOfCoreError(folder_.path().string() + ": part " + part.name + " had " +
                           std::to_string(before.boxes[0] + before.boxes[1]) + " boxes, and now has " +
                           std::to_string(part.boxes[0] + part.boxes[1]) +
                           "; expected the boxes that were read before. Remove the folder to begin anew");
    part.is_joined = false;
    part.pairs = 0;
    part.runs.clear();
    folder_.write(manifest_);
  }

  /// Cuts a part that is too large to be joined into several, from a sample of its own boxes. Where that does
  /// not help, it is joined as a whole.
  void split(std::size_t place) {
    const Part part = manifest_.parts[place];
    const std::uint64_t count = part.boxes[0] + part.boxes[1];
    const std::uint64_t step = std::max<std::uint64_t>(1, count >> 16);
    std::vector<Box<D, Real>> sample;
    std::uint64_t met = 0;
    for_each_block(part, [&](std::size_t, std::span<const std::byte> block) {
      for_each_box<D, Real>(block, [&](const Box<D, Real>& box, std::uint64_t) {
        if (met++ % step == 0) sample.push_back(box);
      });
    });
    const Partition<D, Real> partition(sample, parts_for(count), 0, region_of(part));
    std::vector<Part> parts = parts_of(partition, part.name + ".");
    if (parts.size() > 1) {
      for (std::size_t side = 0; side < sources_.size(); ++side) {
        std::vector<BoxFile<D, Real>> files = files_for(parts, side);
        Filing<D, Real> filing(partition, files, options_.threads);
        std::vector<Box<D, Real>> boxes;
        std::vector<std::uint64_t> places;
        for_each_block(part, [&](std::size_t block_side, std::span<const std::byte> block) {
          if (block_side != side) return;
          boxes.clear();
          places.clear();
          for_each_box<D, Real>(block, [&](const Box<D, Real>& box, std::uint64_t box_place) {
            boxes.push_back(box);
            places.push_back(box_place);
          });
          filing.add(boxes, [&](std::size_t i) { return places[i]; });
        });
        finish(parts, side, files);
      }
      leave_out_empty(parts);
    }
    const bool is_help = std::ranges::all_of(
        parts, [&](const Part& smaller) { return smaller.boxes[0] + smaller.boxes[1] < count - count / 8; });
    if (parts.size() > 1 && !is_help) manifest_.parts[place].is_whole = true;
    if (partition.size() == 1) manifest_.parts[place].is_whole = true;
    if (!manifest_.parts[place].is_whole) {
      const auto at = manifest_.parts.erase(manifest_.parts.begin() + static_cast<std::ptrdiff_t>(place));
      manifest_.parts.insert(at, parts.begin(), parts.end());
    }
    folder_.write(manifest_);
    folder_.remove_others(manifest_);
  }

  /// Calls visit(side, block) for all blocks of a part's boxes.
  template <typename Visit>
  void for_each_block(const Part& part, const Visit& visit) const {
    std::vector<std::byte> block;
    for (std::size_t side = 0; side < sources_.size(); ++side)
      for (BlockReader reader(folder_.box_file(part, side), part.blocks[side]); reader.next(block);)
        visit(side, std::span<const std::byte>(block));
  }

  void join(std::size_t place) {
    Part part = manifest_.parts[place];
    if (manifest_.has_large_ids)
      join_part<LargePair>(part);
    else
      join_part<Pair>(part);
    part.is_joined = true;
    manifest_.parts[place] = std::move(part);
    folder_.write(manifest_);
    for (std::size_t side = 0; side < sources_.size(); ++side)
      std::filesystem::remove(folder_.box_file(manifest_.parts[place], side));
  }

  /// Reads boxes of one side into `loaded`, up to `most`; false where there are none left.
  bool load(BlockReader& reader, const Region& region, std::uint64_t most, Loaded<D, Real>& loaded) const {
    std::vector<std::byte> block;
    loaded.clear();
    while (loaded.boxes.size() < most && reader.next(block))
      for_each_box<D, Real>(block, [&](const Box<D, Real>& box, std::uint64_t place) {
        loaded.boxes.push_back(box);
        loaded.places.push_back(place);
        loaded.begins_before.push_back(static_cast<std::uint8_t>(region.begins_before(box)));
      });
    return !loaded.boxes.empty();
  }

  /// Joins a part at once; where it is too large for that and cuts do not help, one piece of its boxes with
  /// each other.
  template <typename P>
  void join_part(Part& part) {
    const Region region = region_of(part);
    RunWriter<P> runs(folder_, part, options_.memory / 4);
    const bool is_between = sources_.size() == 2;
    const bool is_pieces = is_too_large(part);
    const std::uint64_t most = is_pieces ? most_boxes() / 2 : UINT64_MAX;
    Loaded<D, Real> left;
    Loaded<D, Real> right;
    const auto room = [&](std::size_t side) {
      return static_cast<std::size_t>(std::min(part.boxes[side], most + (std::uint64_t{1} << 15)));
    };
    left.reserve(room(0));
    if (is_between || is_pieces) right.reserve(room(is_between ? 1 : 0));
    for (BlockReader reader(folder_.box_file(part, 0), part.blocks[0]); load(reader, region, most, left);) {
      if (!is_between) join_one(left, runs);
      // Of one source the pieces that follow, of two all of the other's.
      BlockReader others = is_between ? BlockReader(folder_.box_file(part, 1), part.blocks[1]) : reader;
      while ((is_between || is_pieces) && load(others, region, most, right)) join_two(left, right, runs);
    }
    runs.write();
  }

  template <typename P>
  void join_one(const Loaded<D, Real>& set, RunWriter<P>& runs) {
    PlacePairs<P> pairs(
        {set.places.data(), set.places.data(), set.begins_before.data(), set.begins_before.data(), true},
        runs);
    finder_->find(set.boxes, pairs);
  }

  template <typename P>
  void join_two(const Loaded<D, Real>& left, const Loaded<D, Real>& right, RunWriter<P>& runs) {
    PlacePairs<P> pairs({left.places.data(), right.places.data(), left.begins_before.data(),
                         right.begins_before.data(), sources_.size() == 1},
                        runs);
    finder_->find_between(left.boxes, right.boxes, pairs);
  }

  /// Reads all pairs once where a checksum may be wrong, so that none is handed on before a part that must be
  /// made again.
  void check_runs() {
    for (std::size_t place = 0; place < manifest_.parts.size(); ++place) {
      try {
        std::vector<std::byte> bytes;
        const Part& part = manifest_.parts[place];
        for (std::size_t run = 0; run < part.runs.size(); ++run)
          for (BlockReader reader(folder_.pair_file(part, run), part.runs[run]); reader.next(bytes);)
            continue;
      } catch (const Damaged& damaged) {
        if (options_.say)
          options_.say(std::string(damaged.what()) + "; part " + manifest_.parts[place].name +
                       " is made again");
        file_again(manifest_.parts[place]);
        join(place);
      }
    }
  }

  std::vector<BoxSource<D, Real>*> sources_;
  OutOfCoreOptions options_;
  WorkFolder folder_;
  Manifest manifest_;
  bool is_read_ = false;
  std::unique_ptr<PairFinder<D, Real>> finder_;
};

template <int D, typename Real>
OutOfCoreJoin<D, Real>::OutOfCoreJoin(BoxSource<D, Real>& boxes, OutOfCoreOptions options)
    : work_(std::make_unique<Work>(std::vector{&boxes}, std::move(options))) {}

template <int D, typename Real>
OutOfCoreJoin<D, Real>::OutOfCoreJoin(BoxSource<D, Real>& left, BoxSource<D, Real>& right,
                                      OutOfCoreOptions options)
    : work_(std::make_unique<Work>(std::vector{&left, &right}, std::move(options))) {}

template <int D, typename Real>
OutOfCoreJoin<D, Real>::~OutOfCoreJoin() = default;

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::run() {
  work_->run();
}

template <int D, typename Real>
std::uint64_t OutOfCoreJoin<D, Real>::pairs() const {
  return work_->pairs();
}

template <int D, typename Real>
std::uint64_t OutOfCoreJoin<D, Real>::boxes() const {
  return work_->manifest().boxes[0];
}

template <int D, typename Real>
std::uint64_t OutOfCoreJoin<D, Real>::right_boxes() const {
  return work_->manifest().boxes[1];
}

template <int D, typename Real>
bool OutOfCoreJoin<D, Real>::has_large_ids() const {
  return work_->manifest().has_large_ids;
}

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::sorted(const std::function<void(std::span<const Pair>)>& take) {
  work_->hand_on(true, take);
}

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::sorted(const std::function<void(std::span<const LargePair>)>& take) {
  work_->hand_on(true, take);
}

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::unsorted(const std::function<void(std::span<const Pair>)>& take) {
  work_->hand_on(false, take);
}

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::unsorted(const std::function<void(std::span<const LargePair>)>& take) {
  work_->hand_on(false, take);
}

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::remove_folder() {
  work_->remove_folder();
}

template class OutOfCoreJoin<2, float>;
template class OutOfCoreJoin<3, float>;
template class OutOfCoreJoin<2, double>;
template class OutOfCoreJoin<3, double>;

}  // namespace broadside
