// Unfinished files on Windows, where an open file can be removed if it was opened for that.
#include "lab/platform/unfinished_file.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <random>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <io.h>
#include <windows.h>

namespace broadside::lab::platform {
namespace {

/// The path of the unfinished file. It outlives every UnfinishedFile, because the thread in which Windows
/// reports Ctrl-C may read it at any time.
std::array<wchar_t, 32768> unfinished_path;
std::atomic<bool> has_unfinished_path = false;

void take_name(const std::filesystem::path& folder) {
  std::random_device random;
  const std::string name = fmt::format(".broadside-{:08x}{:08x}.part", random(), random());
  const std::wstring path = (folder / name).wstring();
  const std::size_t length = path.copy(unfinished_path.data(), unfinished_path.size() - 1);
  unfinished_path[length] = L'\0';
  has_unfinished_path = true;
}

int error_number(DWORD error) {
  switch (error) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
      return ENOENT;
    case ERROR_DISK_FULL:
      return ENOSPC;
    case ERROR_FILE_EXISTS:
      return EEXIST;
    default:
      return EACCES;
  }
}

int opened() {
  const HANDLE handle = CreateFileW(unfinished_path.data(), GENERIC_WRITE, FILE_SHARE_DELETE, nullptr,
                                    CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
  if (handle == INVALID_HANDLE_VALUE) {
    has_unfinished_path = false;
    errno = error_number(GetLastError());
    return -1;
  }
  return _open_osfhandle(reinterpret_cast<intptr_t>(handle), _O_WRONLY | _O_BINARY);
}

}  // namespace

struct UnfinishedFile::State {
  std::filesystem::path target;
  int descriptor = -1;

  void close() {
    if (descriptor >= 0) _close(descriptor);
    descriptor = -1;
  }
};

UnfinishedFile::UnfinishedFile(const std::filesystem::path& target) : state_(std::make_unique<State>()) {
  state_->target = target;
  take_name(target.has_parent_path() ? target.parent_path() : ".");
  errno = 0;
  state_->descriptor = opened();
}

UnfinishedFile::~UnfinishedFile() {
  state_->close();
  remove_unfinished_file();
  has_unfinished_path = false;
}

int UnfinishedFile::descriptor() const { return state_->descriptor; }

bool UnfinishedFile::take_place() {
  state_->close();
  if (!MoveFileExW(unfinished_path.data(), state_->target.c_str(), MOVEFILE_REPLACE_EXISTING)) {
    errno = error_number(GetLastError());
    return false;
  }
  has_unfinished_path = false;
  return true;
}

void remove_unfinished_file() noexcept {
  if (has_unfinished_path) DeleteFileW(unfinished_path.data());
}

}  // namespace broadside::lab::platform
