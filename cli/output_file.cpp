// A file that is there whole or not at all.
#include "cli/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "cli/interruption.hpp"
#include "cli/unusable.hpp"

namespace broadside::cli {

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  const std::string name = path_.filename().string();
  if (name.empty() || std::filesystem::is_directory(path_))
    throw Unusable("cannot write '" + path_.string() + "': a folder; expected a file's name");
  temporary_ = path_;
  temporary_.replace_filename("." + std::to_string(getpid()) + ".part." + name);
  remove_on_signal(temporary_);
  write("");
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  remove_on_signal({});
}

void OutputFile::write(std::string_view text) {
  errno = 0;
  std::ofstream file(temporary_, std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file)
    throw Unusable("cannot write '" + path_.string() + "': " + std::strerror(errno) +
                   "; expected a place where a file can be made");
}

void OutputFile::keep() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) throw Unusable("cannot write '" + path_.string() + "': " + error.message());
}

}  // namespace broadside::cli
