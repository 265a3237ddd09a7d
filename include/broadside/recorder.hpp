// Recorder: writes an engine's boxes, frame by frame, to a trace that Broadside reads. It can also write the
// pairs that the engine's own broad phase reports, for Broadside to check. This header needs only C++11 and
// its standard library: copy it into the engine. docs/trace-format.md describes the bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

// In libstdc++'s debug mode a Recorder has different symbols, because its vectors are larger than those of a
// Recorder in a library compiled without debug mode.
#ifdef _GLIBCXX_DEBUG
#define BROADSIDE_RECORDER_ABI __attribute__((abi_tag("debug")))
#else
#define BROADSIDE_RECORDER_ABI
#endif

namespace broadside {

/// What the writers and readers of traces share.
namespace trace {

constexpr std::array<unsigned char, 8> magic = {{0x89, 'B', 'T', 'R', '\r', '\n', 0x1a, '\n'}};
constexpr std::uint32_t version = 1;              // of a trace of boxes alone
constexpr std::uint32_t pairs_version = 2;        // of a trace that also holds an engine's pairs
constexpr std::uint32_t frame_mark = 0x4d415246;  // "FRAM"
constexpr std::size_t header_bytes = 20;          // the file's header, and each frame's
constexpr std::size_t margin_bytes = 8;           // added to the file's header if there are pairs
constexpr std::size_t pair_count_bytes = 20;      // added to each frame's header if there are pairs
constexpr std::size_t filter_bytes = 28;
constexpr std::size_t pair_bytes = 8;
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
/// A slot is a box's place in an array. The caller chooses it; use small numbers, and reuse free ones. Boxes
/// are closed; infinite extents are allowed.
///
/// A trace opened with a margin also holds the pairs that the engine's own broad phase reports, which
/// `broadside verify` then checks. In each frame, the engine promises to report
///
/// - every two boxes that overlap, except ignored pairs and pairs whose filters reject each other;
/// - no pair whose boxes, each enlarged by the margin on every side, do not overlap;
/// - no pair twice.
///
/// Boxes and pairs of a frame belong to the same moment. If a step looks for pairs and then moves the boxes,
/// record the boxes before the step and the pairs after it:
///
///     recorder.open("recording.btrace", margin);
///     for (...) {
///       recorder.set(slot, min, max);
///       recorder.set_filter(slot, category, mask);  // of a box that is new, if not all pairs count
///       engine.step();
///       recorder.add_pair(slot, other_slot);        // each pair that the broad phase holds now
///       recorder.end_frame();
///     }
///
/// Errors: a call that fails returns false, and error() returns the text of the first failure since open(). A
/// call that is refused for its arguments changes nothing, and recording goes on. After a failed write,
/// nothing more is written. Only the standard library throws, and only if memory runs out, so the recorder
/// works with exceptions switched off.
///
/// When end_frame() returns, the frame has left the process: a crash loses at most the current frame. Time of
/// a frame: proportional to the slots named since the last frame, plus sorting the pairs. Memory: two boxes
/// per slot and two numbers per pair; with pairs, also two filters per slot. One thread at a time.
template <int D, typename Real = float>
class BROADSIDE_RECORDER_ABI Recorder {
  static_assert(D == 2 || D == 3, "a trace has two or three dimensions");
  static_assert(std::numeric_limits<Real>::is_iec559 && (sizeof(Real) == 4 || sizeof(Real) == 8),
                "a trace holds float or double of IEC 559");

 public:
  /// Takes the next bytes of a trace; returns whether it could take them.
  using Write = std::function<bool(const void* bytes, std::size_t count)>;

  Recorder() = default;
  /// Closes the trace as close() does, but reports no failure.
  ~Recorder() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Begins a trace in a file, which is created or emptied. Closes the trace that was open before.
  bool open(const std::string& path) {
    close();
    return open_file(path, false, 0);
  }

  /// The same for a trace that also holds the engine's pairs, which it promises within this margin (see
  /// above). Refused if the margin is negative, infinite or NaN; no file is then created.
  bool open(const std::string& path, double margin) {
    close();
    return is_margin(path, margin) && open_file(path, true, margin);
  }

  /// Begins a trace that is passed to `write`, up to 64 KiB per call.
  bool open_with(Write write) {
    close();
    path_ = "recorder";
    return begin(std::move(write), false, 0);
  }

  /// The same with pairs.
  bool open_with(Write write, double margin) {
    close();
    path_ = "recorder";
    return is_margin(path_, margin) && begin(std::move(write), true, margin);
  }

