// Leaves out invalid boxes on request; reports the first ones and counts all.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {

/// Refuses the first invalid box or, if ReadOptions::say_invalid is set, leaves out all invalid boxes.
class Quarantine {
 public:
  /// The number of boxes that are reported individually; the rest are only counted.
  static constexpr std::uint64_t max_told = 20;

  explicit Quarantine(const ReadOptions& options) : say_(options.say_invalid) {}

  /// Whether invalid boxes are left out rather than refused.
  bool leaves_out() const noexcept { return static_cast<bool>(say_); }

  /// Whether `read()` returned. If it throws a FileError, leaves the box out and reports the error; without
  /// say_invalid, passes the error on to the caller.
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

  /// Says how many boxes of a file were left out; empty for 0.
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
