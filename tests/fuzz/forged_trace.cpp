// Fuzzes the reader of traces by meaning. The bytes say what frames a trace has, and how they are then
// forged. The reader gives the frames up to the first that breaks a rule of docs/trace-format.md and refuses
// that one; a tracker that follows what was read is under the law.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/recorder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "debug/definition.hpp"
#include "history_bytes.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/trace/trace.hpp"
#include "sealed_trace.hpp"
#include "world/byte_stream.hpp"

namespace broadside::fuzz {
namespace {

template <int D, typename Real>
struct Forgery {
  struct Set {
    std::uint32_t slot = 0;
    Box<D, Real> box{};
  };

  struct ForgedFrame {
    std::uint32_t slots = 0;
    std::vector<std::uint32_t> removed{};
    std::vector<Set> set{};
  };

  std::uint8_t dimension = D;
  std::uint8_t coordinate_bytes = sizeof(Real);
  std::uint16_t reserved = 0;
  std::vector<ForgedFrame> frames{};

  /// A frame of a trace with this many slots before.
  static ForgedFrame any_frame(Bytes& bytes, std::uint32_t before) {
    ForgedFrame frame{static_cast<std::uint32_t>(bytes.below(10)), {}, {}};
    for (std::uint32_t slot = 0; slot < frame.slots; ++slot) {
      const std::size_t what = bytes.below(6);
      if (slot < before && what > 2) continue;
      if (what == 0)
        frame.removed.push_back(slot);
      else
        frame.set.push_back({slot, any_box<D, Real>(bytes)});
    }
    return frame;
  }

  void mutate(Bytes& bytes) {
    constexpr Real infinity = std::numeric_limits<Real>::infinity();
    if (frames.empty()) return;
    const std::size_t at = bytes.below(frames.size());
    const auto place = frames.begin() + static_cast<std::ptrdiff_t>(at);
    ForgedFrame& frame = frames[at];
    const std::size_t what = bytes.below(16);
    const auto slot = static_cast<std::uint32_t>(bytes.below(11));
    if (what == 0) frame.slots = bytes.next() < 200 ? slot : std::numeric_limits<std::uint32_t>::max() - slot;
    if (what == 1) frame.removed.push_back(slot);
    if (what == 2) frame.set.push_back({slot, any_box<D, Real>(bytes)});
    if (what == 3) frame.removed.insert(frame.removed.begin(), slot);
    if (what == 4) std::ranges::reverse(frame.removed);
    if (what == 5) std::ranges::reverse(frame.set);
    if (what == 6) frames.erase(place);
    if (what == 7) frames.insert(place, ForgedFrame(frame));
    if (what == 8) std::swap(frame, frames[bytes.below(frames.size())]);
    if (what == 9 && !frame.removed.empty()) frame.removed.pop_back();
    if (what == 10) {
      const std::size_t field = bytes.below(12);
      if (field == 0) dimension = static_cast<std::uint8_t>(bytes.below(5));
      if (field == 1) coordinate_bytes = static_cast<std::uint8_t>(bytes.below(10));
      if (field == 2) reserved = bytes.next();
    }
    if (what < 11 || frame.set.empty()) return;
    Set& set = frame.set[bytes.below(frame.set.size())];
    if (what == 11) set.slot = slot;
    if (what == 12) std::swap(set.box.min, set.box.max);
    if (what == 13) set.box.max[D - 1] = std::numeric_limits<Real>::quiet_NaN();
    if (what == 14) set.box.min.fill(-infinity), set.box.max.fill(infinity);
    if (what == 15) set.box = absent_box<D, Real>();
  }

  std::string encoded() const {
    core::ByteWriter out;
    for (const unsigned char byte : trace::magic) out.put(byte);
    out.put(trace::version);
    out.put(dimension);
    out.put(coordinate_bytes);
    out.put(reserved);
    out.put(std::uint32_t{0});
    for (const ForgedFrame& frame : frames) {
      out.put(trace::frame_mark);
      out.put(frame.slots);
      out.put(static_cast<std::uint32_t>(frame.removed.size()));
      out.put(static_cast<std::uint32_t>(frame.set.size()));
      out.put(std::uint32_t{0});
      for (const std::uint32_t removed : frame.removed) out.put(removed);
      for (const Set& set : frame.set) {
        out.put(set.slot);
        for (const Real bound : set.box.min) out.put(bound);
        for (const Real bound : set.box.max) out.put(bound);
      }
      out.put(std::uint32_t{0});
    }
    const std::vector<std::byte> bytes = std::move(out).sealed();
    const auto* const begin = reinterpret_cast<const char*>(bytes.data());
    return lab::sealed_trace(std::string(begin, begin + bytes.size() - trace::checksum_bytes));
  }