  /// Puts the box with corners min[0 .. D-1] and max[0 .. D-1] into a slot; min = +inf and max = -inf on
  /// every axis empties it. Refused if a coordinate is NaN or min > max. Adds empty slots between the last
  /// slot so far and this one.
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

  /// Empties a slot; harmless if it is empty.
  bool remove(std::uint32_t slot) {
    if (!is_open("remove")) return false;
    if (slot < now_.size()) store(slot, absent_box());
    return true;
  }

  /// Replaces all boxes: slot i gets box i, of 2 D coordinates (min, then max), and there are no further
  /// slots. Refused as a whole if set() would refuse a box. Finds changes by comparing all boxes: O(count).
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

  /// Removes the slots from `count` on, or adds empty ones up to that number.
  bool resize(std::size_t count) {
    if (!is_open("resize")) return false;
    if (count > std::numeric_limits<std::uint32_t>::max())
      return fail(path_ + ": " + std::to_string(count) + " slots; expected at most 4294967295");
    const std::size_t before = now_.size();
    for (std::size_t slot = count; slot < before; ++slot) touch(slot);
    now_.resize(count, absent_box());
    if (has_pairs_) filters_.resize(count, standard_filter());
    if (is_touched_.size() < count) is_touched_.resize(count);
    for (std::size_t slot = before; slot < count; ++slot) touch(slot);
    return true;
  }

  /// Sets which pairs of this box must be reported, by the usual rules of engines: two boxes form a pair if
  /// each one's mask has a bit of the other one's category. If both have the same group, not 0, they
  /// do if it is positive, and do not if it is negative. Two static boxes never do. Holds until the slot is
  /// emptied; a new box has category 1 and a mask of all bits. Refused if the slot is empty, and in a trace
  /// without pairs.
  bool set_filter(std::uint32_t slot, std::uint64_t category, std::uint64_t mask, std::int32_t group = 0,
                  bool is_static = false) {
    if (!takes_pairs("set_filter")) return false;
    if (!has_box(slot))
      return fail(path_ + ": filter of slot " + std::to_string(slot) + ", which is empty; expected a box");
    touch(slot);
    filters_[slot] = {category, mask, group, is_static};
    return true;
  }

  /// Adds a pair that the engine's broad phase reports in this frame. Call it for each pair that the engine
  /// holds, in any order and with either slot first, and twice for a pair that it reports twice. The next
  /// frame begins without pairs. Refused if the slots are equal or one is empty, and in a trace without
  /// pairs.
  bool add_pair(std::uint32_t first, std::uint32_t second) {
    return put_pair("add_pair", first, second, pairs_now_);
  }

  /// Adds a pair that the engine need not report in this frame although its boxes may overlap, such as two
  /// bodies that a joint connects. The next frame begins without such pairs. Refused as by add_pair().
  bool ignore_pair(std::uint32_t first, std::uint32_t second) {
    return put_pair("ignore_pair", first, second, ignored_now_);
  }

  /// Writes what has changed since the last frame; in the first frame, everything has. Returns false also if
  /// a slot of an added pair has since been emptied: the frame is then written without that pair.
  bool end_frame() {
    if (!is_open("end_frame")) return false;
    const bool pairs_are_right = !has_pairs_ || settle_pairs();
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
    if (has_pairs_) put_pair_counts();
    put_checksum();
    for (const std::uint32_t slot : touched_) {
      if (is_absent(slot)) put(slot);
    }
    for (const std::uint32_t slot : touched_) {
      if (is_absent(slot)) continue;
      put(slot);
      for (const Bits coordinate : now_[slot]) put(coordinate);
    }
    if (has_pairs_) put_pair_changes();
    put_checksum();

    written_.resize(now_.size());
    is_touched_.resize(now_.size());
    for (const std::uint32_t slot : touched_) written_[slot] = now_[slot];
    touched_.clear();
    return flush() && pairs_are_right;
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

  /// The first failure since open(); empty if there was none.
  const std::string& error() const noexcept { return error_; }

 private:
  // Boxes are kept, compared and tested for NaNs as bits: -0.0 then differs from 0.0, and the recorder works
  // in engines compiled with -ffast-math.
  using Bits = typename std::conditional<sizeof(Real) == 4, std::uint32_t, std::uint64_t>::type;
  using Box = std::array<Bits, 2 * std::size_t{D}>;  // min, then max

  static constexpr std::size_t axes = D;
  static constexpr Bits infinity =
      sizeof(Real) == 4 ? Bits{0x7f800000} : static_cast<Bits>(0x7ff0000000000000);
  static constexpr Bits sign = static_cast<Bits>(Bits{1} << (8 * sizeof(Real) - 1));

  struct SlotFilter {
    std::uint64_t category;
    std::uint64_t mask;
    std::int32_t group;
    bool is_static;

    bool operator==(const SlotFilter& other) const noexcept {
      return category == other.category && mask == other.mask && group == other.group &&
             is_static == other.is_static;
    }
  };
  using Pairs = std::vector<std::uint64_t>;  // the smaller slot in the upper half

  /// The difference between the pairs of two frames.
  struct PairChanges {
    Pairs ended;
    Pairs begun;

    void take(const Pairs& before, const Pairs& now) {
      ended.clear();
      begun.clear();
      std::set_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(ended));
      std::set_difference(now.begin(), now.end(), before.begin(), before.end(), std::back_inserter(begun));
    }
  };

