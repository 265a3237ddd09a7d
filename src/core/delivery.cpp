// Delivery: hands out the pieces of a shared search, and delivers their pairs to one sink in order.
#include "core/delivery.hpp"

#include <algorithm>

namespace broadside::core {
namespace {

/// With this many blocks in use, no piece starts that needs blocks: the running pieces need room to finish.
constexpr std::size_t nearly_full = PairBlocks::max_blocks / 2;

/// Below this, a round ends if a worker found no room in it, so that all workers resume.
constexpr std::size_t nearly_empty = PairBlocks::max_blocks / 8;

}  // namespace

PairBlock* PairBlocks::take() {
  const std::lock_guard lock(mutex_);
  if (used_ == max_blocks) return nullptr;
  if (free_ == nullptr) {
    // make_unique() would also set it to zeros.
    all_.push_back(std::unique_ptr<PairBlock>(new PairBlock));  // NOLINT(modernize-make-unique)
    free_ = all_.back().get();
    free_->next = nullptr;
  }
  PairBlock* const block = free_;
  free_ = block->next;
  block->next = nullptr;
  block->size = 0;
  ++used_;
  return block;
}

void PairBlocks::give_back(PairBlock* first) noexcept {
  const std::lock_guard lock(mutex_);
  while (first != nullptr) {
    PairBlock* const next = std::exchange(first->next, free_);
    free_ = first;
    first = next;
    --used_;
  }
}

std::size_t PairBlocks::used() const {
  const std::lock_guard lock(mutex_);
  return used_;
}

bool PairList::append(std::span<const Pair> pairs, PairBlocks& blocks) {
  while (!pairs.empty()) {
    if (last_ == nullptr || last_->size == last_->pairs.size()) {
      PairBlock* const block = blocks.take();
      if (block == nullptr) return false;
      blocks_ = &blocks;
      (last_ == nullptr ? first_ : last_->next) = block;
      last_ = block;
    }
    const std::size_t count = std::min(pairs.size(), last_->pairs.size() - last_->size);
    std::copy_n(pairs.begin(), count, last_->pairs.begin() + static_cast<std::ptrdiff_t>(last_->size));
    last_->size += count;
    pairs = pairs.subspan(count);
  }
  return true;
}

void PairList::move_to(PairSink& sink) {
  while (first_ != nullptr) {
    sink.put(std::span(first_->pairs).first(first_->size));
    PairBlock* const next = std::exchange(first_->next, nullptr);
    blocks_->give_back(std::exchange(first_, next));
  }
  last_ = nullptr;
}

void PairList::clear() noexcept {
  if (first_ != nullptr) blocks_->give_back(first_);
  first_ = last_ = nullptr;
}

void Delivery::begin_round() {
  const std::lock_guard lock(mutex_);
  workers_left_ = false;
  round_ends_ = false;
}

std::optional<Delivery::Piece> Delivery::take() {
  const std::lock_guard lock(mutex_);
  while (next_ < pieces_.size() && pieces_[next_].state != PieceState::open) ++next_;
  const std::size_t used = blocks_->used();
  if (workers_left_ && used < nearly_empty && is_callers_thread()) round_ends_ = true;
  if (next_ == pieces_.size() || round_ends_) return std::nullopt;
  const bool is_direct = next_ == delivered_ && is_callers_thread() && !delivering_;
  if (!is_direct && used >= nearly_full) {
    workers_left_ = true;
    return std::nullopt;
  }
  if (is_direct) delivering_ = true;  // until this piece ends
  pieces_[next_].state = PieceState::taken;
  return Piece{next_++, is_direct};
}

void Delivery::end(const Piece& piece, PairList pairs) {
  const std::lock_guard lock(mutex_);
  pieces_[piece.number].state = PieceState::ended;
  pieces_[piece.number].pairs = std::move(pairs);
  if (!piece.is_direct) return;
  delivering_ = false;
  ++delivered_;
}

void Delivery::give_up(const Piece& piece) {
  const std::lock_guard lock(mutex_);
  pieces_[piece.number].state = PieceState::open;
  next_ = std::min(next_, piece.number);
  workers_left_ = true;
}

bool Delivery::deliver_next() {
  std::unique_lock lock(mutex_);
  if (delivering_ || is_complete() || pieces_[delivered_].state != PieceState::ended) return false;
  delivering_ = true;
  PairList pairs = std::move(pieces_[delivered_].pairs);
  lock.unlock();
  pairs.move_to(*target_);
  lock.lock();
  delivering_ = false;
  ++delivered_;
  return true;
}

}  // namespace broadside::core
