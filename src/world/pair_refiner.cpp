// PairRefiner: derives a world's pairs from its tracker's pairs, by the boxes themselves and a predicate.
#include "world/pair_refiner.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/float_environment.hpp"
#include "core/grow.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside::world {
namespace {

/// If more than one slot in this many changed, it pays to review all edges in sequence, which takes a
/// fraction of the time per edge.
constexpr std::size_t slots_per_change = 4;

/// Whether eight overlap flags agree with eight marks, if there is no predicate.
bool say_the_same(const std::uint8_t* flags, const std::uint8_t* marks) noexcept {
  std::uint64_t eight_flags;
  std::uint64_t eight_marks;
  std::memcpy(&eight_flags, flags, sizeof(eight_flags));
  std::memcpy(&eight_marks, marks, sizeof(eight_marks));
  return eight_flags * edge_holds == eight_marks;
}

}  // namespace

void PairRefiner::adopt(std::span<const Pair> pairs, std::size_t slots) {
  PairGraph graph;
  graph.reserve(pairs.size(), slots);
  for (const Pair pair : pairs) graph.insert(pair, edge_holds);
  state_.graph = std::move(graph);
  // Events that a failed update has left are not among the pairs yet. The next update refines them.
}

void PairRefiner::swap_predicate(PairPredicate& predicate) noexcept {
  state_.is_refining = true;
  state_.asks_about_all = true;
  predicate_.swap(predicate);
}

void PairRefiner::ask_again(std::uint32_t slot, std::size_t slots) {
  if (!has_predicate()) return;
  if (asked_marks_.size() < slots) asked_marks_.resize(slots);
  if (asked_marks_[slot] != 0) return;
  state_.asked_slots.push_back(BoxId{slot});
  asked_marks_[slot] = 1;
}

template <int D, typename Real>
PairEvents& PairRefiner::refine(const BoxTable<D, Real>& boxes, Generations generations) {
  taken_ = state_.candidates.begun.size() + state_.candidates.ended.size();
  if (!state_.is_refining) return state_.candidates;
  const bool is_retry = !state_.refined.empty();
  take_candidates(generations.size());
  const core::DefaultEnvironment environment;
  ++stamp_;
  reviewed_.clear();
  questions_.clear();
  if (state_.asks_about_all || (by_boxes_ && boxes.changed().size() > generations.size() / slots_per_change))
    review_all(boxes.boxes());
  else
    review_changes(boxes);
  if (has_predicate()) answer(generations);
  tell();
  if (is_retry) state_.refined = state_.refined.netted();
  return state_.refined;
}

/// Brings the graph up to date.
void PairRefiner::take_candidates(std::size_t slots) {
  auto& [is_refining, asks_about_all, asked_slots, graph, candidates, refined, fresh] = state_;
  graph.reserve(graph.size() + candidates.begun.size(), slots);
  core::make_room(fresh, candidates.begun.size());
  core::make_room(refined.ended, candidates.ended.size());
  const bool is_retry = !refined.ended.empty() || !fresh.empty();
  for (const Pair pair : candidates.ended) {
    const PairGraph::EdgeId edge = graph.find(pair);
    if (edge == PairGraph::none) continue;  // ended and never began: an algorithm of the caller's is wrong
    if (graph.marks()[edge] == edge_holds) refined.ended.push_back(pair);
    graph.erase(edge);
  }
  for (const Pair pair : candidates.begun) {
    graph.insert(pair);
    fresh.push_back(pair);
  }
  // Events left by a failed update precede newer ones, but a snapshot lists both by id.
  if (is_retry) {
    std::sort(refined.ended.begin(), refined.ended.end());
    std::sort(fresh.begin(), fresh.end());
  }
  candidates.clear();
}

/// Reviews the new edges and the edges of the boxes that changed, each once.
template <int D, typename Real>
void PairRefiner::review_changes(const BoxTable<D, Real>& boxes) {
  PairGraph& graph = state_.graph;
  const auto review_once = [&, all = boxes.boxes()](PairGraph::EdgeId edge) {
    if (!graph.renew_stamp(edge, stamp_)) return;
    const auto [a, b] = graph.pairs()[edge];
    review(edge, !by_boxes_ || overlap(all[index(a)], all[index(b)]));
  };
  for (const Pair pair : state_.fresh) {
    const PairGraph::EdgeId edge = graph.find(pair);
    if (edge != PairGraph::none) review_once(edge);
  }
  if (by_boxes_) {
    for (const BoxId id : boxes.changed()) graph.for_each_of(id, review_once);
  }
  for (const BoxId id : state_.asked_slots) graph.for_each_of(id, review_once);
}

