// A file that is written beside the place where it is to stand.
#pragma once

#include <filesystem>
#include <memory>

namespace broadside::lab::platform {

/// The file that is to stand at a path, until then beside it. Where the system can do that, it has no name,
/// so that nothing is left even of a process that is killed; else one that cannot be guessed, so that no link
/// can be planted there. One at a time.
class UnfinishedFile {
 public:
  /// `target` is not a link. While a file is there, only its owner can read the new one.
  explicit UnfinishedFile(const std::filesystem::path& target);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Negative where none could be made, and errno says why.
  int descriptor() const;

  /// Whether it now stands in its place, where the system has them with the permissions of the old file;
  /// where not, errno says why.
  bool take_place();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Removes the file that is being written, if it has a name: for a signal's handler that ends the process.
/// Async-signal-safe.
void remove_unfinished_file() noexcept;

}  // namespace broadside::lab::platform