  static SlotFilter standard_filter() noexcept { return {1, ~std::uint64_t{0}, 0, false}; }

  bool is_margin(const std::string& path, double margin) {
    error_.clear();
    std::uint64_t bits;
    std::memcpy(&bits, &margin, sizeof bits);
    const bool is_finite = (bits >> 52 & 0x7ff) != 0x7ff;
    const bool is_negative = bits >> 63 != 0 && bits << 1 != 0;
    if (is_finite && !is_negative) return true;
    return fail(path + ": margin " + std::to_string(margin) + "; expected a finite number, 0 or more");
  }

  bool open_file(const std::string& path, bool has_pairs, double margin) {
    errno = 0;
    file_ = std::fopen(path.c_str(), "wb");
    path_ = path;
    if (file_ == nullptr) {
      error_.clear();
      return fail(path + ": cannot be created: " + std::strerror(errno));
    }
    // The recorder has its own buffer, so bytes written leave the process at once.
    std::setvbuf(file_, nullptr, _IONBF, 0);
    std::FILE* const file = file_;
    return begin(
        [file](const void* bytes, std::size_t count) { return std::fwrite(bytes, 1, count, file) == count; },
        has_pairs, margin);
  }

  bool begin(Write write, bool has_pairs, double margin) {
    error_.clear();
    checksum_ = trace::Checksum();
    now_.clear();
    written_.clear();
    touched_.clear();
    is_touched_.clear();
    has_pairs_ = has_pairs;
    filters_.clear();
    written_filters_.clear();
    for (Pairs* const pairs : {&pairs_now_, &pairs_before_, &ignored_now_, &ignored_before_}) pairs->clear();
    buffer_.resize(std::size_t{1} << 16);
    used_ = summed_ = 0;
    write_ = std::move(write);
    for (const unsigned char byte : trace::magic) put(byte);
    put(has_pairs ? trace::pairs_version : trace::version);
    put(static_cast<std::uint32_t>(axes | sizeof(Real) << 8));
    if (has_pairs) {
      std::uint64_t bits;
      std::memcpy(&bits, &margin, sizeof bits);
      put(bits << 1 == 0 ? std::uint64_t{0} : bits);  // -0.0 counts as a margin of 0
    }
    put_checksum();
    return flush();
  }

  bool is_open(const char* call) {
    if (write_) return true;
    return fail(std::string("recorder: ") + call + "() without a trace; expected a successful open() first");
  }

  bool takes_pairs(const char* call) {
    if (!is_open(call)) return false;
    if (has_pairs_) return true;
    return fail(path_ + ": " + call + "() in a trace without pairs; expected open() with a margin first");
  }

  bool has_box(std::uint32_t slot) const noexcept {
    return slot < now_.size() && !(now_[slot] == absent_box());
  }

  static std::string text_of_pair(std::uint32_t first, std::uint32_t second) {
    return "pair (" + std::to_string(first) + ", " + std::to_string(second) + ")";
  }

  bool put_pair(const char* call, std::uint32_t first, std::uint32_t second, Pairs& pairs) {
    if (!takes_pairs(call)) return false;
    const auto refuse_pair = [&](const std::string& why) {
      return fail(path_ + ": " + text_of_pair(first, second) + " " + why);
    };
    if (first == second) return refuse_pair("of a slot and itself; expected two different slots");
    for (const std::uint32_t slot : {first, second}) {
      if (!has_box(slot))
        return refuse_pair("names slot " + std::to_string(slot) + ", which is empty; expected a box");
    }
    pairs.push_back(std::uint64_t{std::min(first, second)} << 32 | std::max(first, second));
    return true;
  }

