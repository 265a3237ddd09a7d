// Reads a trace frame by frame, and checks it against all rules of docs/trace-format.md.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/trace/trace.hpp"
#include "src/core/bit_cast.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t word_bytes = 4;

}  // namespace

TraceReader::TraceReader(std::istream& stream, std::string name) : stream_(stream), name_(std::move(name)) {
  read_header();
}

bool TraceReader::next_frame() {
  // Reset once this frame proves complete and valid.
  if (std::exchange(ended_, true)) return false;
  FrameHeader header;
  if (!read_frame_header(header)) return false;
  const std::uint64_t bytes_per_box = word_bytes + 2 * static_cast<unsigned>(dimension_ * coordinate_bytes_);
  const std::uint64_t boxes = word_bytes * header.removed + bytes_per_box * header.set;
  std::uint64_t size = boxes;
  if (has_pairs_) {
    size += trace::filter_bytes * std::uint64_t{header.pairs[0]};
    for (std::size_t i = 1; i < header.pairs.size(); ++i)
      size += trace::pair_bytes * std::uint64_t{header.pairs[i]};
  }
  if (!read(size + trace::checksum_bytes)) {
    return cut_off(header.byte, fmt::format("{} of its {} bytes", frame_header_bytes() + bytes_.size(),
                                            frame_header_bytes() + size + trace::checksum_bytes));
  }
  check_sum(static_cast<std::size_t>(size));
  take(header);
  if (has_pairs_) take_pairs(header, static_cast<std::size_t>(boxes));
  slots_ = header.slots;
  ++frames_;
  ended_ = false;
  return true;
}

void TraceReader::read_header() {
  // First the part that all versions share, then the rest.
  constexpr std::size_t common = trace::header_bytes - trace::checksum_bytes;
  bool whole = read(common);
  if (bytes_.empty())
    throw FileError(fmt::format("{}: is empty; expected a trace, which has {} bytes or more", name_,
                                trace::header_bytes));
  const std::size_t there = std::min(bytes_.size(), trace::magic.size());
  if (!std::equal(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(there), trace::magic.begin()))
    refuse(0, fmt::format("the first bytes are {:02x}", fmt::join(bytes_.data(), bytes_.data() + there, " ")),
           fmt::format("{:02x}, with which a trace begins", fmt::join(trace::magic, " ")));
  has_pairs_ = whole && word(8) == trace::pairs_version;
  if (whole && word(8) != trace::version && !has_pairs_)
    refuse(8, fmt::format("version {}", word(8)),
           fmt::format("{}, or {} with pairs", trace::version, trace::pairs_version));
  const std::size_t size = common + (has_pairs_ ? trace::margin_bytes : 0);
  whole = whole && read_on(size - common + trace::checksum_bytes);
  if (!whole)
    refuse(bytes_.size(), "the file ends", fmt::format("a header of {} bytes", size + trace::checksum_bytes));
  check_sum(size);
  dimension_ = bytes_[12];
  coordinate_bytes_ = bytes_[13];
  if (dimension_ != 2 && dimension_ != 3) refuse(12, fmt::format("dimension {}", dimension_), "2 or 3");
  if (coordinate_bytes_ != 4 && coordinate_bytes_ != 8)
    refuse(13, fmt::format("{} bytes a coordinate", coordinate_bytes_), "4 or 8");
  if (bytes_[14] != 0 || bytes_[15] != 0)
    refuse(14, fmt::format("{:02x} {:02x}", bytes_[14], bytes_[15]), "00 00");
  if (!has_pairs_) return;
  recorded_.margin = core::bit_cast<double>(long_word(common));
  if (!(recorded_.margin >= 0) || std::isinf(recorded_.margin) || std::signbit(recorded_.margin))
    refuse(common, fmt::format("margin {}", recorded_.margin), "a finite number, 0 or more");
}

std::size_t TraceReader::frame_header_bytes() const noexcept {
  return trace::header_bytes + (has_pairs_ ? trace::pair_count_bytes : 0);
}

/// Whether there is a complete frame header; if there is a partial one, warning_ says so.
bool TraceReader::read_frame_header(FrameHeader& header) {
  const bool whole = read(frame_header_bytes());
  const std::size_t there = std::min(bytes_.size(), word_bytes);
  for (std::size_t i = 0; i < there; ++i) {
    if (bytes_[i] != (trace::frame_mark >> 8 * i & 0xff))
      refuse(begin_, fmt::format("{:02x}", fmt::join(bytes_.data(), bytes_.data() + there, " ")),
             "46 52 41 4d, with which a frame begins, or the end of the file");
  }
  if (bytes_.empty()) return false;
  if (!whole)
    return cut_off(begin_,
                   fmt::format("{} of the {} bytes of its header", bytes_.size(), frame_header_bytes()));
  check_sum(frame_header_bytes() - trace::checksum_bytes);
  header = {begin_, word(4), word(8), word(12), {}};
  for (std::size_t i = 0; has_pairs_ && i < header.pairs.size(); ++i)
    header.pairs[i] = word(16 + word_bytes * i);
  return true;
}

