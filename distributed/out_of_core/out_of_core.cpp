// A join within a memory limit: partitions the boxes into files, joins one part after another, and merges the
// sorted pairs of the parts.
//
// Partition Based Spatial-Merge join: Patel and DeWitt, SIGMOD 1996. No pair is found twice, because each
// belongs to one part: Dittrich and Seeger, ICDE 2000 ("reference point").
#include "broadside/out_of_core.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include "broadside/error.hpp"
#include "broadside/partition.hpp"

#include "blocks.hpp"
#include "box_file.hpp"
#include "pair_runs.hpp"
#include "part_files.hpp"
#include "part_join.hpp"
#include "sources.hpp"
#include "work_folder.hpp"

namespace broadside {

using out_of_core::BlockReader;
using out_of_core::bytes_per_box;
using out_of_core::CorruptFile;
using out_of_core::for_each_box;
using out_of_core::Manifest;
using out_of_core::PairRun;
using out_of_core::PartJoin;
using out_of_core::PartRecord;
using out_of_core::WorkFolder;

template <int D, typename Real>
class OutOfCoreJoin<D, Real>::Work {
 public:
  using Region = typename Partition<D, Real>::Region;

  Work(std::vector<detail::BoxPieces<D, Real>*> sources, OutOfCoreOptions options)
      : sources_(std::move(sources)),
        options_(checked(std::move(options))),
        finder_(finder_of(options_)),
        folder_(options_.folder),
        part_files_(folder_, sources_.size(), options_.memory, options_.threads),
        part_join_(folder_, options_.memory, sources_.size(), options_.counts_only) {
    const std::string kind = std::to_string(D) + "D " + (sizeof(Real) == 4 ? "float" : "double") +
                             (sources_.size() == 2 ? ", two sources" : "") +
                             (options_.has_large_ids ? ", 64-bit ids" : "") +
                             (options_.counts_only ? ", counts only" : "");
    const std::string identity = out_of_core::identity_text(options_.identity);
    if (std::optional<Manifest> found = folder_.read(D)) {
      manifest_ = std::move(*found);
      const bool is_same = manifest_.kind == kind && manifest_.identity == identity;
      if (manifest_.is_read && (!is_same || identity.empty()))
        throw OutOfCoreError(folder_.path().string() + ": holds the join of " + named(manifest_.identity) +
                             " (" + manifest_.kind + "); expected " + named(identity) + " (" + kind +
                             "). Name another folder, or remove this one to start over");
      if (!manifest_.is_read) manifest_ = {};
    }
    is_resumed_ = manifest_.is_read;
    manifest_.kind = kind;
    manifest_.identity = identity;
    folder_.write(manifest_);
    folder_.remove_others(manifest_);
  }

