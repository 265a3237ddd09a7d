// The work folder of a join: its manifest, which records finished steps, and the files of its parts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace broadside::out_of_core {

/// A part's record in the manifest.
struct PartRecord {
  std::string name;                       ///< such as "12"; "12.3" is a subpart of part 12
  std::vector<double> low;                ///< bounds of its region
  std::vector<double> high;               ///<
  std::array<std::uint64_t, 2> boxes{};   ///< number of boxes that touch it, for each source
  std::array<std::uint64_t, 2> blocks{};  ///< number of blocks of each source's file
  bool is_whole = false;                  ///< too large, and cutting does not help
  bool is_joined = false;                 ///< its pairs are on disk, and its boxes are removed
  std::uint64_t pairs = 0;
  std::vector<std::uint64_t> runs{};  ///< number of blocks of each sorted run
};

/// The finished steps. The manifest is replaced as a whole after each step.
struct Manifest {
  std::string kind;      ///< dimension, precision, number of sources, and what is stored of pairs
  std::string identity;  ///< OutOfCoreOptions::identity
  bool is_read = false;  ///< all boxes are in the parts' files
  std::array<std::uint64_t, 2> boxes{};
  bool has_large_ids = false;
  std::vector<PartRecord> parts;
};

/// Not thread-safe. Members throw OutOfCoreError.
class WorkFolder {
 public:
  /// Creates the folder if necessary, and locks it against other processes until destruction. Refuses a
  /// folder that holds anything but a join.
  explicit WorkFolder(std::filesystem::path path);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const noexcept { return path_; }

  /// Reads the manifest, whose regions have D bounds; empty for a new folder.
  std::optional<Manifest> read(std::size_t dimension) const;

  /// Replaces the manifest atomically.
  void write(const Manifest& manifest) const;

  std::filesystem::path box_file(const PartRecord& part, std::size_t side) const;
  std::filesystem::path pair_file(const PartRecord& part, std::size_t run) const;

  /// The file of a run that was merged from several.
  std::filesystem::path merged_file(std::size_t number) const;

  /// Removes the files that `manifest` does not need: unfinished work of a killed join.
  void remove_others(const Manifest& manifest) const;

  /// Removes a part's file of boxes, if there is one.
  void remove_boxes(const PartRecord& part, std::size_t side) const;

  /// Removes all files of the join, and the folder if it is then empty.
  void remove() noexcept;

 private:
  void lock();

  std::filesystem::path path_;
  int lock_ = -1;
};

/// An identity as stored in the manifest: printable ASCII, with other bytes as %ff.
std::string identity_text(const std::string& identity);

}  // namespace broadside::out_of_core
