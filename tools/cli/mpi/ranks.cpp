// The ranks of the program: shared errors, and transfers of bytes.
#include "cli/mpi/ranks.hpp"

#include <algorithm>
#include <new>

namespace broadside::cli {
namespace {

constexpr int tag = 1;
constexpr std::uint64_t max_bytes = std::uint64_t{1} << 30;  // MPI counts in ints

std::string text_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    return "out of memory; expected fewer boxes or pairs, or more ranks on other machines";
  } catch (const std::exception& known) {
    return known.what();
  }
}

}  // namespace

int rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int ranks() {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}

void settle(const std::exception_ptr& error) {
  int failing = error ? rank() : ranks();
  MPI_Allreduce(MPI_IN_PLACE, &failing, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (failing == ranks()) return;
  std::string text;
  if (failing == rank()) text = text_of(error);
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, failing, MPI_COMM_WORLD);
  text.resize(static_cast<std::size_t>(size));
  MPI_Bcast(text.data(), size, MPI_CHAR, failing, MPI_COMM_WORLD);
  throw SharedError(text);
}

void broadcast(void* value, int bytes) { MPI_Bcast(value, bytes, MPI_BYTE, 0, MPI_COMM_WORLD); }

std::uint64_t sum_of_ranks(std::uint64_t number) {
  MPI_Allreduce(MPI_IN_PLACE, &number, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  return number;
}

void send(const void* bytes, std::uint64_t size, int to) {
  const auto* next = static_cast<const std::byte*>(bytes);
  while (size > 0) {
    const std::uint64_t piece = std::min(size, max_bytes);
    MPI_Send(next, static_cast<int>(piece), MPI_BYTE, to, tag, MPI_COMM_WORLD);
    next += piece;
    size -= piece;
  }
}

void receive(void* bytes, std::uint64_t size, int from) {
  auto* next = static_cast<std::byte*>(bytes);
  while (size > 0) {
    const std::uint64_t piece = std::min(size, max_bytes);
    MPI_Recv(next, static_cast<int>(piece), MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    next += piece;
    size -= piece;
  }
}

}  // namespace broadside::cli
