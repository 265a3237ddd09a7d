// The folder of a join: what has been done, written down, and one join at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace broadside::out_of_core {

/// A part as it is written down.
struct Part {
  std::string name;                       ///< such as "12", or "12.3" for a part of that one
  std::vector<double> low;                ///< its region
  std::vector<double> high;               ///<
  std::array<std::uint64_t, 2> boxes{};   ///< that touch it, of each side
  std::array<std::uint64_t, 2> blocks{};  ///< of their files
  bool is_whole = false;                  ///< it has too many boxes, and cuts do not help
  bool is_joined = false;                 ///< its pairs are there, and its boxes are not any more
  std::uint64_t pairs = 0;
  std::vector<std::uint64_t> runs{};  ///< the blocks of each file of sorted pairs
};

/// What has been done. It is written down whole after each step.
struct Manifest {
  std::string kind;      ///< dimension, precision and number of sources
  std::string identity;  ///< OutOfCoreOptions::identity
  std::array<std::uint64_t, 2> boxes{};
  bool has_large_ids = false;
  std::vector<Part> parts;
};

/// One thread at a time. All throw OutOfCoreError.
class WorkFolder {
 public:
  /// Makes the folder where it is not there, and holds it against other processes until the end.
  explicit WorkFolder(std::filesystem::path path);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

  /// What was written down; nothing in a new folder.
  std::optional<Manifest> read() const;

  /// Writes it down in the stead of what was, at once or not at all.
  void write(const Manifest& manifest) const;

  std::filesystem::path box_file(const Part& part, std::size_t side) const;
  std::filesystem::path pair_file(const Part& part, std::size_t run) const;

  /// Removes the files of parts that `manifest` does not name or need: what a join that was killed left.
  void remove_others(const Manifest& manifest) const;

  /// Removes everything that is a join's, and the folder if that leaves it empty.
  void remove();

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace broadside::out_of_core
