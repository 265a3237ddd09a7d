// World: snapshots. What stands in their bytes is described in docs/snapshot-format.md.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "core/float_environment.hpp"
#include "world/snapshot_format.hpp"
#include "world/snapshot_parts.hpp"
#include "world/state.hpp"

namespace broadside {
namespace {

using core::ByteReader;
using core::ByteWriter;
using core::put_all;
using core::put_list;

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
  std::ranges::sort(pairs);
  return pairs;
}

/// The frame that the tracker has taken last, as what differs from the one that it is shown now.
template <int D, typename Real>
void put_last_frame(ByteWriter& out, const Frame<D, Real>& last, const Frame<D, Real>& now) {
  out.put(static_cast<std::uint8_t>((last.filters.empty() ? 0 : snapshot::last_has_filters) |
                                    (last.ignored == nullptr ? 0 : snapshot::last_has_ignored)));
  out.put(std::uint64_t{last.boxes.size()});
  std::vector<BoxId> places;
  for (std::uint32_t i = 0; i < last.boxes.size(); ++i) {
    if (i >= now.boxes.size() || last.boxes[i] != now.boxes[i]) places.push_back(BoxId{i});
  }
  put_list(out, places);
  for (const BoxId id : places) core::Part<Box<D, Real>>::put(out, last.boxes[index(id)]);
  places.clear();
  for (std::uint32_t i = 0; i < last.filters.size(); ++i) {
    if (last.filters[i] != (i < now.filters.size() ? now.filters[i] : Filter{})) places.push_back(BoxId{i});
  }
  put_list(out, places);
  for (const BoxId id : places) core::Part<Filter>::put(out, last.filters[index(id)]);
  put_list(out, last.ignored == nullptr ? std::vector<Pair>{} : sorted(*last.ignored));
}

}  // namespace

template <int D, typename Real>
void World<D, Real>::write_snapshot(detail::Output<std::byte>& bytes) const {
  const core::DefaultEnvironment environment;
  const State& state = *state_;
  const std::span<const HandlePair> current =
      state.options.keep_pairs ? pairs() : std::span<const HandlePair>{};
  ByteWriter out(bytes);
  out.reserve(state.slots.size() * (core::Part<Box<D, Real>>::bytes + 32) + current.size() * 8 + 1024);
  for (const unsigned char byte : snapshot::magic) out.put(byte);
  out.put(snapshot::version);
  out.put(static_cast<std::uint8_t>(D));
  out.put(static_cast<std::uint8_t>(sizeof(Real)));
  out.put(snapshot::byte_order);
  const std::size_t length_at = out.size();
  out.put(std::uint64_t{0});
  state.put(out, current);
  out.put_at(length_at, out.size() + snapshot::checksum_bytes);
  out.seal();
}

