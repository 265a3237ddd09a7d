// A snapshot's fields, read and written one by one, so that a test can change one and seal the rest again:
// see docs/snapshot-format.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

#include "world/byte_stream.hpp"
#include "world/snapshot_format.hpp"

namespace broadside::fuzz {

using SnapshotBytes = std::vector<std::byte>;

/// The fields of a World<D, Real>'s snapshot in their order. Lengths of lists are those of the vectors.
template <int D, typename Real>
struct SnapshotFields {
  struct Removed {
    std::uint32_t slot = 0;
    Box<D, Real> box = absent_box<D, Real>();
  };

  std::uint32_t flags = 0;
  double margin = 0;
  double relative_margin = 0;
  double predicted_frames = 0;
  std::vector<std::uint8_t> algorithm{};
  std::uint32_t first_generation = 0;
  std::uint64_t pair_count = 0;
  std::vector<Box<D, Real>> boxes{};
  std::vector<std::uint32_t> generations{};
  std::vector<std::uint8_t> states{};
  std::vector<Box<D, Real>> enlarged{};    // with a margin
  std::vector<Filter> filters{};           // with filters
  std::vector<std::uint64_t> user_data{};  // with user data
  std::vector<Removed> removed{};
  std::vector<Removed> reported{};
  std::vector<BoxId> changed{};
  std::vector<BoxId> moved{};
  std::vector<BoxId> refiltered{};
  std::vector<Pair> ignored{};
  std::vector<Pair> ignored_changed{};
  std::uint8_t last_flags = 0;
  std::uint64_t last_count = 0;
  std::vector<BoxId> last_places{};
  std::vector<Box<D, Real>> last_boxes{};
  std::vector<BoxId> last_filtered{};
  std::vector<Filter> last_filters{};
  std::vector<Pair> last_ignored{};
  std::vector<Pair> pairs{};
  std::vector<Pair> begun{};
  std::vector<Pair> ended{};
  std::vector<Pair> edges{};
  std::vector<std::uint8_t> marks{};
  std::vector<Pair> candidates_begun{};
  std::vector<Pair> candidates_ended{};
  std::vector<Pair> refined_begun{};
  std::vector<Pair> refined_ended{};
  std::vector<Pair> fresh{};

  bool is_set(std::uint32_t flag) const { return (flags & flag) != 0; }
  bool has_margin() const {
    return static_cast<Real>(margin) > 0 || static_cast<Real>(relative_margin) > 0 ||
           static_cast<Real>(predicted_frames) > 0;
  }

  /// Passes each field to `codec`, which reads or writes it.
  template <typename Codec>
  void pass(Codec& codec) {
    codec.number(flags);
    codec.number(margin);
    codec.number(relative_margin);
    codec.number(predicted_frames);
    codec.list(algorithm);
    codec.number(first_generation);
    codec.number(pair_count);
    const std::size_t slots = codec.list(boxes);
    codec.all(generations, slots);
    codec.all(states, slots);
    codec.all(enlarged, has_margin() ? slots : 0);
    codec.all(filters, is_set(world::snapshot::has_filters) ? slots : 0);
    codec.all(user_data, is_set(world::snapshot::has_user_data) ? slots : 0);
    codec.removals(removed);
    codec.removals(reported);
    for (auto* const list : {&changed, &moved, &refiltered}) codec.list(*list);
    codec.list(ignored);
    codec.list(ignored_changed);
    codec.number(last_flags);
    codec.number(last_count);
    codec.all(last_boxes, codec.list(last_places));
    codec.all(last_filters, codec.list(last_filtered));
    for (auto* const list : {&last_ignored, &pairs, &begun, &ended}) codec.list(*list);
    codec.all(marks, codec.list(edges));
    for (auto* const list : {&candidates_begun, &candidates_ended, &refined_begun, &refined_ended, &fresh})
      codec.list(*list);
  }
};

/// Takes fields from the bytes of a snapshot.
class FieldReader {
 public:
  explicit FieldReader(std::span<const std::byte> bytes) : in_(bytes, world::snapshot::version) {}

  template <typename T>
  void number(T& value) {
    value = in_.get<T>();
  }
  template <typename T>
  std::size_t list(std::vector<T>& parts) {
    parts = world::get_list<T>(in_, "parts");
    return parts.size();
  }
  template <typename T>
  void all(std::vector<T>& parts, std::size_t count) {
    parts = world::get_all<T>(in_, count, "parts");
  }
  template <typename Removed>
  void removals(std::vector<Removed>& list) {
    list.resize(in_.count(4, "removed boxes"));
    for (Removed& one : list) {
      one.slot = in_.get<std::uint32_t>();
      one.box = world::Serializer<decltype(one.box)>::get(in_);
    }
  }

 private:
  world::ByteReader in_;
};

/// Writes fields.
class FieldWriter {
 public:
  explicit FieldWriter(world::ByteWriter& out) : out_(&out) {}

  template <typename T>
  void number(T& value) {
    out_->put(value);
  }
  template <typename T>
  std::size_t list(std::vector<T>& parts) {
    world::put_list<T>(*out_, parts);
    return parts.size();
  }
  template <typename T>
  void all(std::vector<T>& parts, std::size_t count) {
    parts.resize(count);
    world::put_all<T>(*out_, parts);
  }
  template <typename Removed>
  void removals(std::vector<Removed>& list) {
    out_->put(std::uint64_t{list.size()});
    for (Removed& one : list) {
      out_->put(one.slot);
      world::Serializer<decltype(one.box)>::put(*out_, one.box);
    }
  }

 private:
  world::ByteWriter* out_;
};

/// Where the fields begin: behind magic number, version, dimension, coordinate's bytes, byte order and
/// length.
inline constexpr std::size_t snapshot_header_bytes = 24;
inline constexpr std::size_t snapshot_length_at = 16;

/// The fields of a snapshot that World::snapshot() gave.
template <int D, typename Real>
SnapshotFields<D, Real> fields_of(const SnapshotBytes& bytes) {
  SnapshotFields<D, Real> fields;
  FieldReader reader(std::span<const std::byte>(bytes).subspan(snapshot_header_bytes));
  fields.pass(reader);
  return fields;
}

/// A snapshot with these fields and the right length and checksum.
template <int D, typename Real>
SnapshotBytes sealed(SnapshotFields<D, Real> fields) {
  SnapshotBytes bytes;
  detail::OutputTo output(bytes);
  world::ByteWriter out(output);
  for (const unsigned char byte : world::snapshot::magic) out.put(byte);
  out.put(world::snapshot::version);
  out.put(static_cast<std::uint8_t>(D));
  out.put(static_cast<std::uint8_t>(sizeof(Real)));
  out.put(world::snapshot::byte_order);
  out.put(std::uint64_t{0});
  FieldWriter writer(out);
  fields.pass(writer);
  out.put_at(snapshot_length_at, out.size() + world::snapshot::checksum_bytes);
  out.seal();
  return bytes;
}

}  // namespace broadside::fuzz
