// Delivery: hands out the pieces of a shared search, and delivers their pairs to one sink in order. Pairs
// wait in blocks of limited total size.
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

/// A node of a linked list of pairs.
struct PairBlock {
  PairBlock* next;
  std::size_t size;
  std::array<Pair, 4096> pairs;
};

/// The block pool of all lists of a search. Keeps returned blocks for reuse. Thread-safe.
class PairBlocks {
 public:
  /// The maximum number of blocks in use at once: 64 MiB of pairs.
  static constexpr std::size_t max_blocks = (std::size_t{64} << 20) / sizeof(PairBlock::pairs);

  /// An empty block; null if `max_blocks` are in use. Throws std::bad_alloc.
  PairBlock* take();

  /// Returns a block and all blocks after it in its list to the pool.
  void give_back(PairBlock* first) noexcept;

  std::size_t used() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<PairBlock>> all_;
  PairBlock* free_ = nullptr;
  std::size_t used_ = 0;
};

/// Pairs in the order in which they were appended. Its destructor returns the blocks to their pool.
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

  /// Returns false if `blocks` has too little room, and may throw std::bad_alloc. After either, the list may
  /// only be cleared.
  bool append(std::span<const Pair> pairs, PairBlocks& blocks);

  /// Passes all pairs to the sink, and returns each block to the pool once the sink has taken its pairs.
  void move_to(PairSink& sink);

  void clear() noexcept;

 private:
  PairBlocks* blocks_ = nullptr;  // null before the first block
  PairBlock* first_ = nullptr;
  PairBlock* last_ = nullptr;
};

/// Workers take pieces in order and finish them in any order. The pairs reach the sink in order, in the
/// caller's thread: the one that made the delivery. That thread searches directly into the sink if all pieces
/// before its own are delivered. All other pieces keep their pairs in blocks until it delivers them.
///
/// No worker waits for another. A worker that finds no room takes no further piece; a piece that runs out of
/// room is dropped and searched again. So a search runs in rounds of all workers. If a round delivers
/// nothing, its first piece ran out of room, and the caller's thread then searches that piece.
class Delivery {
 public:
  Delivery(PairBlocks& blocks, std::size_t pieces, PairSink& target)
      : blocks_(&blocks), target_(&target), pieces_(pieces) {}

  struct Piece {
    std::size_t number;
    bool is_direct;  // its pairs go directly to the target
  };

  bool is_callers_thread() const { return std::this_thread::get_id() == caller_; }

  /// How many pieces are delivered: the number of the first undelivered one. Only for the caller's thread.
  std::size_t delivered() const { return delivered_; }

  bool is_complete() const { return delivered_ == pieces_.size(); }

  void begin_round();

  /// The next piece for a worker; empty if none is left, there is no room for one, or the round is to end.
  std::optional<Piece> take();

  /// Marks a piece as ended, and takes its pairs if it is not direct.
  void end(const Piece& piece, PairList pairs);

  /// Reopens a piece that ran out of room and dropped its pairs.
  void give_up(const Piece& piece);

  /// Delivers the next piece if it has ended; returns whether it did. Only for the caller's thread. Returns
  /// false if called within a delivery, as when the sink runs a task of the executor.
  bool deliver_next();

 private:
  enum class PieceState { open, taken, ended };

  struct PieceResult {
    PairList pairs;
    PieceState state = PieceState::open;
  };

  PairBlocks* blocks_;
  PairSink* target_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::mutex mutex_;  // guards all members below
  std::vector<PieceResult> pieces_;
  std::size_t next_ = 0;       // no piece before this one is open
  std::size_t delivered_ = 0;  // written by the caller's thread alone
  bool delivering_ = false;
  bool workers_left_ = false;  // a worker left this round for lack of room
  bool round_ends_ = false;
};

}  // namespace broadside::core
