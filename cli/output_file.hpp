// A file that is there whole or not at all: written beside its place and then renamed.
#pragma once

#include <filesystem>
#include <string_view>

namespace broadside::cli {

/// Reserves a temporary file beside `path`; keep() puts it in its place. Until then nothing is there, or what
/// was there before. Where the program ends by a signal the temporary file is removed as well. Only one may
/// exist at a time.
class OutputFile {
 public:
  /// Throws Unusable if a file cannot be made there.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write to for now. Its name ends as the wanted one does.
  const std::filesystem::path& temporary() const noexcept { return temporary_; }

  /// Writes all of the file. Throws Unusable if that fails.
  void write(std::string_view text);

  /// Puts what was written in its place. Throws Unusable if that fails.
  void keep();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

}  // namespace broadside::cli
