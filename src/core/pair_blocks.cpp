// PairList and PairBlocks: pairs that wait to be delivered, in blocks, so that memory for them has a limit.
#include "core/pair_blocks.hpp"

#include <algorithm>

namespace broadside::core {

PairBlock* PairBlocks::take() {
  const std::lock_guard lock(mutex_);
  if (used_ == max_blocks) return nullptr;
  if (free_ == nullptr) {
    all_.push_back(std::make_unique_for_overwrite<PairBlock>());
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

}  // namespace broadside::core