template <int D, typename Real>
void World<D, Real>::State::put(ByteWriter& out, std::span<const HandlePair> pairs_now) const {
  using namespace snapshot;
  const auto flag = [](bool is_set, std::uint32_t bit) { return is_set ? bit : 0; };
  out.put(flag(options.keep_pairs, keeps_pairs) | flag(is_own_tracker, has_own_tracker) |
          flag(static_cast<bool>(predicate), has_predicate) | flag(is_refining, refines) |
          flag(uses_filters, has_filters) | flag(uses_user_data, has_user_data) |
          flag(has_updated, was_updated) | flag(is_settled, was_settled) | flag(refilters_all, refilters) |
          flag(options.events == WorldEvents::enlarged, tells_enlarged));
  out.put(options.margin);
  out.put(options.relative_margin);
  out.put(options.predicted_frames);
  out.put(std::uint64_t{options.algorithm.size()});
  for (const char letter : options.algorithm) out.put(static_cast<std::uint8_t>(letter));
  out.put(first_generation);
  out.put(std::uint64_t{pair_count});

  out.put(std::uint64_t{slots.size()});
  put_all<Box<D, Real>>(out, boxes);
  put_all<std::uint32_t>(out, generations);
  for (const Slot& slot : slots) out.put(static_cast<std::uint8_t>(slot.state));
  if (has_margin()) put_all<Box<D, Real>>(out, enlarged);
  if (uses_filters) put_all<Filter>(out, filters);
  if (uses_user_data) put_all<std::uint64_t>(out, user_data);

  for (const std::vector<Removed>* const list : {&removed, &reported}) {
    out.put(std::uint64_t{list->size()});
    for (const Removed& old : *list) {
      out.put(old.slot);
      core::Part<Box<D, Real>>::put(out, old.box);
    }
  }
  put_list(out, changed);
  put_list(out, moved);
  put_list(out, refiltered);
  put_list(out, sorted(ignored));
  put_list(out, ignored_changed);
  put_last_frame(out, last_frame(), frame());

  const auto put_pairs = [&out](std::span<const HandlePair> handles) {
    out.put(std::uint64_t{handles.size()});
    for (const HandlePair& pair : handles) {
      out.put(pair.first.slot);
      out.put(pair.second.slot);
    }
  };
  put_pairs(pairs_now);
  put_pairs(begun);
  put_pairs(ended);
  const std::vector<Pair> edges = graph_pairs([](const core::PairGraph::Mark&) { return true; });
  put_list(out, edges);
  for (const Pair pair : edges) {
    const core::PairGraph::Mark& mark = graph.mark(graph.find(pair));
    out.put(
        static_cast<std::uint8_t>((mark.overlaps ? edge_overlaps : 0) | (mark.accepted ? edge_accepted : 0)));
  }
  for (const PairEvents* const events : {&candidates, &refined}) {
    const PairEvents net = events->netted();
    put_list(out, net.begun);
    put_list(out, net.ended);
  }
  put_list(out, fresh);
}

template <int D, typename Real>
void World<D, Real>::restore(std::span<const std::byte> bytes) {
  const core::DefaultEnvironment environment;
  ByteReader in(bytes, snapshot::version);
  for (const unsigned char byte : snapshot::magic)
    expect_equal("a byte of the magic number", in.get<unsigned char>(), byte);
  const auto version = in.get<std::uint32_t>();
  if (version < snapshot::first_version || version > snapshot::version)
    expect_equal("the version", version, snapshot::version);
  expect_equal("the dimension", int{in.get<std::uint8_t>()}, D);
  expect_equal("the size of a coordinate", std::size_t{in.get<std::uint8_t>()}, sizeof(Real));
  expect_equal("the byte order", in.get<std::uint16_t>(), snapshot::byte_order);
  expect_equal("the length", in.get<std::uint64_t>(), std::uint64_t{bytes.size()});
  in.need(1, snapshot::checksum_bytes, "bytes of a checksum");
  const auto body = bytes.first(bytes.size() - snapshot::checksum_bytes);
  ByteReader end(bytes.last(snapshot::checksum_bytes), version);
  expect_equal("the checksum", end.get<std::uint32_t>(), ByteWriter::checksum_of(body));

  ByteReader rest(body.subspan(bytes.size() - in.left()), version);
  typename State::LastFrame last;
  std::unique_ptr<State> restored = State::get(rest, *state_, last);
  expect_equal("the number of bytes behind the end", rest.left(), std::size_t{0});
  state_->mark_differences(*restored);
  restored->take_tracker(*state_, last);
  restored->query_index.take(state_->query_index);
  restored->predicate = std::move(state_->predicate);
  state_ = std::move(restored);
}

/// The pairs of the graph whose marks are so; sorted.
template <int D, typename Real>
std::vector<Pair> World<D, Real>::State::graph_pairs(bool (*is_wanted)(const core::PairGraph::Mark&)) const {
  std::vector<Pair> edges;
  edges.reserve(graph.size());
  graph.for_each([&](core::PairGraph::EdgeId edge) {
    if (is_wanted(graph.mark(edge))) edges.push_back(graph.pair(edge));
  });
  std::ranges::sort(edges);
  return edges;
}

}  // namespace broadside
