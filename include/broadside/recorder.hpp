// Recorder: writes an engine's boxes, frame after frame, to a trace that Broadside reads. One header that
// needs C++11 and its standard library alone: copy it into the engine. The bytes are described in
// docs/trace-format.md.
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace broadside {

/// What the writers and readers of traces share.
namespace trace {

constexpr std::array<unsigned char, 8> magic = {{0x89, 'B', 'T', 'R', '\r', '\n', 0x1a, '\n'}};
constexpr std::uint32_t version = 1;
constexpr std::uint32_t frame_mark = 0x4d415246;  // "FRAM"
constexpr std::size_t header_bytes = 20;          // of the file, and as many of a frame
constexpr std::size_t checksum_bytes = 4;

/// CRC-32C (Castagnoli's polynomial, as in iSCSI, RFC 3720) of all bytes given so far, eight at a time
/// (Kounavis and Berry 2005, "slicing by 8").
class Checksum {
 public:
  void add(const unsigned char* bytes, std::size_t count) noexcept {
    const Tables& t = tables();
    for (; count >= 8; count -= 8, bytes += 8) {
      const std::uint32_t s = state_;
      state_ = t[7][(s ^ bytes[0]) & 0xff] ^ t[6][(s >> 8 ^ bytes[1]) & 0xff] ^
               t[5][(s >> 16 ^ bytes[2]) & 0xff] ^ t[4][s >> 24 ^ bytes[3]] ^ t[3][bytes[4]] ^
               t[2][bytes[5]] ^ t[1][bytes[6]] ^ t[0][bytes[7]];
    }
    for (; count > 0; --count, ++bytes) state_ = t[0][(state_ ^ *bytes) & 0xff] ^ state_ >> 8;
  }

  std::uint32_t value() const noexcept { return ~state_; }

 private:
  using Tables = std::array<std::array<std::uint32_t, 256>, 8>;

  static const Tables& tables() noexcept {
    static const Tables made = make_tables();
    return made;
  }

  static Tables make_tables() noexcept {
    Tables made{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      std::uint32_t rest = byte;
      for (int bit = 0; bit < 8; ++bit) rest = (rest & 1) != 0 ? rest >> 1 ^ 0x82f63b78 : rest >> 1;
      made[0][byte] = rest;
    }
    for (std::size_t k = 1; k < 8; ++k) {
      for (std::size_t byte = 0; byte < 256; ++byte)
        made[k][byte] = made[0][made[k - 1][byte] & 0xff] ^ made[k - 1][byte] >> 8;
    }
    return made;
  }

  std::uint32_t state_ = 0xffffffff;
};

}  // namespace trace

/// Writes a trace of boxes in D (2 or 3) dimensions with coordinates of type Real (float or double).
///
///     broadside::Recorder3 recorder;
///     recorder.open("recording.btrace");
///     for (...) {                      // each step of the engine
///       recorder.set(slot, min, max);  // each box that may have moved; one that did not costs nothing
///       recorder.remove(slot);         // each box that is gone
///       recorder.end_frame();
///     }
///     if (!recorder.close()) std::puts(recorder.error().c_str());
///
/// A slot is a box's place in an array: the caller's choice, small numbers, each used again as it becomes
/// free. Boxes are closed; infinite extents are allowed.
///
/// Errors: a call that fails returns false, and error() says why: the text of the first failure since open().
/// A call refused for its arguments changes nothing, and recording goes on; after a failed write nothing more
/// is written. Nothing here throws but the standard library when memory runs out, so it works with exceptions
/// switched off.
///
/// A frame has left the process when end_frame() returns: a crash of the process loses at most the frame
/// under way. Time a frame: that of the slots named since the last one; memory: two boxes a slot. One thread
/// at a time.
template <int D, typename Real = float>
class Recorder {
  static_assert(D == 2 || D == 3, "a trace has two or three dimensions");
  static_assert(std::numeric_limits<Real>::is_iec559 && (sizeof(Real) == 4 || sizeof(Real) == 8),
                "a trace holds float or double of IEC 559");

 public:
  /// Takes the next bytes of a trace; returns whether they were taken.
  using Write = std::function<bool(const void* bytes, std::size_t count)>;

  Recorder() = default;
  /// Does what close() does, but for telling what failed.
  ~Recorder() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Begins a trace in a file, which is created, or emptied. The trace that was open before is closed.
  bool open(const std::string& path) {
    close();
    errno = 0;
    file_ = std::fopen(path.c_str(), "wb");
    path_ = path;
    if (file_ == nullptr) {
      error_.clear();
      return fail(path + ": cannot be created: " + std::strerror(errno));
    }
    // What is written leaves the process at once; it is collected here.
    std::setvbuf(file_, nullptr, _IONBF, 0);
    std::FILE* const file = file_;
    return begin(
        [file](const void* bytes, std::size_t count) { return std::fwrite(bytes, 1, count, file) == count; });
  }

  /// Begins a trace that goes wherever `write` puts it, some 64 KiB or less a call.
  bool open_with(Write write) {
    close();
    path_ = "recorder";
    return begin(std::move(write));
  }

  /// Puts the box with corners min[0 .. D-1] and max[0 .. D-1] in a slot; min = +inf and max = -inf on every
  /// axis empties it. Refused where a coordinate is a NaN or min > max. Slots between the last one so far and
  /// this one are empty.
  bool set(std::uint32_t slot, const Real* min, const Real* max) {
    if (!is_open("set")) return false;
    if (slot == std::numeric_limits<std::uint32_t>::max())
      return fail(path_ + ": slot " + std::to_string(slot) + "; expected a smaller one");
    const Box box = box_of(min, max);
    if (!is_valid(box)) return refuse(slot, min, max);
    if (slot >= now_.size()) resize(std::size_t{slot} + 1);
    store(slot, box);
    return true;
  }

  /// Empties a slot; harmless where it is empty.
  bool remove(std::uint32_t slot) {
    if (!is_open("remove")) return false;
    if (slot < now_.size()) store(slot, absent_box());
    return true;
  }

  /// The whole array at once: box i, from 2 D coordinates each (min, then max), in slot i, and no slots
  /// beyond. Refused altogether where a box would be. Finds what changed by comparing: O(count).
  bool set_boxes(const Real* boxes, std::size_t count) {
    if (!is_open("set_boxes")) return false;
    if (count > std::numeric_limits<std::uint32_t>::max())
      return fail(path_ + ": " + std::to_string(count) + " boxes; expected at most 4294967295");
    for (std::size_t i = 0; i < count; ++i) {
      const Real* const min = boxes + 2 * axes * i;
      if (!is_valid(box_of(min, min + axes))) return refuse(i, min, min + axes);
    }
    resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Real* const min = boxes + 2 * axes * i;
      store(i, box_of(min, min + axes));
    }
    return true;
  }

  /// Cuts the array off after `count` slots, or extends it by empty ones.
  bool resize(std::size_t count) {
    if (!is_open("resize")) return false;
    if (count > std::numeric_limits<std::uint32_t>::max())
      return fail(path_ + ": " + std::to_string(count) + " slots; expected at most 4294967295");
    const std::size_t before = now_.size();
    for (std::size_t slot = count; slot < before; ++slot) touch(slot);
    now_.resize(count, absent_box());
    if (is_touched_.size() < count) is_touched_.resize(count);
    for (std::size_t slot = before; slot < count; ++slot) touch(slot);
    return true;
  }

  /// Writes what has changed since the last frame; the first frame is all change.
  bool end_frame() {
    if (!is_open("end_frame")) return false;
    const auto same = [this](std::uint32_t slot) {
      is_touched_[slot] = 0;
      return slot >= now_.size() || (slot < written_.size() && written_[slot] == now_[slot]);
    };
    touched_.erase(std::remove_if(touched_.begin(), touched_.end(), same), touched_.end());
    std::sort(touched_.begin(), touched_.end());
    const auto is_absent = [this](std::uint32_t slot) { return now_[slot] == absent_box(); };
    const auto removed = std::count_if(touched_.begin(), touched_.end(), is_absent);

    put(trace::frame_mark);
    put(static_cast<std::uint32_t>(now_.size()));
    put(static_cast<std::uint32_t>(removed));
    put(static_cast<std::uint32_t>(touched_.size() - static_cast<std::size_t>(removed)));
    put_checksum();
    for (const std::uint32_t slot : touched_) {
      if (is_absent(slot)) put(slot);
    }
    for (const std::uint32_t slot : touched_) {
      if (is_absent(slot)) continue;
      put(slot);
      for (const Bits coordinate : now_[slot]) put(coordinate);
    }
    put_checksum();

    written_.resize(now_.size());
    is_touched_.resize(now_.size());
    for (const std::uint32_t slot : touched_) written_[slot] = now_[slot];
    touched_.clear();
    return flush();
  }

  /// Ends the trace with the last whole frame. Returns whether nothing has failed since open().
  bool close() {
    if (std::FILE* const file = file_) {
      file_ = nullptr;
      if (std::fclose(file) != 0) fail(path_ + ": cannot be closed: " + std::strerror(errno));
    }
    write_ = nullptr;
    return error_.empty();
  }

  /// What failed first since open(), and empty if nothing did.
  const std::string& error() const noexcept { return error_; }

 private:
  // Boxes are kept, compared and tested for NaNs as bits, so that -0.0 is not 0.0, and so that it all works
  // in engines compiled with -ffast-math.
  using Bits = typename std::conditional<sizeof(Real) == 4, std::uint32_t, std::uint64_t>::type;
  using Box = std::array<Bits, 2 * std::size_t{D}>;  // min, then max

  static constexpr std::size_t axes = D;
  static constexpr Bits infinity =
      sizeof(Real) == 4 ? Bits{0x7f800000} : static_cast<Bits>(0x7ff0000000000000);
  static constexpr Bits sign = static_cast<Bits>(Bits{1} << (8 * sizeof(Real) - 1));

  bool begin(Write write) {
    error_.clear();
    checksum_ = trace::Checksum();
    now_.clear();
    written_.clear();
    touched_.clear();
    is_touched_.clear();
    buffer_.resize(std::size_t{1} << 16);
    used_ = summed_ = 0;
    write_ = std::move(write);
    for (const unsigned char byte : trace::magic) put(byte);
    put(trace::version);
    put(static_cast<std::uint32_t>(axes | sizeof(Real) << 8));
    put_checksum();
    return flush();
  }

  bool is_open(const char* call) {
    if (write_) return true;
    return fail(std::string("recorder: ") + call + "() without a trace; expected a successful open() before");
  }

  bool fail(const std::string& text) {
    if (error_.empty()) error_ = text;
    return false;
  }

  bool refuse(std::size_t slot, const Real* min, const Real* max) {
    std::string found[2];
    for (std::size_t axis = 0; axis < axes; ++axis) {
      found[0] += (axis > 0 ? ", " : "") + std::to_string(min[axis]);
      found[1] += (axis > 0 ? ", " : "") + std::to_string(max[axis]);
    }
    return fail(path_ + ": slot " + std::to_string(slot) + " is given min (" + found[0] + ") and max (" +
                found[1] + "); expected numbers with min <= max");
  }

  static Bits bits_of(Real coordinate) noexcept {
    Bits bits;
    std::memcpy(&bits, &coordinate, sizeof bits);
    return bits;
  }

  static Box absent_box() noexcept {
    Box box;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      box[axis] = infinity;
      box[axes + axis] = infinity | sign;
    }
    return box;
  }

  static Box box_of(const Real* min, const Real* max) noexcept {
    Box box;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      box[axis] = bits_of(min[axis]);
      box[axes + axis] = bits_of(max[axis]);
    }
    return box;
  }

  /// A whole number that orders as the coordinates do, the infinities included, and is 0 for -0.0.
  static std::int64_t order(Bits coordinate) noexcept {
    const std::int64_t size = static_cast<std::int64_t>(coordinate & ~sign);
    return (coordinate & sign) != 0 ? -size : size;
  }

  static bool is_valid(const Box& box) noexcept {
    for (const Bits coordinate : box) {
      if ((coordinate & ~sign) > infinity) return false;
    }
    bool ordered = true;
    for (std::size_t axis = 0; axis < axes; ++axis)
      ordered = ordered && order(box[axis]) <= order(box[axes + axis]);
    return ordered || box == absent_box();
  }

  void touch(std::size_t slot) {
    if (is_touched_[slot] != 0) return;
    is_touched_[slot] = 1;
    touched_.push_back(static_cast<std::uint32_t>(slot));
  }

  void store(std::size_t slot, const Box& box) {
    if (now_[slot] == box) return;
    touch(slot);
    now_[slot] = box;
  }

  template <typename Number>
  void put(Number number) {
    if (used_ + sizeof number > buffer_.size()) flush();
    for (std::size_t i = 0; i < sizeof number; ++i)
      buffer_[used_ + i] = static_cast<unsigned char>(number >> 8 * i & 0xff);
    used_ += sizeof number;
  }

  void sum() {
    checksum_.add(buffer_.data() + summed_, used_ - summed_);
    summed_ = used_;
  }

  /// A checksum does not count in those after it.
  void put_checksum() {
    sum();
    put(checksum_.value());
    summed_ = used_;
  }

  bool flush() {
    sum();
    const std::size_t count = used_;
    used_ = summed_ = 0;
    if (!write_) return false;
    errno = 0;
    if (write_(buffer_.data(), count)) return true;
    write_ = nullptr;
    return fail(path_ +
                ": cannot be written: " + (errno != 0 ? std::strerror(errno) : "the bytes were not taken"));
  }

  std::string path_;
  std::string error_;
  std::FILE* file_ = nullptr;
  Write write_;  // empty where no trace is open, or writing has failed
  std::vector<unsigned char> buffer_;
  std::size_t used_ = 0;    // bytes in the buffer ...
  std::size_t summed_ = 0;  // ... and those of them that the checksum has seen
  trace::Checksum checksum_;
  std::vector<Box> now_;                   // the boxes as they are now
  std::vector<Box> written_;               // as they were in the last frame
  std::vector<std::uint32_t> touched_;     // slots that may have changed since then, each once
  std::vector<unsigned char> is_touched_;  // for each slot, of now or then
};

using Recorder2 = Recorder<2>;
using Recorder3 = Recorder<3>;

}  // namespace broadside
