// Unfinished files on POSIX, with Linux's O_TMPFILE.
#include "lab/platform/unfinished_file.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <optional>
#include <random>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace broadside::lab::platform {
namespace {

/// The path of the unfinished file, while it has a name. It outlives every UnfinishedFile, because a signal
/// handler may read it at any time.
std::array<char, PATH_MAX> unfinished_path;
std::atomic<bool> has_unfinished_path = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal's handler must not wait");

std::string path_of_descriptor(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

/// Names the file for remove_unfinished_file() while it is beside its target. The length of the name does not
/// depend on the target's, which may already have the maximum.
void take_name(const std::filesystem::path& folder) {
  std::random_device random;
  const std::string name = fmt::format(".broadside-{:08x}{:08x}.part", random(), random());
  const std::string path = (folder / name).string();
  const std::size_t length = path.copy(unfinished_path.data(), unfinished_path.size() - 1);
  unfinished_path[length] = '\0';
  has_unfinished_path = true;
}

int opened(const std::filesystem::path& folder, mode_t mode) {
#ifdef O_TMPFILE
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, mode);
  if (unnamed >= 0 && ::access(path_of_descriptor(unnamed).c_str(), F_OK) == 0) return unnamed;
  if (unnamed >= 0) ::close(unnamed);
#endif
  take_name(folder);
  const int named =
      ::open(unfinished_path.data(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
  if (named < 0) has_unfinished_path = false;
  return named;
}

}  // namespace

struct UnfinishedFile::State {
  std::filesystem::path target;
  std::filesystem::path folder;
  std::optional<mode_t> old_mode;  // of the old file
  int descriptor = -1;
};

UnfinishedFile::UnfinishedFile(const std::filesystem::path& target) : state_(std::make_unique<State>()) {
  state_->target = target;
  state_->folder = target.has_parent_path() ? target.parent_path() : ".";
  struct stat old {};
  if (::stat(target.c_str(), &old) == 0) state_->old_mode = old.st_mode;
  errno = 0;
  state_->descriptor = opened(state_->folder, state_->old_mode ? 0600 : 0666);
}

UnfinishedFile::~UnfinishedFile() {
  remove_unfinished_file();
  has_unfinished_path = false;
  if (state_->descriptor >= 0) ::close(state_->descriptor);
}

int UnfinishedFile::descriptor() const { return state_->descriptor; }

bool UnfinishedFile::take_place() {
  // Without the set-user-ID and set-group-ID bits: the new file has another owner and other bytes.
  if (state_->old_mode && ::fchmod(state_->descriptor, *state_->old_mode & 0777) != 0) return false;
  // A link cannot replace a file, and a file without a name cannot be renamed.
  if (!has_unfinished_path) {
    take_name(state_->folder);
    if (::linkat(AT_FDCWD, path_of_descriptor(state_->descriptor).c_str(), AT_FDCWD, unfinished_path.data(),
                 AT_SYMLINK_FOLLOW) != 0)
      return false;
  }
  if (std::rename(unfinished_path.data(), state_->target.c_str()) != 0) return false;
  has_unfinished_path = false;
  return true;
}

void remove_unfinished_file() noexcept {
  if (has_unfinished_path) ::unlink(unfinished_path.data());
}

}  // namespace broadside::lab::platform
