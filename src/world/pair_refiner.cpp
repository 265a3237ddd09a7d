// PairRefiner: makes the pairs of a world out of its tracker's, by the boxes themselves and a predicate.
#include "world/pair_refiner.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/float_environment.hpp"
#include "core/grow.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside::world {
namespace {

/// If more than one slot in this number changed, it pays to look at every edge in a row, which takes a
/// fraction of the time an edge.
constexpr std::size_t slots_per_change = 4;

std::vector<Pair> sorted_edges(const PairGraph& graph, bool (*is_wanted)(const PairGraph::Mark&)) {
  std::vector<Pair> edges;
  edges.reserve(graph.size());
  graph.for_each([&](PairGraph::EdgeId edge) {
    if (is_wanted(graph.mark(edge))) edges.push_back(graph.pair(edge));
  });
  std::ranges::sort(edges);
  return edges;
}

}  // namespace

template <int D, typename Real>
void PairRefiner<D, Real>::adopt(std::span<const HandlePair> pairs, std::size_t slots) {
  PairGraph graph;
  graph.reserve(pairs.size(), slots);
  for (const HandlePair& pair : pairs)
    graph.mark(graph.insert({BoxId{pair.first.slot}, BoxId{pair.second.slot}})) = {true, true, 0};
  state_.graph = std::move(graph);
  // Events that a failed update has left are not among the pairs yet. The next update refines them.
}

template <int D, typename Real>
void PairRefiner<D, Real>::swap_predicate(PairPredicate& predicate) noexcept {
  state_.is_refining = true;
  state_.asks_about_all = true;
  predicate_.swap(predicate);
}

template <int D, typename Real>
void PairRefiner<D, Real>::ask_again(std::uint32_t slot, std::size_t slots) {
  if (!has_predicate()) return;
  if (asked_marks_.size() < slots) asked_marks_.resize(slots);
  if (asked_marks_[slot] != 0) return;
  state_.asked_slots.push_back(slot);
  asked_marks_[slot] = 1;
}

template <int D, typename Real>
PairEvents& PairRefiner<D, Real>::refine(const SlotTable<D, Real>& slots, const BoxTable<D, Real>& boxes) {
  if (!state_.is_refining) return state_.candidates;
  const bool is_retry = !state_.refined.empty();
  take_candidates(slots.size());
  const core::DefaultEnvironment environment;
  ++stamp_;
  reviewed_.clear();
  questions_.clear();
  if (state_.asks_about_all || (by_boxes_ && boxes.changed().size() > slots.size() / slots_per_change))
    review_all(boxes.boxes());
  else
    review_changes(boxes);
  if (has_predicate()) answer(slots);
  tell();
  if (is_retry) state_.refined.cancel();
  return state_.refined;
}

/// Brings the graph up to date.
template <int D, typename Real>
void PairRefiner<D, Real>::take_candidates(std::size_t slots) {
  auto& [is_refining, asks_about_all, asked_slots, graph, candidates, refined, fresh] = state_;
  graph.reserve(graph.size() + candidates.begun.size(), slots);
  core::make_room(fresh, candidates.begun.size());
  core::make_room(refined.ended, candidates.ended.size());
  const bool is_retry = !refined.ended.empty() || !fresh.empty();
  for (const Pair pair : candidates.ended) {
    const PairGraph::EdgeId edge = graph.find(pair);
    if (edge == PairGraph::none) continue;  // ended and never began: an algorithm of the caller's is wrong
    if (graph.mark(edge).overlaps && graph.mark(edge).accepted) refined.ended.push_back(pair);
    graph.erase(edge);
  }
  for (const Pair pair : candidates.begun) {
    graph.insert(pair);
    fresh.push_back(pair);
  }
  // Events left by a failed update go before newer ones; a snapshot lists both by id.
  if (is_retry) {
    std::ranges::sort(refined.ended);
    std::ranges::sort(fresh);
  }
  candidates.clear();
}

/// Reviews the new edges and the edges of the boxes that changed.
template <int D, typename Real>
void PairRefiner<D, Real>::review_changes(const BoxTable<D, Real>& boxes) {
  const PairGraph& graph = state_.graph;
  const auto review_edge = [&, all = boxes.boxes()](PairGraph::EdgeId edge) { review_once(edge, all); };
  for (const Pair pair : state_.fresh) {
    const PairGraph::EdgeId edge = graph.find(pair);
    if (edge != PairGraph::none) review_edge(edge);
  }
  if (by_boxes_) {
    for (const BoxId id : boxes.changed()) graph.for_each_of(id, review_edge);
  }
  for (const std::uint32_t slot : state_.asked_slots) graph.for_each_of(BoxId{slot}, review_edge);
}

/// Reviews an edge, unless this update has done so already.
template <int D, typename Real>
void PairRefiner<D, Real>::review_once(PairGraph::EdgeId edge, std::span<const Box<D, Real>> boxes) {
  PairGraph::Mark& mark = state_.graph.mark(edge);
  if (mark.stamp == stamp_) return;
  mark.stamp = stamp_;
  const auto [a, b] = state_.graph.pair(edge);
  review(edge, !by_boxes_ || overlap(boxes[index(a)], boxes[index(b)]));
}

