// Zip archives in memory; NumPy's .npz files are such.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct zip;

namespace broadside::lab {

/// The members of a zip archive. One thread at a time.
class ZipArchive {
 public:
  /// Opens an archive; its bytes must outlive it. `name` is what errors call it. Throws FileError.
  ZipArchive(std::string_view bytes, std::string name);

  /// The names of all members, in the archive's order.
  const std::vector<std::string>& members() const noexcept { return members_; }

  /// The content of a member, stored or deflated. Throws FileError, also if its checksum is wrong. Memory:
  /// what the member holds, not what the archive claims of it.
  std::string read(std::size_t member) const;

 private:
  [[noreturn]] void refuse(std::string_view found) const;

  std::string name_;
  std::shared_ptr<zip> archive_;
  std::vector<std::string> members_;
};

/// What is missing in this build for ZipArchive and how to get it; empty where it works.
std::string zip_missing();

}  // namespace broadside::lab