  /// Sorts the frame's pairs and drops those with an emptied slot. Returns whether there were none.
  bool settle_pairs() {
    bool are_right = true;
    const auto is_gone = [&](std::uint64_t pair) {
      const std::uint32_t first = static_cast<std::uint32_t>(pair >> 32);
      const std::uint32_t second = static_cast<std::uint32_t>(pair);
      if (has_box(first) && has_box(second)) return false;
      are_right = false;
      fail(path_ + ": " + text_of_pair(first, second) + " names slot " +
           std::to_string(has_box(first) ? second : first) +
           ", which was emptied before the frame ended; expected a box");
      return true;
    };
    for (Pairs* const pairs : {&pairs_now_, &ignored_now_}) {
      pairs->erase(std::remove_if(pairs->begin(), pairs->end(), is_gone), pairs->end());
      std::sort(pairs->begin(), pairs->end());
    }
    ignored_now_.erase(std::unique(ignored_now_.begin(), ignored_now_.end()), ignored_now_.end());
    pair_changes_.take(pairs_before_, pairs_now_);
    ignored_changes_.take(ignored_before_, ignored_now_);

    // Readers know that a slot without a box has the default filter.
    written_filters_.resize(now_.size(), standard_filter());
    refiltered_.clear();
    for (const std::uint32_t slot : touched_) {
      if (slot >= now_.size()) continue;
      if (has_box(slot) && !(filters_[slot] == written_filters_[slot])) refiltered_.push_back(slot);
      written_filters_[slot] = filters_[slot];
    }
    std::sort(refiltered_.begin(), refiltered_.end());
    return are_right;
  }

  void put_pair_counts() {
    put(static_cast<std::uint32_t>(refiltered_.size()));
    for (const PairChanges* const changes : {&pair_changes_, &ignored_changes_}) {
      put(static_cast<std::uint32_t>(changes->ended.size()));
      put(static_cast<std::uint32_t>(changes->begun.size()));
    }
  }

  void put_pair_changes() {
    for (const std::uint32_t slot : refiltered_) {
      const SlotFilter& filter = filters_[slot];
      put(slot);
      put(filter.category);
      put(filter.mask);
      put(static_cast<std::uint32_t>(filter.group));
      put(std::uint32_t{filter.is_static});
    }
    for (const PairChanges* const changes : {&pair_changes_, &ignored_changes_}) {
      for (const Pairs* const pairs : {&changes->ended, &changes->begun}) {
        for (const std::uint64_t pair : *pairs) {
          put(static_cast<std::uint32_t>(pair >> 32));
          put(static_cast<std::uint32_t>(pair));
        }
      }
    }
    pairs_before_.swap(pairs_now_);
    pairs_now_.clear();
    ignored_before_.swap(ignored_now_);
    ignored_now_.clear();
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

  /// An integer that orders as the coordinates do, including infinities, and is 0 for -0.0.
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
    if (has_pairs_ && box == absent_box()) filters_[slot] = standard_filter();
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

  /// Later checksums leave out the bytes of earlier ones.
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
                ": cannot be written: " + (errno != 0 ? std::strerror(errno) : "write() refused the bytes"));
  }

  std::string path_;
  std::string error_;
  std::FILE* file_ = nullptr;
  Write write_;  // empty if no trace is open or writing has failed
  std::vector<unsigned char> buffer_;
  std::size_t used_ = 0;    // bytes in the buffer ...
  std::size_t summed_ = 0;  // ... and how many of them the checksum has seen
  trace::Checksum checksum_;
  std::vector<Box> now_;                   // the boxes as they are now
  std::vector<Box> written_;               // the boxes of the last frame
  std::vector<std::uint32_t> touched_;     // slots that may have changed since then, each once
  std::vector<unsigned char> is_touched_;  // for each slot, before or now

  // Only for traces with pairs.
  bool has_pairs_ = false;
  std::vector<SlotFilter> filters_;          // for each slot; the default one if it is empty
  std::vector<SlotFilter> written_filters_;  // the filters of the last frame
  std::vector<std::uint32_t> refiltered_;    // slots whose filters this frame changes
  Pairs pairs_now_;                          // of the current frame
  Pairs pairs_before_;                       // of the last frame, sorted
  Pairs ignored_now_;
  Pairs ignored_before_;
  PairChanges pair_changes_;
  PairChanges ignored_changes_;
};

using Recorder2 = Recorder<2>;
using Recorder3 = Recorder<3>;

}  // namespace broadside
