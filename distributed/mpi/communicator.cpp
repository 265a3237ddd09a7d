// Checked collective calls, and errors that are shared by all ranks.
#include "communicator.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <new>
#include <string>
#include <utility>

#include "broadside/error.hpp"

namespace broadside::mpi {
namespace {

/// By default, MPI ends all ranks if a call fails. This check is for communicators with another error
/// handler.
void check(int result, const char* call) {
  if (result == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> text{};
  int length = 0;
  MPI_Error_string(result, text.data(), &length);
  throw std::runtime_error(std::string(call) + " failed: " + text.data());
}

enum class ErrorKind : std::uint64_t { invalid_input, invalid_frame, invalid_spec, other };

/// A rank's error, as sent to the other ranks. It allocates nothing, because memory may be exhausted.
struct SentError {
  ErrorKind kind = ErrorKind::other;
  std::uint64_t index = 0;
  std::array<char, 1000> text{};
};

SentError fault_of(const std::exception_ptr& error, int rank) {
  SentError fault;
  const auto set = [&](ErrorKind kind, const char* text, std::size_t index = 0) {
    fault.kind = kind;
    fault.index = index;
    std::snprintf(fault.text.data(), fault.text.size(), "rank %d: %s", rank, text);
  };
  try {
    std::rethrow_exception(error);
  } catch (const InvalidInput& invalid) {
    set(ErrorKind::invalid_input, invalid.what(), invalid.index());
  } catch (const InvalidFrame& invalid) {
    set(ErrorKind::invalid_frame, invalid.what());
  } catch (const InvalidSpec& invalid) {
    set(ErrorKind::invalid_spec, invalid.what());
  } catch (const std::bad_alloc&) {
    set(ErrorKind::other, "out of memory");
  } catch (const std::exception& other) {
    set(ErrorKind::other, other.what());
  } catch (...) {
    set(ErrorKind::other, "an exception of another type");
  }
  return fault;
}

/// MPI counts in ints.
constexpr std::uint64_t max_bytes = std::uint64_t{1} << 30;

/// Calls use(bytes, count) for pieces of at most max_bytes.
template <typename Use>
void for_each_piece(std::byte* bytes, std::uint64_t size, const Use& use) {
  while (size > 0) {
    const std::uint64_t piece = std::min(size, max_bytes);
    use(bytes, static_cast<int>(piece));
    bytes += piece;
    size -= piece;
  }
}

}  // namespace

Communicator::Communicator(MPI_Comm comm) {
  check(MPI_Comm_dup(comm, &comm_), "MPI_Comm_dup");
  check(MPI_Comm_rank(comm_, &rank_), "MPI_Comm_rank");
  check(MPI_Comm_size(comm_, &size_), "MPI_Comm_size");
}

Communicator::~Communicator() {
  int is_finalized = 0;
  MPI_Finalized(&is_finalized);
  if (is_finalized == 0) MPI_Comm_free(&comm_);
}

void Communicator::settle(const std::exception_ptr& error) {
  int failing = error ? rank_ : size_;
  check(MPI_Allreduce(MPI_IN_PLACE, &failing, 1, MPI_INT, MPI_MIN, comm_), "MPI_Allreduce");
  if (failing == size_) return;
  SentError fault;
  if (failing == rank_) fault = fault_of(error, rank_);
  check(MPI_Bcast(&fault, sizeof(fault), MPI_BYTE, failing, comm_), "MPI_Bcast");
  const std::string text = fault.text.data();
  if (fault.kind == ErrorKind::invalid_input) throw InvalidInput(static_cast<std::size_t>(fault.index), text);
  if (fault.kind == ErrorKind::invalid_frame) throw InvalidFrame(text);
  if (fault.kind == ErrorKind::invalid_spec) throw InvalidSpec(text);
  if (error) std::rethrow_exception(error);
  throw RankError(failing, text);
}

void Communicator::check_same(std::uint64_t number, const char* what) {
  // The maximum of x and of ~x gives the maximum and the minimum of x.
  std::array<std::uint64_t, 2> bounds{number, ~number};
  check(MPI_Allreduce(MPI_IN_PLACE, bounds.data(), 2, MPI_UINT64_T, MPI_MAX, comm_), "MPI_Allreduce");
  if (bounds[0] != ~bounds[1])
    throw InvalidSpec(std::string("ranks differ in ") + what + "; expected the same on each");
}

std::uint64_t Communicator::sum(std::uint64_t number) {
  check(MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_UINT64_T, MPI_SUM, comm_), "MPI_Allreduce");
  return number;
}

std::uint64_t Communicator::max(std::uint64_t number) {
  check(MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_UINT64_T, MPI_MAX, comm_), "MPI_Allreduce");
  return number;
}

