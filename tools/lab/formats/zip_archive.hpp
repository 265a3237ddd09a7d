// Zip archives in memory, such as NumPy's .npz files.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct zip;

namespace broadside::lab {

/// The members of a zip archive. Use from one thread at a time.
class ZipArchive {
 public:
  /// Opens an archive; its bytes must outlive this object. Errors call it `name`. Throws FileError.
  ZipArchive(std::string_view bytes, std::string name);

  /// The names of all members, in the archive's order.
  const std::vector<std::string>& members() const noexcept { return members_; }

  /// The content of a member, stored or deflated. Throws FileError, also if its checksum is wrong. Memory: in
  /// proportion to the actual content, not to the size that the archive claims.
  std::string read(std::size_t member) const;

 private:
  [[noreturn]] void refuse(std::string_view found) const;

  std::string name_;
  std::shared_ptr<zip> archive_;
  std::vector<std::string> members_;
};

/// The library that ZipArchive lacks in this build, and how to get it; empty if it works.
std::string zip_missing();

}  // namespace broadside::lab