  bool has_right_header() const {
    return dimension == D && coordinate_bytes == sizeof(Real) && reserved == 0;
  }

  /// Whether a frame keeps all rules, where there were this many slots before.
  static bool is_right(const ForgedFrame& frame, std::uint32_t before) {
    std::set<std::uint32_t> named(frame.removed.begin(), frame.removed.end());
    for (const Set& set : frame.set) {
      named.insert(set.slot);
      if (!is_present(set.box)) return false;
    }
    if (named.size() != frame.removed.size() + frame.set.size()) return false;
    if (!named.empty() && *named.rbegin() >= frame.slots) return false;
    if (!std::ranges::is_sorted(frame.removed) || !std::ranges::is_sorted(frame.set, {}, &Set::slot))
      return false;
    const auto added = std::distance(named.lower_bound(before), named.end());
    return frame.slots <= before || static_cast<std::uint64_t>(added) == frame.slots - before;
  }
};

/// Applies a frame that keeps the rules.
template <int D, typename Real>
void apply(const typename Forgery<D, Real>::ForgedFrame& frame, std::vector<Box<D, Real>>& boxes) {
  boxes.resize(frame.slots, absent_box<D, Real>());
  for (const std::uint32_t slot : frame.removed) boxes[slot] = absent_box<D, Real>();
  for (const auto& set : frame.set) boxes[set.slot] = set.box;
}

template <int D, typename Real>
void check_followed(PairTracker<D, Real>& tracker, const std::vector<Box<D, Real>>& boxes,
                    std::span<const BoxId> changed, std::set<Pair>& pairs) {
  std::vector<Pair> begun;
  std::vector<Pair> ended;
  PairCollector begun_sink(begun);
  PairCollector ended_sink(ended);
  const Frame<D, Real> frame{boxes, changed};
  tracker.update(frame, begun_sink, ended_sink);
  for (const Pair pair : ended) expect(pairs.erase(pair) == 1, "a pair ended that did not hold");
  for (const Pair pair : begun) expect(pairs.insert(pair).second, "a pair began that held");
  expect(std::ranges::equal(pairs, core::pairs_by_definition(frame)), "the pairs are wrong");
}

template <int D, typename Real>
void check(Bytes& bytes) {
  Forgery<D, Real> forgery;
  const std::size_t count = 1 + bytes.below(5);
  for (std::size_t i = 0; i < count; ++i)
    forgery.frames.push_back(Forgery<D, Real>::any_frame(bytes, i == 0 ? 0 : forgery.frames.back().slots));
  for (std::size_t i = bytes.below(4); i > 0; --i) forgery.mutate(bytes);

  constexpr std::array<const char*, 4> specs = {"auto", "quadtree", "grid", "brute_force"};
  const auto tracker = make_tracker<D, Real>(specs[bytes.below(specs.size())]);
  std::set<Pair> pairs;
  std::istringstream stream(forgery.encoded());
  std::unique_ptr<lab::TraceReader> reader;
  try {
    reader = std::make_unique<lab::TraceReader>(stream, "forged");
  } catch (const lab::FileError&) {
  }
  if (!forgery.has_right_header()) return;
  expect(reader != nullptr, "a right header was refused");
  std::vector<Box<D, Real>> expected;
  std::vector<Box<D, Real>> boxes;
  for (const auto& frame : forgery.frames) {
    bool is_read = false;
    try {
      is_read = reader->next_frame();
    } catch (const lab::FileError&) {
      expect(!Forgery<D, Real>::is_right(frame, static_cast<std::uint32_t>(expected.size())),
             "a right frame was refused");
      expect(!reader->next_frame(), "the reader goes on behind a frame that it refused");
      return;
    }
    expect(is_read && Forgery<D, Real>::is_right(frame, static_cast<std::uint32_t>(expected.size())),
           "a wrong frame was read, or a right one left out");
    apply<D, Real>(frame, expected);
    boxes.resize(reader->slots(), absent_box<D, Real>());
    for (std::size_t i = 0; i < reader->changed().size(); ++i)
      boxes.at(index(reader->changed()[i])) = reader->template box<D, Real>(i);
    expect(boxes == expected, "the boxes read are wrong");
    check_followed(*tracker, boxes, reader->changed(), pairs);
  }
  expect(!reader->next_frame() && reader->warning().empty(), "a whole trace was read as another one");
}

}  // namespace
}  // namespace broadside::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::fuzz::Bytes bytes(data, size);
  if (bytes.next() % 2 == 0)
    broadside::fuzz::check<2, float>(bytes);
  else
    broadside::fuzz::check<3, double>(bytes);
  return 0;
}
