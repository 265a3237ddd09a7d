// Leaves out invalid boxes where that is asked for, reports the first of them and counts all.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {

/// Refuses the first invalid box or, where ReadOptions::say_invalid is set, leaves out all invalid ones.
class Quarantine {
 public:
  /// The number of boxes that are reported one by one; the rest are only counted.
  static constexpr std::uint64_t max_told = 20;

  explicit Quarantine(const ReadOptions& options) : say_(options.say_invalid) {}

  /// Whether invalid boxes are left out rather than refused.
  bool leaves_out() const noexcept { return static_cast<bool>(say_); }

  /// Whether `read()` returned. If it throws a FileError, the box is left out and the error reported; without
  /// say_invalid, the error goes on to the caller.
  template <typename Read>
  bool holds(const Read& read) {
    if (!say_) {
      read();
      return true;
    }
    try {
      read();
      return true;
    } catch (const FileError& error) {
      add(error.what());
      return false;
    }
  }

  /// How many boxes of a file were left out; empty for none.
  std::string warning(std::string_view file) const {
    if (count_ == 0) return {};
    return fmt::format("{}: left out {}{}", file, counted(count_, "invalid box", "invalid boxes"),
                       count_ > max_told ? fmt::format("; only the first {} are listed", max_told) : "");
  }

 private:
  void add(std::string_view why) {
    if (count_++ < max_told) say_(why);
  }

  std::function<void(std::string_view)> say_;
  std::uint64_t count_ = 0;
};

}  // namespace broadside::lab