double Communicator::sum(double number) {
  check(MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_DOUBLE, MPI_SUM, comm_), "MPI_Allreduce");
  return number;
}

double Communicator::max(double number) {
  check(MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_DOUBLE, MPI_MAX, comm_), "MPI_Allreduce");
  return number;
}

std::uint64_t Communicator::sum_before(std::uint64_t number) {
  std::uint64_t before = 0;
  check(MPI_Exscan(&number, &before, 1, MPI_UINT64_T, MPI_SUM, comm_), "MPI_Exscan");
  return rank_ == 0 ? 0 : before;
}

std::vector<std::uint64_t> Communicator::gather(std::uint64_t number) {
  std::vector<std::uint64_t> numbers;
  together([&] { numbers.resize(size()); });
  check(MPI_Allgather(&number, 1, MPI_UINT64_T, numbers.data(), 1, MPI_UINT64_T, comm_), "MPI_Allgather");
  return numbers;
}

void Communicator::broadcast_bytes(void* bytes, std::uint64_t size) {
  for_each_piece(static_cast<std::byte*>(bytes), size, [&](std::byte* piece, int count) {
    check(MPI_Bcast(piece, count, MPI_BYTE, 0, comm_), "MPI_Bcast");
  });
}

void Communicator::exchange_counts(std::span<const std::uint64_t> to, std::span<std::uint64_t> from) {
  check(MPI_Alltoall(to.data(), 1, MPI_UINT64_T, from.data(), 1, MPI_UINT64_T, comm_), "MPI_Alltoall");
}

void Communicator::reserve_requests(std::span<const Block> out, std::span<const Block> in) {
  std::size_t pieces = 0;
  for (const std::span<const Block> blocks : {out, in})
    for (const Block& block : blocks) pieces += static_cast<std::size_t>(block.size / max_bytes) + 1;
  requests_.reserve(pieces);
}

void Communicator::exchange_blocks(std::span<const Block> out, std::span<const Block> in) {
  requests_.clear();
  try {
    begin_exchange(out, in);
  } catch (...) {
    // The caller frees the buffers, so no request may be pending. A send that cannot be cancelled has been
    // received.
    for (MPI_Request& request : requests_)
      if (request != MPI_REQUEST_NULL) MPI_Cancel(&request);
    wait_for_requests();
    throw;
  }
  check(wait_for_requests(), "MPI_Waitall");
}

void Communicator::begin_exchange(std::span<const Block> out, std::span<const Block> in) {
  constexpr int tag = 0;
  const auto rank_of = [this](std::size_t block) {
    return static_cast<int>(block) + (static_cast<int>(block) >= rank_ ? 1 : 0);
  };
  for (std::size_t block = 0; block < in.size(); ++block)
    for_each_piece(in[block].bytes, in[block].size, [&](std::byte* piece, int count) {
      check(MPI_Irecv(piece, count, MPI_BYTE, rank_of(block), tag, comm_,
                      &requests_.emplace_back(MPI_REQUEST_NULL)),
            "MPI_Irecv");
    });
  for (std::size_t block = 0; block < out.size(); ++block) {
    sent_bytes_ += out[block].size;
    for_each_piece(out[block].bytes, out[block].size, [&](std::byte* piece, int count) {
      check(MPI_Isend(piece, count, MPI_BYTE, rank_of(block), tag, comm_,
                      &requests_.emplace_back(MPI_REQUEST_NULL)),
            "MPI_Isend");
    });
  }
}

int Communicator::wait_for_requests() {
  return MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
}

}  // namespace broadside::mpi
