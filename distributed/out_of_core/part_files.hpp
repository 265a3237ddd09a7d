// The boxes of parts on disk: written for all parts of a partition at once, and read block by block.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/partition.hpp"

#include "blocks.hpp"
#include "box_file.hpp"
#include "distributor.hpp"
#include "work_folder.hpp"

namespace broadside::out_of_core {

template <int D, typename Real>
class PartFiles {
 public:
  /// `memory` is in bytes; `threads` is as in Workers. Boxes come from one source or from two.
  PartFiles(const WorkFolder& folder, std::size_t sources, std::uint64_t memory, std::size_t threads)
      : folder_(folder), sources_(sources), memory_(memory), threads_(threads) {}

  /// Maximum number of parts of a partition. With more, their blocks would be too small for a disk.
  std::uint64_t max_parts() const { return std::clamp<std::uint64_t>(memory_ >> 18, 4, 1024); }

  /// Writes the boxes of each source to the files of the parts that they touch. Calls for_each_piece(source,
  /// add), which must call add(boxes, id) for pieces of the source's boxes; id(i) is the id of boxes[i].
  /// Returns the parts that can have pairs, named `prefix` plus a number.
  template <typename ForEachPiece>
  std::vector<PartRecord> write(const Partition<D, Real>& partition, const std::string& prefix,
                                const ForEachPiece& for_each_piece) const {
    std::vector<PartRecord> parts = parts_of(partition, prefix);
    for (std::size_t source = 0; source < sources_; ++source) {
      std::vector<BoxFileWriter<D, Real>> writers = writers_for(parts, source);
      Distributor<D, Real> distributor(partition, writers, threads_);
      for_each_piece(
          source, [&](std::span<const Box<D, Real>> boxes, const auto& id) { distributor.add(boxes, id); });
      for (std::size_t part = 0; part < parts.size(); ++part) finish(parts[part], source, writers[part]);
    }
    for (const PartRecord& part : parts)
      for (std::size_t source = 0; source < sources_ && !can_have_pairs(part); ++source)
        folder_.remove_boxes(part, source);
    std::erase_if(parts, [this](const PartRecord& part) { return !can_have_pairs(part); });
    return parts;
  }

  /// Rewrites a part's boxes of one source: the boxes that visit_all(add) passes to add(box, id).
  template <typename VisitAll>
  void rewrite(PartRecord& part, std::size_t source, const VisitAll& visit_all) const {
    folder_.remove_boxes(part, source);
    BoxFileWriter<D, Real> writer(folder_.box_file(part, source), std::size_t{1} << 15);
    visit_all([&writer](const Box<D, Real>& box, std::uint64_t id) { writer.add(box, id); });
    finish(part, source, writer);
  }

  /// Calls visit(block) for each block of a part's boxes of one source. Throws CorruptFile.
  template <typename Visit>
  void for_each_block(const PartRecord& part, std::size_t source, const Visit& visit) const {
    std::vector<std::byte> block;
    for (BlockReader reader(folder_.box_file(part, source), part.blocks[source]); reader.next(block);)
      visit(std::span<const std::byte>(block));
  }

 private:
  static std::vector<PartRecord> parts_of(const Partition<D, Real>& partition, const std::string& prefix) {
    std::vector<PartRecord> parts(partition.size());
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const auto& region = partition.region(part);
      parts[part].name = prefix + std::to_string(part);
      parts[part].low.assign(region.low.begin(), region.low.end());
      parts[part].high.assign(region.high.begin(), region.high.end());
    }
    return parts;
  }

  std::vector<BoxFileWriter<D, Real>> writers_for(const std::vector<PartRecord>& parts,
                                                  std::size_t source) const {
    const std::size_t bytes = std::min<std::size_t>(memory_ / 4 / parts.size(), std::size_t{1} << 20);
    std::vector<BoxFileWriter<D, Real>> writers;
    // Writing a block copies it.
    for (const PartRecord& part : parts)
      writers.emplace_back(folder_.box_file(part, source), bytes / (2 * bytes_per_box<D, Real>)+1);
    return writers;
  }

  static void finish(PartRecord& part, std::size_t source, BoxFileWriter<D, Real>& writer) {
    writer.flush();
    part.boxes[source] = writer.count();
    part.blocks[source] = writer.blocks();
  }

  bool can_have_pairs(const PartRecord& part) const noexcept {
    return part.boxes[0] > 0 && (sources_ == 1 || part.boxes[1] > 0);
  }

  const WorkFolder& folder_;
  std::size_t sources_;
  std::uint64_t memory_;
  std::size_t threads_;
};

}  // namespace broadside::out_of_core