/// Applies the slots named in a frame, which are in bytes_: first the removed ones, then the set ones, each
/// ascending.
void TraceReader::take(const FrameHeader& header) {
  const std::size_t set_begin = word_bytes * header.removed;
  const std::size_t bytes_per_box = word_bytes + 2 * static_cast<std::size_t>(dimension_ * coordinate_bytes_);
  const std::size_t end = set_begin + bytes_per_box * header.set;
  const auto axes = static_cast<std::size_t>(dimension_);
  changed_.clear();
  bounds_.clear();
  std::uint64_t min_slot = 0;  // minimum for the next slot
  std::uint64_t added = 0;
  std::size_t removed = 0;
  std::size_t set = set_begin;
  while (removed < set_begin || set < end) {
    const bool removes = set == end || (removed < set_begin && word(removed) <= word(set));
    const std::size_t at = removes ? removed : set;
    const std::uint32_t slot = word(at);
    if (slot < min_slot)
      refuse(begin_ + at, fmt::format("slot {}", slot), "each slot named once, in ascending order");
    if (slot >= header.slots)
      refuse(begin_ + at, fmt::format("slot {}", slot), fmt::format("one below {}", header.slots));
    min_slot = std::uint64_t{slot} + 1;
    added += slot >= slots_ ? 1 : 0;
    changed_.push_back(BoxId(slot));
    if (removes) {
      bounds_.insert(bounds_.end(), axes, std::numeric_limits<double>::infinity());
      bounds_.insert(bounds_.end(), axes, -std::numeric_limits<double>::infinity());
      removed += word_bytes;
    } else {
      take_box(slot, at + word_bytes);
      set += bytes_per_box;
    }
  }
  if (header.slots > slots_ && header.slots - slots_ != added)
    refuse(header.byte + word_bytes,
           fmt::format("{} slots, {} before this frame, and {} new ones named", header.slots, slots_, added),
           "every new slot to be named");
}

void TraceReader::take_box(std::uint32_t slot, std::size_t at) {
  const auto axes = static_cast<std::size_t>(dimension_);
  for (std::size_t i = 0; i < 2 * axes; ++i)
    bounds_.push_back(coordinate(at + i * static_cast<std::size_t>(coordinate_bytes_)));
  const std::span<const double> box = std::span(bounds_).last(2 * axes);
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (box[axis] <= box[axes + axis]) continue;
    refuse(begin_ + at,
           fmt::format("slot {} gets min ({}) and max ({})", slot, fmt::join(box.first(axes), ", "),
                       fmt::join(box.last(axes), ", ")),
           "numbers with min <= max");
  }
}

/// Reads the next `count` bytes, or all that are left; returns whether there were enough.
bool TraceReader::read(std::uint64_t count) {
  begin_ += bytes_.size();
  bytes_.clear();
  return read_on(count);
}

/// Likewise, but appends to the bytes read last.
bool TraceReader::read_on(std::uint64_t count) {
  const std::uint64_t all = bytes_.size() + count;
  while (bytes_.size() < all) {
    // Reads in growing chunks, so that a forged size allocates nothing.
    constexpr std::uint64_t min_piece = std::uint64_t{1} << 16;
    const std::size_t before = bytes_.size();
    const std::uint64_t more = std::min(all - before, std::max<std::uint64_t>(before, min_piece));
    bytes_.resize(before + static_cast<std::size_t>(more));
    errno = 0;
    stream_.read(reinterpret_cast<char*>(bytes_.data() + before), static_cast<std::streamsize>(more));
    if (stream_.bad())
      throw FileError(fmt::format("{}: cannot be read at byte {}: {}", name_, begin_ + before,
                                  errno != 0 ? std::strerror(errno) : "the stream failed"));
    const auto got = static_cast<std::size_t>(stream_.gcount());
    bytes_.resize(before + got);
    if (got < more) return false;
  }
  return true;
}

std::uint32_t TraceReader::word(std::size_t at) const noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = word_bytes; i-- > 0;) value = value << 8 | bytes_[at + i];
  return value;
}

std::uint64_t TraceReader::long_word(std::size_t at) const noexcept {
  return word(at) | std::uint64_t{word(at + word_bytes)} << 32;
}

double TraceReader::coordinate(std::size_t at) const noexcept {
  if (coordinate_bytes_ == 4) return static_cast<double>(core::bit_cast<float>(word(at)));
  return core::bit_cast<double>(long_word(at));
}

/// Verifies the checksum after the first `count` bytes of those read last.
void TraceReader::check_sum(std::size_t count) {
  checksum_.add(bytes_.data(), count);
  if (word(count) != checksum_.value())
    refuse(begin_ + count, fmt::format("checksum {:08x}", word(count)),
           fmt::format("{:08x}, that of the bytes before it", checksum_.value()));
}

bool TraceReader::cut_off(std::uint64_t frame_byte, const std::string& found) {
  warning_ = fmt::format("{}: is cut off in frame {}, which begins at byte {}: has {}", name_, frames_,
                         frame_byte, found);
  return false;
}

void TraceReader::refuse(std::uint64_t byte, const std::string& found, const std::string& expected) const {
  const std::string frame = begin_ == 0 ? "" : fmt::format("frame {}, ", frames_);
  throw FileError(fmt::format("{}: {}byte {}: {}; expected {}", name_, frame, byte, found, expected));
}

}  // namespace broadside::lab
