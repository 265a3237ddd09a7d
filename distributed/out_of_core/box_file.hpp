// A part's boxes on disk, each with its id: its index among all boxes of its source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"

#include "blocks.hpp"

namespace broadside::out_of_core {

/// Bytes per box in a file: the box, and its id as a 32-bit distance from the first id of its block.
template <int D, typename Real>
constexpr std::size_t bytes_per_box = sizeof(Box<D, Real>) + sizeof(std::uint32_t);

/// Collects boxes and writes them in blocks. A block holds the first id, the boxes, and each box's distance
/// from the first id.
template <int D, typename Real>
class BoxFileWriter {
 public:
  BoxFileWriter(std::filesystem::path path, std::size_t boxes_per_block)
      : writer_(std::move(path)), boxes_per_block_(boxes_per_block) {}

  /// Ids must ascend.
  void add(const Box<D, Real>& box, std::uint64_t id) {
    if (boxes_.size() == boxes_per_block_ || (!boxes_.empty() && id - first_id_ > UINT32_MAX)) flush();
    if (boxes_.empty()) first_id_ = id;
    boxes_.push_back(box);
    distances_.push_back(static_cast<std::uint32_t>(id - first_id_));
    ++count_;
  }

  /// Writes the collected boxes.
  void flush() {
    if (boxes_.empty()) return;
    block_.resize(sizeof(first_id_) + boxes_.size() * sizeof(Box<D, Real>));
    std::memcpy(block_.data(), &first_id_, sizeof(first_id_));
    std::memcpy(block_.data() + sizeof(first_id_), boxes_.data(), block_.size() - sizeof(first_id_));
    writer_.append(block_, std::as_bytes(std::span(distances_)));
    boxes_.clear();
    distances_.clear();
  }

  std::uint64_t count() const noexcept { return count_; }
  std::uint64_t blocks() const noexcept { return writer_.blocks(); }

 private:
  BlockWriter writer_;
  std::size_t boxes_per_block_;
  std::vector<Box<D, Real>> boxes_;
  std::vector<std::uint32_t> distances_;
  std::vector<std::byte> block_;
  std::uint64_t first_id_ = 0;
  std::uint64_t count_ = 0;
};

/// Calls visit(box, id) for each box of a block.
template <int D, typename Real, typename Visit>
void for_each_box(std::span<const std::byte> block, const Visit& visit) {
  std::uint64_t first_id = 0;
  const std::size_t count = (block.size() - sizeof(first_id)) / bytes_per_box<D, Real>;
  std::memcpy(&first_id, block.data(), sizeof(first_id));
  const std::byte* const boxes = block.data() + sizeof(first_id);
  const std::byte* const distances = boxes + count * sizeof(Box<D, Real>);
  for (std::size_t i = 0; i < count; ++i) {
    Box<D, Real> box;
    std::uint32_t distance = 0;
    std::memcpy(&box, boxes + i * sizeof(box), sizeof(box));
    std::memcpy(&distance, distances + i * sizeof(distance), sizeof(distance));
    visit(box, first_id + distance);
  }
}

}  // namespace broadside::out_of_core