template <int D, typename Real>
void PairRefiner::review_all(std::span<const Box<D, Real>> boxes) {
  const std::span<const Pair> pairs = state_.graph.pairs();
  const bool is_asking = has_predicate();
  std::array<std::uint8_t, 256> flags;
  flags.fill(1);
  for (std::size_t begin = 0; begin < pairs.size(); begin += flags.size()) {
    const std::span<const Pair> some = pairs.subspan(begin, std::min(flags.size(), pairs.size() - begin));
    if (by_boxes_) kernels::set_overlap_flags(boxes, some, flags.data());
    const std::uint8_t* const marks = state_.graph.marks().data() + begin;
    for (std::size_t i = 0; i < some.size(); ++i) {
      // Nearly all are unchanged.
      if (!is_asking && i % 8 == 0 && i + 8 <= some.size() && say_the_same(&flags[i], marks + i))
        i += 7;
      else if (is_asking || marks[i] != flags[i] * edge_holds)
        review(static_cast<PairGraph::EdgeId>(begin + i), flags[i] != 0);
    }
  }
}

/// Notes an edge if it may change.
void PairRefiner::review(PairGraph::EdgeId edge, bool overlaps) {
  const std::uint8_t mark = state_.graph.marks()[edge];
  const std::uint8_t new_mark = overlaps ? edge_holds : 0;
  const bool overlapped = (mark & edge_overlaps) != 0;
  const Pair pair = state_.graph.pairs()[edge];
  if (overlaps && has_predicate() &&
      (!overlapped || asks_about(index(pair.first)) || asks_about(index(pair.second))))
    questions_.push_back({pair, reviewed_.size()});
  else if (has_predicate() ? overlaps == overlapped : mark == new_mark)
    return;
  reviewed_.push_back({edge, new_mark});
}

/// Asks the predicate, in the order of the slots.
void PairRefiner::answer(Generations generations) {
  std::sort(questions_.begin(), questions_.end(),
            [](const Question& a, const Question& b) { return a.pair < b.pair; });
  const core::CallersEnvironment callers;
  for (const Question& question : questions_) {
    const auto [first, second] = handles_of(question.pair, generations);
    if (!predicate_(first, second)) reviewed_[question.place].new_mark = edge_overlaps;
  }
}

/// Turns the changes of edges into events.
void PairRefiner::tell() {
  auto& [begun, ended] = state_.refined;
  core::make_room(begun, reviewed_.size());
  core::make_room(ended, reviewed_.size());
  for (const auto& [edge, new_mark] : reviewed_) {
    const bool held = std::exchange(state_.graph.mark(edge), new_mark) == edge_holds;
    const bool holds = new_mark == edge_holds;
    if (held != holds) (holds ? begun : ended).push_back(state_.graph.pairs()[edge]);
  }
  state_.fresh.clear();
  sort_pairs(begun, sorting_);
  sort_pairs(ended, sorting_);
}

void PairRefiner::settle() noexcept {
  for (const BoxId id : state_.asked_slots) asked_marks_[index(id)] = 0;
  state_.asked_slots.clear();
  state_.asks_about_all = false;
  const auto& [begun, ended] = state_.candidates;
  if (watch_.wastes(taken_ + reviewed_.size(), begun.capacity() + ended.capacity() + reviewed_.capacity())) {
    core::give_back(state_.candidates.begun, state_.candidates.ended, state_.refined.begun,
                    state_.refined.ended, state_.fresh, reviewed_, questions_, sorting_);
  }
  if (state_.is_refining && !has_predicate() && !by_boxes_) {
    state_.graph = {};
    state_.is_refining = false;
  }
}

void PairRefiner::shrink_to_fit() {
  state_.graph.shrink_to_fit();
  state_.candidates.shrink_to_fit();
  state_.refined.shrink_to_fit();
  if (state_.asked_slots.empty()) asked_marks_.clear();
  core::shrink(state_.asked_slots, state_.fresh, asked_marks_, reviewed_, questions_, sorting_);
}

std::size_t PairRefiner::bytes() const noexcept {
  return state_.graph.bytes() + state_.candidates.bytes() + state_.refined.bytes() +
         core::bytes_of(state_.asked_slots, state_.fresh, asked_marks_, reviewed_, questions_, sorting_);
}

std::vector<Pair> PairRefiner::tracked(std::vector<Pair> current) const {
  return state_.candidates.netted().undone(state_.is_refining ? edges() : std::move(current));
}

std::vector<Pair> PairRefiner::edges() const {
  std::vector<Pair> edges(state_.graph.pairs().begin(), state_.graph.pairs().end());
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<Pair> PairRefiner::held_edges() const {
  std::vector<Pair> edges = this->edges();
  std::erase_if(edges,
                [&graph = state_.graph](Pair pair) { return graph.marks()[graph.find(pair)] != edge_holds; });
  return edges;
}

void PairRefiner::restore(RefinerState state, std::size_t slots) {
  state_ = std::move(state);
  asked_marks_.assign(state_.asked_slots.empty() ? 0 : slots, 0);
  for (const BoxId id : state_.asked_slots) asked_marks_[index(id)] = 1;
}

template PairEvents& PairRefiner::refine(const BoxTable<2, float>&, Generations);
template PairEvents& PairRefiner::refine(const BoxTable<2, double>&, Generations);
template PairEvents& PairRefiner::refine(const BoxTable<3, float>&, Generations);
template PairEvents& PairRefiner::refine(const BoxTable<3, double>&, Generations);

}  // namespace broadside::world
