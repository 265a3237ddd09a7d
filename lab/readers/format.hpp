// The formats of files that people have, and the one list of them: from a file to histories and back.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// A file that cannot be read or written. The text names it, the place in it where there is one, what was
/// found and what was expected.
class FileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a file holds: boxes in 2D, in 3D, or in both, one a view of the other.
struct FileContent {
  std::optional<History<2>> in_2d;
  std::optional<History<3>> in_3d;
  std::string warning{};  ///< what the reader had to leave out of a damaged file, and where; empty otherwise
};

/// A file format, described.
struct Format {
  std::string name;
  std::string summary;                  ///< one line
  std::vector<std::string> extensions;  ///< with their dots, in lower case; the first is the usual one

  /// Whether a file that begins with these (up to 512) bytes and has this extension is of this format.
  std::function<bool(std::string_view bytes, std::string_view extension)> recognises;

  /// Reads a file. Throws FileError. Memory for what the file holds, not for what its header claims.
  std::function<FileContent(const std::filesystem::path&)> read{};

  /// Appends to a stream, which is checked by the caller; empty where the format is only read. Throws
  /// FileError if the format cannot hold the history.
  std::function<void(const History<2>&, std::ostream&)> write_2d{};
  std::function<void(const History<3>&, std::ostream&)> write_3d{};

  std::string missing{};  ///< what is not there and how to get it, where files cannot be read for that reason
};

/// All formats, in the order in which they are asked whether a file is theirs. Thread-safe.
std::span<const Format> formats();

/// Reads a file in whatever format it is. Throws FileError, naming the formats there are if it is in none.
FileContent read_file(const std::filesystem::path& path);

/// Writes a history in the format that the path's extension says. The file is whole or not there, and an old
/// one stays until the new one is whole. Throws FileError.
template <int D>
void write_scene(const History<D>& history, const std::filesystem::path& path);

/// Whether `text` is meant as a file's path: it names a file, or has a slash or the extension of a format.
bool is_path(std::string_view text);

/// A file as a scene of its own. Boxes that do not move in the file can be set moving; others move as they do
/// there, for as many frames as the file has. Throws FileError.
Scene file_scene(const std::filesystem::path& path);

}  // namespace broadside::lab
