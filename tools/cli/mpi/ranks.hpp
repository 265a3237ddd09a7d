// The ranks of the program: an error on one rank is reported once and ends all ranks.
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

/// An error of some rank, thrown on all ranks, with the text of the first rank that has one.
class SharedError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws SharedError on all ranks if some rank has an error.
void settle(const std::exception_ptr& error);

/// Does a step of work on all ranks; throws on all of them if it fails on one.
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

/// Copies a value from rank 0 to all ranks.
void broadcast(void* value, int bytes);

std::uint64_t sum_of_ranks(std::uint64_t number);

/// Send any number of bytes from one rank to another, and receive them.
void send(const void* bytes, std::uint64_t size, int to);
void receive(void* bytes, std::uint64_t size, int from);

}  // namespace broadside::cli