  ~Work() {
    // There is nothing to resume.
    if (!manifest_.is_read) folder_.remove();
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  void run() {
    if (!manifest_.is_read) read_all();
    std::uint64_t done = 0;
    for (std::size_t place = 0; place < manifest_.parts.size();) {
      const PartRecord& part = manifest_.parts[place];
      report(OutOfCoreStage::joining, done, boxes_of_parts());
      if (part.is_joined) {
        done += part.boxes[0] + part.boxes[1];
        ++place;
      } else if (part_join_.is_too_large(part) && !part.is_whole) {
        with_recovery(place, [&] { split(place); });
      } else {
        with_recovery(place, [&] { join(place); });
      }
    }
    report(OutOfCoreStage::joining, done, boxes_of_parts());
  }

  const Manifest& manifest() const noexcept { return manifest_; }
  bool is_resumed() const noexcept { return is_resumed_; }

  std::uint64_t pairs() const {
    check_is_finished();
    std::uint64_t pairs = 0;
    for (const PartRecord& part : manifest_.parts) pairs += part.pairs;
    return pairs;
  }

  template <typename P>
  void visit_pairs(bool is_sorted, const std::function<void(std::span<const P>)>& visit) {
    if (manifest_.has_large_ids != std::is_same_v<P, LargePair>)
      throw InvalidFrame("OutOfCoreJoin: ids of " + std::string(manifest_.has_large_ids ? "64" : "32") +
                         " bits; expected a visitor of " + (manifest_.has_large_ids ? "LargePair" : "Pair"));
    if (options_.counts_only)
      throw std::logic_error(
          "OutOfCoreJoin: pairs were counted only, and cannot be visited; expected counts_only = false");
    const std::uint64_t all = pairs();
    check_runs();
    finder_.reset();  // frees the memory that it keeps between searches
    std::uint64_t done = 0;
    // A visitor may copy its chunk, so chunks must be small.
    constexpr std::size_t max_visited = std::size_t{1} << 16;
    const std::function<void(std::span<const P>)> counted = [&](std::span<const P> pairs) {
      while (!pairs.empty()) {
        const std::span<const P> chunk = pairs.first(std::min(pairs.size(), max_visited));
        visit(chunk);
        report(OutOfCoreStage::sorting, done += chunk.size(), all);
        pairs = pairs.subspan(chunk.size());
      }
    };
    try {
      std::vector<PairRun> runs;
      for (const PartRecord& part : manifest_.parts) {
        for (std::size_t run = 0; run < part.runs.size(); ++run)
          runs.push_back({folder_.pair_file(part, run), part.runs[run]});
        // Sorted within each part: the same order for any number of threads.
        if (!is_sorted)
          out_of_core::merge_runs<P>(folder_, std::exchange(runs, {}), options_.memory / 2, counted);
      }
      if (is_sorted) out_of_core::merge_runs<P>(folder_, std::move(runs), options_.memory / 2, counted);
    } catch (const CorruptFile& corrupt) {
      throw OutOfCoreError(std::string(corrupt.what()) +
                           ", where it was whole before; expected a disk that keeps what it is given");
    }
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

  static Finder<D, Real> finder_of(const OutOfCoreOptions& options) {
    Finder<D, Real> finder(options.algorithm);
    Workers workers = finder.workers();
    workers.threads = options.threads;
    finder.set_workers(workers);
    return finder;
  }

  static std::string named(const std::string& identity) {
    return identity.empty() ? "boxes without an identity" : identity;
  }

  void check_is_finished() const {
    const bool is_finished =
        manifest_.is_read &&
        std::ranges::all_of(manifest_.parts, [](const PartRecord& part) { return part.is_joined; });
    if (!is_finished) throw std::logic_error("OutOfCoreJoin: asked for pairs before run() has finished");
  }

  void report(OutOfCoreStage stage, std::uint64_t done, std::uint64_t total) const {
    if (options_.progress) options_.progress(stage, done, total);
  }

  std::uint64_t boxes_of_parts() const {
    std::uint64_t boxes = 0;
    for (const PartRecord& part : manifest_.parts) boxes += part.boxes[0] + part.boxes[1];
    return boxes;
  }

  Region region_of(const PartRecord& part) const {
    Region region;
    for (std::size_t axis = 0; axis < D; ++axis) {
      region.low[axis] = static_cast<Real>(part.low.at(axis));
      region.high[axis] = static_cast<Real>(part.high.at(axis));
    }
    return region;
  }

  /// Number of parts for `boxes` boxes: 1.5 times the minimum that would fit, because parts differ in size
  /// and boxes on cuts are in several parts.
  std::size_t parts_for(std::uint64_t boxes) const {
    const std::uint64_t max_boxes = part_join_.max_boxes();
    return static_cast<std::size_t>(
        std::min<std::uint64_t>(1 + boxes + boxes / 2, part_files_.max_parts() * max_boxes) / max_boxes + 1);
  }

  /// Partitions all boxes of the sources, with cuts made from their first boxes.
  void read_all() {
    std::uint64_t estimated = sources_.estimated_boxes();
    check_space(estimated);
    const Partition<D, Real> partition = first_partition(estimated);
    Manifest read = manifest_;
    std::uint64_t done = 0;
    read.parts = part_files_.write(partition, "", [&](std::size_t source, const auto& add) {
      read.boxes[source] =
          sources_.for_each_piece(source, [&](std::span<const Box<D, Real>> boxes, std::uint64_t first) {
            sources_.check(boxes, first, source);
            add(boxes, [first](std::size_t i) { return first + i; });
            report(OutOfCoreStage::reading, done += boxes.size(), estimated);
          });
    });
    constexpr std::uint64_t max_small = std::uint64_t{UINT32_MAX} + 1;
    read.has_large_ids = options_.has_large_ids || std::max(read.boxes[0], read.boxes[1]) > max_small;
    read.is_read = true;
    folder_.write(read);
    manifest_ = std::move(read);
  }

  /// Cuts from the first boxes of both sources. If these are not typical, some parts become too large and are
  /// cut again. Sets `estimated` if the sample contains all boxes.
  Partition<D, Real> first_partition(std::uint64_t& estimated) const {
    auto sample = sources_.sample(std::max<std::size_t>(part_join_.max_boxes() / 8, 4096));
    if (sample.is_all) estimated = sample.boxes.size();
    // An unknown number may be large.
    const std::size_t parts =
        estimated == 0 ? static_cast<std::size_t>(std::min<std::uint64_t>(64, part_files_.max_parts()))
        : estimated <= part_join_.max_boxes() ? 1
                                              : parts_for(estimated);
    return Partition<D, Real>(thinned(std::move(sample.boxes)), parts);
  }

  /// Thins the sample, so that making the cuts costs little compared with reading.
  static std::vector<Box<D, Real>> thinned(std::vector<Box<D, Real>> sample) {
    constexpr std::size_t max_size = std::size_t{1} << 16;
    if (sample.size() <= max_size) return sample;
    std::vector<Box<D, Real>> some(max_size);
    for (std::size_t i = 0; i < max_size; ++i) some[i] = sample[i * sample.size() / max_size];
    return some;
  }

  void check_space(std::uint64_t boxes) const {
    const std::uint64_t needed = boxes * bytes_per_box<D, Real>;
    std::error_code error;
    const std::filesystem::space_info space = std::filesystem::space(folder_.path(), error);
    if (error || needed <= space.available) return;
    throw OutOfCoreError(folder_.path().string() + ": has " + std::to_string(space.available) +
                         " bytes free; expected at least " + std::to_string(needed) + " for " +
                         std::to_string(boxes) + " boxes, and more for pairs");
  }

  /// Runs `step` on a part. If the part's files are corrupt, recreates it from the source and retries once.
  template <typename Step>
  void with_recovery(std::size_t place, const Step& step) {
    try {
      step();
    } catch (const CorruptFile& corrupt) {
      make_again(place, corrupt);
      try {
        step();
      } catch (const CorruptFile& again) {
        throw OutOfCoreError(std::string(again.what()) +
                             ", just after it was written; expected a disk that keeps what it is given");
      }
    }
  }

  /// Recreates a part's boxes from the sources.
  void make_again(std::size_t place, const CorruptFile& corrupt) {
    PartRecord& part = manifest_.parts[place];
    if (options_.warn) options_.warn(std::string(corrupt.what()) + "; part " + part.name + " is made again");
    const Region region = region_of(part);
    const std::array<std::uint64_t, 2> boxes_before = part.boxes;
    for (std::size_t source = 0; source < sources_.size(); ++source)
      part_files_.rewrite(part, source, [&](const auto& add) {
        sources_.for_each_piece(source, [&](std::span<const Box<D, Real>> boxes, std::uint64_t first) {
          for (std::size_t i = 0; i < boxes.size(); ++i)
            if (is_present(boxes[i]) && region.touches(boxes[i])) add(boxes[i], first + i);
          report(OutOfCoreStage::reading, first + boxes.size(), manifest_.boxes[source]);
        });
      });
    if (part.boxes != boxes_before)
      throw OutOfCoreError(folder_.path().string() + ": part " + part.name + " had " +
                           std::to_string(boxes_before[0] + boxes_before[1]) + " boxes, and now has " +
                           std::to_string(part.boxes[0] + part.boxes[1]) +
                           "; expected the boxes that were read before. Remove the folder to start over");
    part.is_joined = false;
    part.pairs = 0;
    part.runs.clear();
    folder_.write(manifest_);
  }

  /// Cuts a part that is too large into several, by a sample of its own boxes. If that does not help, marks
  /// it to be joined as a whole.
  void split(std::size_t place) {
    const PartRecord part = manifest_.parts[place];
    const std::uint64_t count = part.boxes[0] + part.boxes[1];
    const Partition<D, Real> partition(sample_of(part), parts_for(count), 0, region_of(part));
    std::vector<PartRecord> parts;
    if (partition.size() > 1) parts = distribute(part, partition);
    const bool reduces_size =
        partition.size() > 1 && std::ranges::all_of(parts, [&](const PartRecord& smaller) {
          return smaller.boxes[0] + smaller.boxes[1] < count - count / 8;
        });
    if (reduces_size) {
      const auto at = manifest_.parts.erase(manifest_.parts.begin() + static_cast<std::ptrdiff_t>(place));
      manifest_.parts.insert(at, parts.begin(), parts.end());
    } else {
      manifest_.parts[place].is_whole = true;
    }
    folder_.write(manifest_);
    folder_.remove_others(manifest_);
  }

  std::vector<Box<D, Real>> sample_of(const PartRecord& part) const {
    const std::uint64_t step = std::max<std::uint64_t>(1, (part.boxes[0] + part.boxes[1]) >> 16);
    std::vector<Box<D, Real>> sample;
    std::uint64_t count = 0;
    for (std::size_t source = 0; source < sources_.size(); ++source)
      part_files_.for_each_block(part, source, [&](std::span<const std::byte> block) {
        for_each_box<D, Real>(block, [&](const Box<D, Real>& box, std::uint64_t) {
          if (count++ % step == 0) sample.push_back(box);
        });
      });
    return sample;
  }

  /// Writes the boxes of a part to the files of its subparts.
  std::vector<PartRecord> distribute(const PartRecord& part, const Partition<D, Real>& partition) const {
    std::vector<Box<D, Real>> boxes;
    std::vector<std::uint64_t> ids;
    return part_files_.write(partition, part.name + ".", [&](std::size_t source, const auto& add) {
      part_files_.for_each_block(part, source, [&](std::span<const std::byte> block) {
        boxes.clear();
        ids.clear();
        for_each_box<D, Real>(block, [&](const Box<D, Real>& box, std::uint64_t id) {
          boxes.push_back(box);
          ids.push_back(id);
        });
        add(boxes, [&](std::size_t i) { return ids[i]; });
      });
    });
  }

  void join(std::size_t place) {
    if (!finder_) finder_ = finder_of(options_);
    PartRecord part = manifest_.parts[place];
    if (manifest_.has_large_ids)
      part_join_.template join<LargePair>(part, region_of(part), *finder_);
    else
      part_join_.template join<Pair>(part, region_of(part), *finder_);
    part.is_joined = true;
    manifest_.parts[place] = std::move(part);
    folder_.write(manifest_);
    for (std::size_t source = 0; source < sources_.size(); ++source)
      folder_.remove_boxes(manifest_.parts[place], source);
  }

  /// Reads all pairs once, so that corrupt runs are recreated before any pair is visited.
  void check_runs() {
    for (std::size_t place = 0; place < manifest_.parts.size(); ++place)
      with_recovery(place, [&] {
        if (!manifest_.parts[place].is_joined) join(place);
        check_runs_of(manifest_.parts[place]);
      });
  }

  void check_runs_of(const PartRecord& part) const {
    std::vector<std::byte> bytes;
    std::uint64_t found = 0;
    for (std::size_t run = 0; run < part.runs.size(); ++run)
      for (BlockReader reader(folder_.pair_file(part, run), part.runs[run]); reader.next(bytes);)
        found += bytes.size() / (manifest_.has_large_ids ? sizeof(LargePair) : sizeof(Pair));
    if (found != part.pairs)
      throw CorruptFile(folder_.path().string() + ": part " + part.name + " has " + std::to_string(found) +
                        " pairs instead of " + std::to_string(part.pairs));
  }

  out_of_core::Sources<D, Real> sources_;
  OutOfCoreOptions options_;
  std::optional<Finder<D, Real>> finder_;
  WorkFolder folder_;
  Manifest manifest_;
  bool is_resumed_ = false;
  out_of_core::PartFiles<D, Real> part_files_;
  PartJoin<D, Real> part_join_;
};

template <int D, typename Real>
OutOfCoreJoin<D, Real>::OutOfCoreJoin(detail::BoxPieces<D, Real>& boxes, OutOfCoreOptions options)
    : work_(std::make_unique<Work>(std::vector{&boxes}, std::move(options))) {}

template <int D, typename Real>
OutOfCoreJoin<D, Real>::OutOfCoreJoin(detail::BoxPieces<D, Real>& left, detail::BoxPieces<D, Real>& right,
                                      OutOfCoreOptions options)
    : work_(std::make_unique<Work>(std::vector{&left, &right}, std::move(options))) {}

template <int D, typename Real>
OutOfCoreJoin<D, Real>::~OutOfCoreJoin() = default;

template <int D, typename Real>
bool OutOfCoreJoin<D, Real>::is_resumed() const {
  return work_->is_resumed();
}

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
void OutOfCoreJoin<D, Real>::visit_sorted(const std::function<void(std::span<const Pair>)>& visit) {
  work_->visit_pairs(true, visit);
}

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::visit_sorted(const std::function<void(std::span<const LargePair>)>& visit) {
  work_->visit_pairs(true, visit);
}

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::visit_unsorted(const std::function<void(std::span<const Pair>)>& visit) {
  work_->visit_pairs(false, visit);
}

template <int D, typename Real>
void OutOfCoreJoin<D, Real>::visit_unsorted(const std::function<void(std::span<const LargePair>)>& visit) {
  work_->visit_pairs(false, visit);
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
