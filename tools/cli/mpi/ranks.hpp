// The ranks of the program: what goes wrong on one is said once, and ends all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include <mpi.h>

namespace broadside::cli {

int rank();
int ranks();

/// What went wrong on some rank, thrown on all of them; the text is that of the first such rank.
class EndsOnAll : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws EndsOnAll on all ranks if some rank has an error.
void settle(const std::exception_ptr& error);

/// Does a step of work on all ranks, or ends on all of them.
template <typename Work>
void on_all(const Work& work) {
  std::exception_ptr error;
  try {
    work();
  } catch (...) {
    error = std::current_exception();
  }
  settle(error);
}

/// The bytes of a value of rank 0, on all ranks.
void broadcast(void* value, int bytes);

std::uint64_t sum_of_ranks(std::uint64_t number);

/// Sends bytes from one rank to another, and receives them, however many.
void send(const void* bytes, std::uint64_t size, int to);
void receive(void* bytes, std::uint64_t size, int from);

}  // namespace broadside::cli
