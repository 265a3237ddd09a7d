// Files written whole or not at all: beside their place, and then renamed.
#include "lab/readers/write_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "lab/readers/format.hpp"

namespace broadside::lab {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

void write_directly(const std::filesystem::path& path, const std::filesystem::path& shown,
                    const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  if (!file) refuse(shown, std::strerror(errno));
  write(file);
  file.close();
  if (!file) refuse(shown, errno != 0 ? std::strerror(errno) : "the stream failed");
}

void write_to_standard_output(const std::function<void(std::ostream&)>& write) {
  errno = 0;
  write(std::cout);
  std::cout.flush();
  if (!std::cout) refuse("standard output", errno != 0 ? std::strerror(errno) : "the stream failed");
}

}  // namespace

void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  if (path == "-") {
    write_to_standard_output(write);
    return;
  }
  std::error_code error;
  // A link is to stay one, and what it points to is to be replaced.
  const std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
  if (error) refuse(path, error.message());
  if (std::filesystem::exists(target, error) && !std::filesystem::is_regular_file(target, error)) {
    write_directly(target, path, write);
    return;
  }
  const std::filesystem::path beside = fmt::format("{}.{}.part", target.string(), getpid());
  try {
    write_directly(beside, path, write);
    std::filesystem::rename(beside, target, error);
    if (error) refuse(path, error.message());
  } catch (...) {
    std::filesystem::remove(beside, error);
    throw;
  }
}

}  // namespace broadside::lab
