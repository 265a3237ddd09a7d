// A communicator with errors that are shared by all ranks, and with exchanges of arrays of any length between
// all ranks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <span>
#include <type_traits>
#include <vector>

#include <mpi.h>

#include "broadside/mpi.hpp"

namespace broadside::mpi {

/// A private duplicate of the caller's communicator, so that its messages are never confused with the
/// caller's. All members except rank(), size() and sent_bytes() are collective.
class Communicator {
 public:
  explicit Communicator(MPI_Comm comm);
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  int rank() const noexcept { return rank_; }
  std::size_t size() const noexcept { return static_cast<std::size_t>(size_); }

  /// Bytes that this rank has sent to others by exchange().
  std::uint64_t sent_bytes() const noexcept { return sent_bytes_; }

  /// Runs a step of work on every rank. If it throws on one, all ranks throw, so that none waits for a rank
  /// that has left. InvalidInput, InvalidFrame and InvalidSpec of the first failing rank are rethrown on all
  /// ranks. For anything else, the failing rank throws its own exception, and the others RankError.
  template <typename Work>
  void together(const Work& work) {
    std::exception_ptr error;
    try {
      work();
    } catch (...) {
      error = std::current_exception();
    }
    settle(error);
  }

  /// Throws InvalidSpec on all ranks unless all pass the same number.
  void check_same(std::uint64_t number, const char* what);

  std::uint64_t sum(std::uint64_t number);
  std::uint64_t max(std::uint64_t number);
  double sum(double number);
  double max(double number);

  /// Exclusive prefix sum: the sum of the numbers of all lower ranks.
  std::uint64_t sum_before(std::uint64_t number);

  /// The number of each rank.
  std::vector<std::uint64_t> gather(std::uint64_t number);

  /// Copies the values of rank 0 to all ranks.
  template <typename T>
  void broadcast(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::uint64_t count = values.size();
    broadcast_bytes(&count, sizeof(count));
    together([&] { values.resize(count); });
    broadcast_bytes(values.data(), count * sizeof(T));
  }

  /// Values received from all ranks.
  template <typename T>
  struct Received {
    std::vector<T> values;              ///< this rank's own first, then the others' in rank order
    std::vector<std::uint64_t> counts;  ///< from each rank

    /// Calls visit(value, rank) for each.
    template <typename Visit>
    void for_each(int own_rank, const Visit& visit) const {
      std::size_t next = 0;
      const auto visit_from = [&](std::size_t rank) {
        for (std::uint64_t i = 0; i < counts[rank]; ++i)
          visit(values[next++], static_cast<std::uint32_t>(rank));
      };
      const auto own = static_cast<std::size_t>(own_rank);
      visit_from(own);
      for (std::size_t rank = 0; rank < counts.size(); ++rank)
        if (rank != own) visit_from(rank);
    }
  };

  /// Sends to[r] to rank r. Values that stay on this rank are not copied if to[rank()] has enough capacity
  /// for the others'.
  template <typename T>
  Received<T> exchange(std::vector<std::vector<T>> to) {
    static_assert(std::is_trivially_copyable_v<T>);
    Received<T> received;
    std::vector<Block> out;
    std::vector<Block> in;
    std::vector<std::uint64_t> counts;
    together([&] {
      for (const std::vector<T>& values : to) counts.push_back(values.size());
      received.counts.resize(to.size());
    });
    exchange_counts(counts, received.counts);
    together([&] {
      const auto own = static_cast<std::size_t>(rank_);
      std::uint64_t all = 0;
      for (const std::uint64_t count : received.counts) all += count;
      received.values = std::move(to[own]);
      std::size_t used = received.values.size();
      received.values.resize(static_cast<std::size_t>(all));
      for (std::size_t rank = 0; rank < to.size(); ++rank) {
        if (rank == own) continue;
        T* const begin = received.values.data() + used;
        used += static_cast<std::size_t>(received.counts[rank]);
        out.push_back({reinterpret_cast<std::byte*>(to[rank].data()), to[rank].size() * sizeof(T)});
        in.push_back({reinterpret_cast<std::byte*>(begin), received.counts[rank] * sizeof(T)});
      }
      reserve_requests(out, in);
    });
    exchange_blocks(out, in);
    return received;
  }

 private:
  struct Block {
    std::byte* bytes;
    std::uint64_t size;
  };

  void settle(const std::exception_ptr& error);
  void broadcast_bytes(void* bytes, std::uint64_t size);
  void exchange_counts(std::span<const std::uint64_t> to, std::span<std::uint64_t> from);

  /// One block for each other rank, in rank order.
  void reserve_requests(std::span<const Block> out, std::span<const Block> in);
  void exchange_blocks(std::span<const Block> out, std::span<const Block> in);
  void begin_exchange(std::span<const Block> out, std::span<const Block> in);
  int wait_for_requests();

  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
  std::uint64_t sent_bytes_ = 0;
  std::vector<MPI_Request> requests_;
};

}  // namespace broadside::mpi
