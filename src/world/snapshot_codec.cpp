// SnapshotCodec: writes a world as bytes, and reads the header and the checksum. SnapshotReader reads what is
// between them.
#include "world/snapshot_codec.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <tuple>

#include "broadside/error.hpp"

#include "world/byte_stream.hpp"
#include "world/snapshot_format.hpp"
#include "world/snapshot_reader.hpp"

namespace broadside::world {
namespace {

template <typename Found, typename Expected>
void expect_equal(const char* what, Found found, Expected expected) {
  if (found == expected) return;
  throw InvalidSnapshot(std::string(what) + " of a snapshot is " + std::to_string(found) + "; expected " +
                        std::to_string(expected));
}

std::vector<Pair> sorted(const IgnoredPairs& ignored) {
  std::vector<Pair> pairs;
  pairs.reserve(ignored.size());
  ignored.for_each([&pairs](Pair pair) { pairs.push_back(pair); });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void put_pairs(ByteWriter& out, std::span<const HandlePair> handles) {
  out.put(std::uint64_t{handles.size()});
  for (const HandlePair& pair : handles) {
    out.put(pair.first.slot);
    out.put(pair.second.slot);
  }
}

template <int D, typename Real>
void put_slots(ByteWriter& out, const WorldParts<D, Real>& parts) {
  const auto& [slots, boxes] = std::tie(parts.slots, parts.boxes);
  out.put(std::uint64_t{slots.size()});
  put_all(out, boxes.boxes());
  put_all(out, slots.generations());
  put_all(out, slots.states());
  put_all(out, boxes.enlarged());
  put_all(out, boxes.filters().values());
  put_all(out, parts.user_data.values());
  for (const auto& list : {slots.removed(), slots.reported()}) {
    out.put(std::uint64_t{list.size()});
    for (const RemovedBox<D, Real>& old : list) {
      out.put(old.slot);
      Serializer<Box<D, Real>>::put(out, old.box);
    }
  }
  put_list(out, boxes.changed());
  put_list(out, boxes.moved());
}

/// Writes the last frame that the tracker has taken, as its differences from the current one.
template <int D, typename Real>
void put_last_frame(ByteWriter& out, const Frame<D, Real>& last, const Frame<D, Real>& now) {
  out.put(static_cast<std::uint8_t>((last.filters.empty() ? 0 : snapshot::last_has_filters) |
                                    (last.ignored == nullptr ? 0 : snapshot::last_has_ignored)));
  out.put(std::uint64_t{last.boxes.size()});
  std::vector<BoxId> places;
  for (std::uint32_t i = 0; i < last.boxes.size(); ++i) {
    if (i >= now.boxes.size() || last.boxes[i] != now.boxes[i]) places.push_back(BoxId{i});
  }
  put_list<BoxId>(out, places);
  for (const BoxId id : places) Serializer<Box<D, Real>>::put(out, last.boxes[index(id)]);
  places.clear();
  for (std::uint32_t i = 0; i < last.filters.size(); ++i) {
    if (last.filters[i] != (i < now.filters.size() ? now.filters[i] : Filter{})) places.push_back(BoxId{i});
  }
  put_list<BoxId>(out, places);
  for (const BoxId id : places) Serializer<Filter>::put(out, last.filters[index(id)]);
  put_list<Pair>(out, last.ignored == nullptr ? std::vector<Pair>{} : sorted(*last.ignored));
}

void put_refiner(ByteWriter& out, const RefinerState& state, const std::vector<Pair>& edges) {
  put_list<Pair>(out, edges);
  for (const Pair pair : edges) out.put(state.graph.marks()[state.graph.find(pair)]);
  for (const PairEvents* const events : {&state.candidates, &state.refined}) {
    const PairEvents net = events->netted();
    put_list<Pair>(out, net.begun);
    put_list<Pair>(out, net.ended);
  }
  put_list<Pair>(out, state.fresh);
}

}  // namespace

template <int D, typename Real>
void SnapshotCodec<D, Real>::encode(const Parts& parts, const Tracker& tracker,
                                    detail::Output<std::byte>& bytes) {
  using namespace snapshot;
  const std::vector<Pair> current = parts.current.slot_pairs();
  const RefinerState& refiner = parts.refiner.state();
  ByteWriter out(bytes);
  out.reserve(parts.slots.size() * (Serializer<Box<D, Real>>::bytes + 32) + current.size() * 8 + 1024);
  put_all<unsigned char>(out, magic);
  out.put(version);
  out.put(static_cast<std::uint8_t>(D));
  out.put(static_cast<std::uint8_t>(sizeof(Real)));
  out.put(byte_order);
  const std::size_t length_at = out.size();
  out.put(std::uint64_t{0});

  const auto flag = [](bool is_set, std::uint32_t bit) { return is_set ? bit : 0; };
  out.put(flag(parts.options.keep_pairs, keeps_pairs) | flag(tracker.is_own(), has_own_tracker) |
          flag(parts.refiner.has_predicate(), has_predicate) | flag(refiner.is_refining, refines) |
          flag(parts.boxes.filters().is_used(), has_filters) |
          flag(parts.user_data.is_used(), has_user_data) | flag(parts.has_updated, was_updated) |
          flag(parts.is_settled(), was_settled) | flag(refiner.asks_about_all, refilters) |
          flag(parts.options.events == WorldEvents::enlarged, tells_enlarged) |
          flag(!parts.options.touching, leaves_out_touching));
  out.put(parts.options.margin);
  out.put(parts.options.relative_margin);
  out.put(parts.options.predicted_frames);
  put_list<char>(out, tracker.spec().text());
  out.put(parts.slots.first_generation());
  out.put(std::uint64_t{parts.current.size()});
  put_slots(out, parts);
  put_list<BoxId>(out, refiner.asked_slots);
  put_list<Pair>(out, sorted(parts.ignored.pairs()));
  put_list(out, parts.ignored.changed());
  put_last_frame(out, tracker.last_frame(), parts.frame());
  put_list<Pair>(out, current);
  put_pairs(out, parts.current.events().begun);
  put_pairs(out, parts.current.events().ended);
  put_refiner(out, refiner, parts.refiner.edges());

  out.put_at(length_at, std::uint64_t{out.size() + checksum_bytes});
  out.seal();
}

template <int D, typename Real>
DecodedSnapshot<D, Real> SnapshotCodec<D, Real>::decode(std::span<const std::byte> bytes, const Parts& parts,
                                                        const Tracker& tracker) {
  ByteReader in(bytes, snapshot::version);
  for (const unsigned char byte : snapshot::magic)
    expect_equal("a byte of the magic number", in.get<unsigned char>(), byte);
  const auto version = in.get<std::uint32_t>();
  if (version < snapshot::first_version || version > snapshot::version)
    expect_equal("the version", version, snapshot::version);
  expect_equal("the dimension", int{in.get<std::uint8_t>()}, D);
  expect_equal("the size of a coordinate", std::size_t{in.get<std::uint8_t>()}, sizeof(Real));
  expect_equal("the byte order", in.get<std::uint16_t>(), snapshot::byte_order);
  const std::uint64_t length = in.get<std::uint64_t>();
  expect_equal("the length", std::uint64_t{bytes.size()}, length);
  in.need(1, snapshot::checksum_bytes, "bytes of a checksum");
  const auto body = bytes.first(bytes.size() - snapshot::checksum_bytes);
  ByteReader end(bytes.last(snapshot::checksum_bytes), version);
  expect_equal("the checksum", end.get<std::uint32_t>(), ByteWriter::checksum_of(body));

  ByteReader rest(body.subspan(bytes.size() - in.left()), version);
  DecodedSnapshot<D, Real> decoded;
  SnapshotReader<D, Real>(rest, decoded).read(parts, tracker);
  expect_equal("the number of bytes after the end", rest.left(), std::size_t{0});
  return decoded;
}

template class SnapshotCodec<2, float>;
template class SnapshotCodec<2, double>;
template class SnapshotCodec<3, float>;
template class SnapshotCodec<3, double>;

}  // namespace broadside::world
