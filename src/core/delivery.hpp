// Delivery: the pieces of a search that several threads share, and their pairs on the way to one sink, in
// blocks, so that memory for them has a limit.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "broadside/pair.hpp"

namespace broadside::core {

/// Some thousand pairs, and the block that follows in a list.
struct PairBlock {
  PairBlock* next;
  std::size_t size;
  std::array<Pair, 4096> pairs;
};

/// The blocks of all lists of a search. Keeps those that are given back. Thread-safe.
class PairBlocks {
 public:
  /// The most blocks in use at once: 64 MiB.
  static constexpr std::size_t max_blocks = (std::size_t{64} << 20) / sizeof(PairBlock::pairs);

  /// An empty block; null where `max_blocks` are in use. Throws std::bad_alloc.
  PairBlock* take();

  /// Gives back a block and all that follow it.
  void give_back(PairBlock* first) noexcept;

  std::size_t used() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<PairBlock>> all_;
  PairBlock* free_ = nullptr;
  std::size_t used_ = 0;
};

/// Pairs in the order in which they were appended. Gives its blocks back.
class PairList {
 public:
  PairList() = default;
  PairList(PairList&& other) noexcept
      : blocks_(other.blocks_),
        first_(std::exchange(other.first_, nullptr)),
        last_(std::exchange(other.last_, nullptr)) {}
  PairList& operator=(PairList&& other) noexcept {
    clear();
    blocks_ = other.blocks_;
    first_ = std::exchange(other.first_, nullptr);
    last_ = std::exchange(other.last_, nullptr);
    return *this;
  }
  ~PairList() { clear(); }

  /// False if `blocks` has too little room for all of them, or throws std::bad_alloc; the list is then good
  /// for clear() alone.
  bool append(std::span<const Pair> pairs, PairBlocks& blocks);

  /// Hands all pairs on, and gives back each block once the sink has taken it.
  void move_to(PairSink& sink);

  void clear() noexcept;

 private:
  PairBlocks* blocks_ = nullptr;  // null before the first block
  PairBlock* first_ = nullptr;
  PairBlock* last_ = nullptr;
};

/// Workers take pieces in order and finish them in any order; the pairs go to the sink in order, in the
/// thread that made the delivery: the caller's. That thread searches straight into the sink where nothing
/// waits before its piece; all other pieces keep their pairs in blocks until it comes to deliver them.
///
/// No worker waits for another. One that finds no room takes no further piece, and a piece that outgrows the
/// room is given up, to be searched again. So a search goes by rounds of all workers; a round after which
/// nothing could be delivered was stopped by the first piece, which is then for the caller's thread to
/// search.
class Delivery {
 public:
  Delivery(PairBlocks& blocks, std::size_t pieces, PairSink& target)
      : blocks_(&blocks), target_(&target), pieces_(pieces) {}

  struct Piece {
    std::size_t number;
    bool is_direct;  // its pairs go straight to the target
  };

  bool is_callers_thread() const { return std::this_thread::get_id() == caller_; }

  /// How many pieces are delivered, which is the number of the first that is not. For the caller's thread.
  std::size_t delivered() const { return delivered_; }

  bool is_complete() const { return delivered_ == pieces_.size(); }

  void begin_round();

  /// The next piece for a worker; none if there is no other, or no room for one, or if the round is to end.
  std::optional<Piece> take();

  /// Says that a piece has ended, and takes the pairs of one that is not direct.
  void end(const Piece& piece, PairList pairs);

  /// Says that there was no room for a piece's pairs, which are dropped.
  void give_up(const Piece& piece);

  /// Delivers the next piece, if it has ended, and says whether it did. In the caller's thread alone; where
  /// the sink itself came here, what called it goes on when it returns.
  bool deliver_next();

 private:
  enum class State { open, taken, ended };

  struct Result {
    PairList pairs;
    State state = State::open;
  };

  PairBlocks* blocks_;
  PairSink* target_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::mutex mutex_;  // for all that follows
  std::vector<Result> pieces_;
  std::size_t next_ = 0;       // no piece before it is open
  std::size_t delivered_ = 0;  // written by the caller's thread alone
  bool delivering_ = false;
  bool workers_left_ = false;  // in this round, since there was no room
  bool round_ends_ = false;
};

}  // namespace broadside::core
