// A file that is written beside its target.
#pragma once

#include <filesystem>
#include <memory>

namespace broadside::lab::platform {

/// A file that will replace the one at a path, and is beside it until then. If the system supports it, the
/// file has no name, so that nothing remains even if the process is killed; otherwise its name cannot be
/// guessed, so that no link can be planted there. Only one at a time.
class UnfinishedFile {
 public:
  /// `target` is not a link. During its lifetime, only the owner can read the new file.
  explicit UnfinishedFile(const std::filesystem::path& target);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Negative if none could be made; errno gives the reason.
  int descriptor() const;

  /// Moves the file to its target, with the old file's permissions on systems that have them. Returns whether
  /// it succeeded; if not, errno gives the reason.
  bool take_place();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Removes the unfinished file, if it has a name: for a signal handler that ends the process.
/// Async-signal-safe.
void remove_unfinished_file() noexcept;

}  // namespace broadside::lab::platform
