// The list of file formats, and how to read and write files of boxes.
#pragma once

#include <cstdint>
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

/// A file that cannot be read or written. The text gives the file, the place in it if there is one, what was
/// found and what was expected.
class FileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Which rows of a table with minimum > maximum on the first axis are boxes across the date line (from 170 to
/// -170 degrees), whose maximum then becomes 360 more. Others are invalid.
enum class DateLine : std::uint8_t {
  none,
  by_names,  ///< those whose columns have names of longitudes, in a table without frames
  always     ///< all whose bounds are in [-180, 360]
};

/// Options of reading a file. The file and its format supply what is left empty.
struct ReadOptions {
  std::string format{};    ///< the name of a format; empty: found from the file's content and name
  std::string boxes{};     ///< the elements to make boxes of: one of the format's Format::parts
  std::string columns{};   ///< the names of a table's columns, from left to right, separated by commas
  std::string array{};     ///< the array of an .npz file to read; empty: the only one
  std::string ids{};       ///< a table's column or a map's property with the ids, as in --ids; empty: not
                           ///< read
  bool finds_ids = false;  ///< with empty `ids`: reads them if a table has a column `id`
  bool selects_columns = false;  ///< `columns` selects columns of a table that has these names
  int dimension = 0;             ///< 2 or 3; in 2D, a file in 3D is projected along the z axis
  std::optional<Precision> precision{};
  /// If set, invalid boxes are left out (replaced by absent boxes in formats that have these), and this is
  /// called for the first few. Otherwise a file with an invalid box is refused.
  std::function<void(std::string_view why)> say_invalid{};
  Progress progress{};
  DateLine date_line = DateLine::none;
};

/// A kind of element that a file's boxes can be made of, such as "triangles".
struct ElementKind {
  std::string name;
  std::string summary;  ///< one line
};

/// A file format.
struct Format {
  std::string name;
  std::string summary;                  ///< one line
  std::vector<std::string> extensions;  ///< with their dots, in lower case, the usual one first
  std::vector<ElementKind> parts{};     ///< the kinds of elements, the default first; empty: boxes
  bool has_columns = false;             ///< whether ReadOptions::columns applies
  bool has_arrays = false;              ///< whether ReadOptions::array applies
  bool can_skip = false;                ///< whether ReadOptions::say_invalid applies
  bool has_ids = false;                 ///< whether ReadOptions::ids applies
  bool is_seen_flat = false;            ///< in 3D, but also meant to be viewed in 2D

  /// Whether a file with these first bytes (Input::beginning_bytes of them) and this extension is in this
  /// format.
  std::function<bool(std::string_view bytes, std::string_view extension)> recognises;

  /// Opens an input. Options that the format does not have are ignored; so are dimension and precision unless
  /// it has a choice, because the caller converts. Throws FileError. Memory: in proportion to the actual
  /// content, not to what the header claims.
  std::function<AnyFrameReader(std::unique_ptr<Input>, const ReadOptions&)> open{};

  /// Begins a file of boxes of this dimension and precision in a stream, which must outlive the writer; the
  /// caller checks it for errors. Empty if the format can only be read. Throws FileError if the format cannot
  /// hold such boxes; the caller adds the file's name.
  std::function<AnyFrameWriter(std::ostream&, int dimension, Precision precision)> create{};

  bool keeps_ids = false;    ///< whether its writer stores the boxes' ids
  bool keeps_pairs = false;  ///< whether its writer stores an engine's recorded pairs

  std::string missing{};  ///< the missing library and how to get it; empty if files can be read
};

/// All formats, in the order in which files are tested for them. Thread-safe.
std::span<const Format> formats();

/// A file opened for reading, or a scene's boxes in its place.
struct BoxFile {
  std::string name;      ///< for messages
  const Format* format;  ///< the file's format; null for a scene
  AnyFrameReader frames;
};

/// Opens a file of any format; the path "-" is standard input. Throws FileError if the file is in no known
/// format, naming the formats, or if an option does not apply to its format.
BoxFile open_file(const std::filesystem::path& path, const ReadOptions& options = {});

/// Likewise for an input that is already open; its own progress callback is used.
BoxFile open_input(std::unique_ptr<Input> input, const ReadOptions& options = {});

/// The content of a file as the lab's scenes need it: floats in 2D, in 3D, or in both if the format is 3D and
/// also viewed in 2D.
struct FileContent {
  std::optional<History<2>> in_2d;
  std::optional<History<3>> in_3d;
  /// Parts that the reader left out of a damaged file, with their place, and the number of coordinates
  /// rounded to float; empty if there is nothing to report.
  std::string warning{};
};

/// Reads a whole file. Throws what open_file() and its reader throw.
FileContent read_file(const std::filesystem::path& path, const ReadOptions& options = {});

/// The format to write a file in: found from this name or extension or, if `name` is empty, from the path's
/// extension. Throws FileError, which lists the formats that can be written.
const Format& writable_format(const std::filesystem::path& path, std::string_view name = {});

/// Writes a file of frames; the path "-" is standard output. The file is complete or not there, and an old
/// one stays until the new one is complete. Throws FileError. Memory: one frame, unless the format needs all
/// frames first.
void write_frames(AnyFrameReader frames, const std::filesystem::path& path, const Format& format);

/// Writes a history in the format of the path's extension. Otherwise as write_frames().
template <int D, typename Real>
void write_scene(const History<D, Real>& history, const std::filesystem::path& path);

/// Whether `text` means a file's path: it names an existing file, contains a slash, has the extension of a
/// format, or is "-" for standard input.
bool is_path(std::string_view text);

/// A file as a scene. Boxes that are at rest in the file can be set moving; others move as in the file, for
/// as many frames as it has. Throws FileError.
Scene file_scene(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace broadside::lab
