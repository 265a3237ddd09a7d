// The list of file formats: from a file to frames of boxes and back.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "lab/formats/frames.hpp"
#include "lab/formats/input.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// A file that cannot be read or written. The text names it, the place in it where there is one, what was
/// found and what was expected.
class FileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How to read a file. The file and its format decide what is left empty.
struct ReadOptions {
  std::string format{};    ///< the name of a format; empty: told by the file's content and name
  std::string boxes{};     ///< what to make boxes of: one of the format's Format::parts
  std::string columns{};   ///< the names of a table's columns, from left to right, with commas between
  std::string array{};     ///< of an .npz file, the array to read; empty: the only one
  std::string ids{};       ///< a table's column or a map's property of ids, as --ids; empty: not read
  bool finds_ids = false;  ///< without `ids`: read them where a table has a column `id`
  int dimension = 0;       ///< 2 or 3; a file in 3D is seen along the z axis in 2D
  std::optional<Precision> precision{};
  /// If set, invalid boxes are left out (as absent boxes where the format has them), and it is called for the
  /// first of them; otherwise a file with an invalid box is refused.
  std::function<void(std::string_view why)> say_invalid{};
  Progress progress{};
};

/// What the boxes of a file can be: "triangles", say.
struct ElementKind {
  std::string name;
  std::string summary;  ///< one line
};

/// A file format, described.
struct Format {
  std::string name;
  std::string summary;                  ///< one line
  std::vector<std::string> extensions;  ///< with their dots, in lower case; the first is the usual one
  std::vector<ElementKind> parts{};     ///< what the boxes can be, the standard first; empty: boxes
  bool has_columns = false;             ///< whether ReadOptions::columns applies
  bool has_arrays = false;              ///< whether ReadOptions::array applies
  bool can_skip = false;                ///< whether ReadOptions::say_invalid applies
  bool has_ids = false;                 ///< whether ReadOptions::ids applies
  bool is_seen_flat = false;            ///< 3D, but made to be looked at in 2D as well

  /// Whether a file that begins with these bytes (Input::beginning_bytes of them) and has this extension is
  /// of this format.
  std::function<bool(std::string_view bytes, std::string_view extension)> recognises;

  /// Opens an input. Only the options that the format has apply; dimension and precision only where it has a
  /// choice: the caller converts. Throws FileError. Memory for what the file holds, not for what its header
  /// claims.
  std::function<AnyFrameReader(std::unique_ptr<Input>, const ReadOptions&)> open{};

  /// Begins a file of boxes of this dimension and precision in a stream, which outlives the writer and is
  /// checked by the caller; empty where the format is only read. Throws FileError if the format cannot hold
  /// such boxes; the caller adds the file's name.
  std::function<AnyFrameWriter(std::ostream&, int dimension, Precision precision)> create{};

  bool keeps_ids = false;    ///< whether what it makes writes the boxes' ids
  bool keeps_pairs = false;  ///< whether it writes the pairs that an engine reported

  std::string missing{};  ///< the missing library and how to get it; empty where files can be read
};

/// All formats, in the order in which files are tested for them. Thread-safe.
std::span<const Format> formats();

/// A file opened for reading, or a scene's boxes in its stead.
struct BoxFile {
  std::string name;      ///< what to call it
  const Format* format;  ///< the one it is in; null for a scene
  AnyFrameReader frames;
};

/// Opens a file of any format, or standard input where the path is "-". Throws FileError, naming the formats
/// if the file is in none of them, and if an option does not apply to its format.
BoxFile open_file(const std::filesystem::path& path, const ReadOptions& options = {});

/// Likewise an input that is open already; its own progress counts.
BoxFile open_input(std::unique_ptr<Input> input, const ReadOptions& options = {});

/// What a file holds, as the lab's scenes need it: floats, in 2D, in 3D, or in both where 3D is made to be
/// seen flat.
struct FileContent {
  std::optional<History<2>> in_2d;
  std::optional<History<3>> in_3d;
  /// What the reader had to leave out of a damaged file, and where, and how many coordinates were rounded to
  /// float; empty where there is nothing to say.
  std::string warning{};
};

/// Reads a file whole. Throws as open_file and its reader do.
FileContent read_file(const std::filesystem::path& path, const ReadOptions& options = {});

/// The format in which a file is written: that of this name or extension, or, where `name` is empty, that of
/// the path's extension. Throws FileError naming the formats that can be written.
const Format& writable_format(const std::filesystem::path& path, std::string_view name = {});

/// Writes a file of frames, or to standard output where the path is "-". The file is whole or not there, and
/// an old one stays until the new one is whole. Throws FileError. Memory: that of a frame, unless the format
/// must know all frames first.
void write_frames(AnyFrameReader frames, const std::filesystem::path& path, const Format& format);

/// Writes a history in the format that the path's extension says. Otherwise as write_frames.
template <int D, typename Real>
void write_scene(const History<D, Real>& history, const std::filesystem::path& path);

/// Whether `text` is meant as a file's path: it names a file, has a slash or the extension of a format, or is
/// "-", which stands for standard input.
bool is_path(std::string_view text);

/// A file as a scene of its own. Boxes that do not move in the file can be set moving; others move as they do
/// there, for as many frames as the file has. Throws FileError.
Scene file_scene(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace broadside::lab