template <int D, typename Real>
void PairRefiner<D, Real>::review_all(std::span<const Box<D, Real>> boxes) {
  constexpr std::size_t at_once = 256;
  const PairGraph& graph = state_.graph;
  std::array<PairGraph::EdgeId, at_once> edges;
  std::array<Pair, at_once> pairs;
  std::array<std::uint8_t, at_once> flags;
  flags.fill(1);
  std::size_t count = 0;
  const auto review_these = [&] {
    if (by_boxes_) kernels::set_overlap_flags(boxes, std::span<const Pair>(pairs).first(count), flags.data());
    for (std::size_t i = 0; i < count; ++i) {
      const PairGraph::Mark& mark = graph.mark(edges[i]);
      const bool overlaps = flags[i] != 0;
      if (has_predicate() || mark.overlaps != overlaps || mark.accepted != overlaps)
        review(edges[i], overlaps);
    }
    count = 0;
  };
  graph.for_each([&](PairGraph::EdgeId edge) {
    edges[count] = edge;
    pairs[count++] = graph.pair(edge);
    if (count == at_once) review_these();
  });
  review_these();
}

/// Notes an edge if it may change.
template <int D, typename Real>
void PairRefiner<D, Real>::review(PairGraph::EdgeId edge, bool overlaps) {
  const PairGraph::Mark& mark = state_.graph.mark(edge);
  const Pair pair = state_.graph.pair(edge);
  const bool is_asked = overlaps && has_predicate() &&
                        (!mark.overlaps || asks_about(index(pair.first)) || asks_about(index(pair.second)));
  if (is_asked)
    questions_.push_back({pair, reviewed_.size()});
  else if (overlaps == mark.overlaps && (has_predicate() || mark.accepted == overlaps))
    return;
  reviewed_.push_back({edge, overlaps, overlaps});
}

/// Asks the predicate, in the order of the slots.
template <int D, typename Real>
void PairRefiner<D, Real>::answer(const SlotTable<D, Real>& slots) {
  std::ranges::sort(questions_, {}, &Question::pair);
  const core::CallersEnvironment callers;
  for (const Question& question : questions_) {
    const auto [first, second] = slots.handles(question.pair);
    reviewed_[question.place].accepted = predicate_(first, second);
  }
}

/// Makes events of what the edges have become.
template <int D, typename Real>
void PairRefiner<D, Real>::tell() {
  auto& [begun, ended] = state_.refined;
  core::make_room(begun, reviewed_.size());
  core::make_room(ended, reviewed_.size());
  for (const ReviewedEdge& now : reviewed_) {
    PairGraph::Mark& mark = state_.graph.mark(now.edge);
    const bool held = mark.overlaps && mark.accepted;
    const bool holds = now.overlaps && now.accepted;
    mark.overlaps = now.overlaps;
    mark.accepted = now.accepted;
    if (held != holds) (holds ? begun : ended).push_back(state_.graph.pair(now.edge));
  }
  state_.fresh.clear();
  sort_pairs(begun, sorting_);
  sort_pairs(ended, sorting_);
}

template <int D, typename Real>
void PairRefiner<D, Real>::settle() noexcept {
  for (const std::uint32_t slot : state_.asked_slots) asked_marks_[slot] = 0;
  state_.asked_slots.clear();
  state_.asks_about_all = false;
  if (state_.is_refining && !has_predicate() && !by_boxes_) {
    state_.graph = {};
    state_.is_refining = false;
  }
}

template <int D, typename Real>
void PairRefiner<D, Real>::shrink_to_fit() {
  state_.graph.shrink_to_fit();
  state_.candidates.shrink_to_fit();
  state_.refined.shrink_to_fit();
  if (state_.asked_slots.empty()) asked_marks_.clear();
  core::shrink(state_.asked_slots, state_.fresh, asked_marks_, reviewed_, questions_, sorting_);
}

template <int D, typename Real>
std::size_t PairRefiner<D, Real>::bytes() const noexcept {
  return state_.graph.bytes() + state_.candidates.bytes() + state_.refined.bytes() +
         core::bytes_of(state_.asked_slots, state_.fresh, asked_marks_, reviewed_, questions_, sorting_);
}

template <int D, typename Real>
std::vector<Pair> PairRefiner<D, Real>::tracked(std::vector<Pair> current) const {
  const PairEvents waiting = state_.candidates.netted();
  if (state_.is_refining) current = edges();
  return symmetric_difference(symmetric_difference(current, waiting.begun), waiting.ended);
}

template <int D, typename Real>
std::vector<Pair> PairRefiner<D, Real>::edges() const {
  return sorted_edges(state_.graph, [](const PairGraph::Mark&) { return true; });
}

template <int D, typename Real>
std::vector<Pair> PairRefiner<D, Real>::held_edges() const {
  return sorted_edges(state_.graph,
                      [](const PairGraph::Mark& mark) { return mark.overlaps && mark.accepted; });
}

template <int D, typename Real>
void PairRefiner<D, Real>::restore(RefinerState state, std::size_t slots) {
  state_ = std::move(state);
  asked_marks_.assign(state_.asked_slots.empty() ? 0 : slots, 0);
  for (const std::uint32_t slot : state_.asked_slots) asked_marks_[slot] = 1;
}

template class PairRefiner<2, float>;
template class PairRefiner<2, double>;
template class PairRefiner<3, float>;
template class PairRefiner<3, double>;

}  // namespace broadside::world
