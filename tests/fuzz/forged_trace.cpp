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

#include "debug/tracker_fault.hpp"
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

  struct SlotFilter {
    std::uint32_t slot = 0;
    std::uint32_t is_static = 0;
  };

  /// The lists of a frame: pairs that are no longer reported, that are, and likewise ignored ones.
  using PairLists = std::array<std::vector<Pair>, 4>;

  struct ForgedFrame {
    std::uint32_t slots = 0;
    std::vector<std::uint32_t> removed{};
    std::vector<Set> set{};
    std::vector<SlotFilter> filters{};
    PairLists pairs{};
  };

  /// What holds in a frame, as far as pairs need it.
  struct State {
    std::vector<bool> has_box{};
    std::array<std::multiset<Pair>, 2> pairs{};  // reported, ignored
  };

  bool has_pairs = false;
  double margin = 0.5;
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
        frame.set.push_back({slot, lattice_box<D, Real>(bytes)});
    }
    return frame;
  }

  /// Draws pairs and filters for a frame that keeps the rules, given what held before it.
  static void draw_pairs(Bytes& bytes, ForgedFrame& frame, State& state) {
    const auto is_gone = [&](Pair pair) { return !holds(state, pair.first) || !holds(state, pair.second); };
    take_boxes(frame, state);
    for (std::size_t kind = 0; kind < 2; ++kind) {
      for (auto pair = state.pairs[kind].begin(); pair != state.pairs[kind].end();) {
        const bool ends = is_gone(*pair) || bytes.below(4) == 0;
        if (ends) frame.pairs[2 * kind].push_back(*pair);
        pair = ends ? state.pairs[kind].erase(pair) : std::next(pair);
      }
      for (std::size_t i = bytes.below(4); i > 0; --i) {
        const Pair pair = any_pair(bytes);
        if (is_gone(pair) || pair.first >= pair.second) continue;
        if (kind == 1 && state.pairs[1].contains(pair)) continue;
        state.pairs[kind].insert(pair);
        frame.pairs[2 * kind + 1].push_back(pair);
      }
      std::ranges::sort(frame.pairs[2 * kind + 1]);
    }
    for (std::uint32_t slot = 0; slot < frame.slots; ++slot) {
      if (holds(state, BoxId(slot)) && bytes.below(4) == 0)
        frame.filters.push_back({slot, static_cast<std::uint32_t>(bytes.below(2))});
    }
  }

  static Pair any_pair(Bytes& bytes) {
    const auto first = static_cast<std::uint32_t>(bytes.below(10));
    return {BoxId(first), BoxId(static_cast<std::uint32_t>(bytes.below(11)))};
  }

  static bool holds(const State& state, BoxId slot) {
    return index(slot) < state.has_box.size() && state.has_box[index(slot)];
  }

  static void take_boxes(const ForgedFrame& frame, State& state) {
    state.has_box.resize(frame.slots);
    for (const std::uint32_t slot : frame.removed) state.has_box[slot] = false;
    for (const Set& set : frame.set) state.has_box[set.slot] = true;
  }

  void mutate_pairs(Bytes& bytes) {
    if (frames.empty()) return;
    ForgedFrame& frame = frames[bytes.below(frames.size())];
    std::vector<Pair>& pairs = frame.pairs[bytes.below(4)];
    const std::size_t what = bytes.below(8);
    if (what == 0) pairs.push_back(any_pair(bytes));
    if (what == 1 && !pairs.empty()) pairs.pop_back();
    if (what == 2) std::ranges::reverse(pairs);
    if (what == 3 && !pairs.empty()) pairs.push_back(pairs.back());
    if (what == 4 && !pairs.empty()) std::swap(pairs[0].first, pairs[0].second);
    if (what == 5) frame.filters.push_back({static_cast<std::uint32_t>(bytes.below(11)), 0});
    if (what == 6 && !frame.filters.empty()) frame.filters.back().is_static += 1;
    if (what == 7) margin = bytes.next() < 100 ? -1 : std::numeric_limits<double>::infinity();
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
    if (what == 2) frame.set.push_back({slot, lattice_box<D, Real>(bytes)});
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
    std::vector<std::byte> bytes;
    detail::OutputTo output(bytes);
    world::ByteWriter out(output);
    for (const unsigned char byte : trace::magic) out.put(byte);
    out.put(has_pairs ? trace::pairs_version : trace::version);
    out.put(dimension);
    out.put(coordinate_bytes);
    out.put(reserved);
    if (has_pairs) out.put(margin);
    out.put(std::uint32_t{0});
    for (const ForgedFrame& frame : frames) {
      out.put(trace::frame_mark);
      out.put(frame.slots);
      out.put(static_cast<std::uint32_t>(frame.removed.size()));
      out.put(static_cast<std::uint32_t>(frame.set.size()));
      if (has_pairs) {
        out.put(static_cast<std::uint32_t>(frame.filters.size()));
        for (const std::vector<Pair>& pairs : frame.pairs) out.put(static_cast<std::uint32_t>(pairs.size()));
      }
      out.put(std::uint32_t{0});
      for (const std::uint32_t removed : frame.removed) out.put(removed);
      for (const Set& set : frame.set) {
        out.put(set.slot);
        for (const Real bound : set.box.min) out.put(bound);
        for (const Real bound : set.box.max) out.put(bound);
      }
      if (has_pairs) put_pairs(frame, out);
      out.put(std::uint32_t{0});
    }
    out.seal();
    const auto* const begin = reinterpret_cast<const char*>(bytes.data());
    return lab::sealed_trace(std::string(begin, begin + bytes.size() - trace::checksum_bytes));
  }

  static void put_pairs(const ForgedFrame& frame, world::ByteWriter& out) {
    for (const SlotFilter& filter : frame.filters) {
      out.put(filter.slot);
      out.put(std::uint64_t{1});
      out.put(std::uint64_t{3});
      out.put(std::uint32_t{0});
      out.put(filter.is_static);
    }
    for (const std::vector<Pair>& pairs : frame.pairs) {
      for (const Pair pair : pairs) {
        out.put(index(pair.first));
        out.put(index(pair.second));
      }
    }
  }

  bool has_right_header() const {
    return dimension == D && coordinate_bytes == sizeof(Real) && reserved == 0 && margin == 0.5;
  }

  /// Whether a frame whose boxes keep the rules does so with its pairs, which are then those of the state.
  static bool has_right_pairs(const ForgedFrame& frame, State& state) {
    take_boxes(frame, state);
    for (std::size_t i = 0; i < frame.filters.size(); ++i) {
      const SlotFilter& filter = frame.filters[i];
      if (!holds(state, BoxId(filter.slot)) || filter.is_static > 1) return false;
      if (i > 0 && filter.slot <= frame.filters[i - 1].slot) return false;
    }
    for (std::size_t list = 0; list < 4; ++list) {
      const std::vector<Pair>& pairs = frame.pairs[list];
      std::multiset<Pair>& held = state.pairs[list / 2];
      if (!std::ranges::is_sorted(pairs)) return false;
      if (list > 1 && std::ranges::adjacent_find(pairs) != pairs.end()) return false;
      for (const Pair pair : pairs) {
        if (pair.first >= pair.second) return false;
        if (list % 2 == 1) {
          held.insert(pair);
          continue;
        }
        const auto found = held.find(pair);
        if (found == held.end()) return false;
        held.erase(found);
      }
    }
    if (std::ranges::adjacent_find(state.pairs[1]) != state.pairs[1].end()) return false;
    for (const std::multiset<Pair>& held : state.pairs) {
      for (const Pair pair : held) {
        if (!holds(state, pair.first) || !holds(state, pair.second)) return false;
      }
    }
    return true;
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
void check_followed(Tracker<D, Real>& tracker, const std::vector<Box<D, Real>>& boxes,
                    std::span<const BoxId> changed, std::set<Pair>& pairs) {
  std::vector<Pair> begun;
  std::vector<Pair> ended;
  PairCollector begun_sink(begun);
  PairCollector ended_sink(ended);
  const Frame<D, Real> frame{boxes, changed};
  tracker.update(frame, begun_sink, ended_sink);
  for (const Pair pair : ended) expect(pairs.erase(pair) == 1, "a pair ended that did not hold");
  for (const Pair pair : begun) expect(pairs.insert(pair).second, "a pair began that held");
  expect(std::ranges::equal(pairs, debug::pairs_by_definition(frame)), "the pairs are wrong");
}

template <int D, typename Real>
void check(Bytes& bytes, bool has_pairs) {
  Forgery<D, Real> forgery;
  forgery.has_pairs = has_pairs;
  const std::size_t count = 1 + bytes.below(5);
  for (std::size_t i = 0; i < count; ++i)
    forgery.frames.push_back(Forgery<D, Real>::any_frame(bytes, i == 0 ? 0 : forgery.frames.back().slots));
  if (has_pairs) {
    typename Forgery<D, Real>::State drawn;
    for (auto& frame : forgery.frames) Forgery<D, Real>::draw_pairs(bytes, frame, drawn);
    for (std::size_t i = bytes.below(3); i > 0; --i) forgery.mutate_pairs(bytes);
  }
  for (std::size_t i = bytes.below(4); i > 0; --i) forgery.mutate(bytes);

  constexpr std::array<const char*, 4> specs = {"auto", "quadtree", "grid", "brute_force"};
  Tracker<D, Real> tracker(specs[bytes.below(specs.size())]);
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
  typename Forgery<D, Real>::State state;
  lab::RecordedFrame recorded;
  for (const auto& frame : forgery.frames) {
    const bool is_right = Forgery<D, Real>::is_right(frame, static_cast<std::uint32_t>(expected.size())) &&
                          (!has_pairs || Forgery<D, Real>::has_right_pairs(frame, state));
    bool is_read = false;
    try {
      is_read = reader->next_frame();
    } catch (const lab::FileError&) {
      expect(!is_right, "a right frame was refused");
      expect(!reader->next_frame(), "the reader goes on behind a frame that it refused");
      return;
    }
    expect(is_read && is_right, "a wrong frame was read, or a right one left out");
    apply<D, Real>(frame, expected);
    boxes.resize(reader->slots(), absent_box<D, Real>());
    for (std::size_t i = 0; i < reader->changed().size(); ++i)
      boxes.at(index(reader->changed()[i])) = reader->template box<D, Real>(i);
    expect(boxes == expected, "the boxes read are wrong");
    expect((reader->recorded() != nullptr) == has_pairs, "pairs were read where there are none");
    if (has_pairs) {
      recorded.apply(*reader->recorded(), reader->slots(), {});
      expect(std::ranges::equal(recorded.reported(), state.pairs[0]), "the reported pairs read are wrong");
      expect(std::ranges::equal(recorded.ignored(), state.pairs[1]), "the ignored pairs read are wrong");
    }
    check_followed(tracker, boxes, reader->changed(), pairs);
  }
  expect(!reader->next_frame() && reader->warning().empty(), "a whole trace was read as another one");
}

}  // namespace
}  // namespace broadside::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::fuzz::Bytes bytes({data, size});
  const std::uint8_t what = bytes.next();
  const bool has_pairs = what / 2 % 2 == 1;
  if (what % 2 == 0)
    broadside::fuzz::check<2, float>(bytes, has_pairs);
  else
    broadside::fuzz::check<3, double>(bytes, has_pairs);
  return 0;
}
