// A pipe, for tests of input that arrives in pieces and cannot be read twice.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <unistd.h>

namespace broadside::lab {

/// A pipe into which a thread writes, and the path at which it can be opened.
class Pipe {
 public:
  explicit Pipe(std::string text)
      : writer_([this, text = std::move(text)] {
          // In pieces, like the output of a program that computes in between.
          for (std::size_t begin = 0; begin < text.size(); begin += 1000) {
            const std::string piece = text.substr(begin, 1000);
            if (::write(ends_[1], piece.data(), piece.size()) != static_cast<ssize_t>(piece.size())) break;
          }
          ::close(ends_[1]);
        }) {}

  ~Pipe() {
    writer_.join();
    ::close(ends_[0]);
  }

  std::string path() const { return "/dev/fd/" + std::to_string(ends_[0]); }

 private:
  std::array<int, 2> ends_ = make_ends();
  std::thread writer_;

  static std::array<int, 2> make_ends() {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw std::runtime_error("no pipe; expected one");
    return ends;
  }
};

}  // namespace broadside::lab
