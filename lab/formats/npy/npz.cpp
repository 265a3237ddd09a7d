// NumPy's .npz: arrays by name, each an .npy file in a zip archive, as numpy.savez and numpy.savez_compressed
// write them.
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/descriptions.hpp"
#include "lab/formats/text.hpp"
#include "lab/formats/zip_archive.hpp"

namespace broadside::lab::readers {
namespace {

constexpr std::string_view array_suffix = ".npy";
constexpr std::string_view zip_magic = "PK\x03\x04";

struct Array {
  std::string name;
  std::size_t member;
};

std::vector<Array> arrays_of(const ZipArchive& archive) {
  std::vector<Array> arrays;
  for (std::size_t i = 0; i < archive.members().size(); ++i) {
    const std::string& member = archive.members()[i];
    if (member.ends_with(array_suffix))
      arrays.push_back({member.substr(0, member.size() - array_suffix.size()), i});
  }
  return arrays;
}

/// The array of this name or, where that is empty, the only one.
const Array& choose(const std::vector<Array>& arrays, const std::string& wanted, const std::string& file) {
  if (arrays.empty()) throw FileError(fmt::format("{}: holds no array; expected one", file));
  if (wanted.empty() && arrays.size() == 1) return arrays.front();
  const auto found = std::ranges::find(arrays, wanted, &Array::name);
  if (!wanted.empty() && found != arrays.end()) return *found;
  std::string names;
  for (const Array& array : arrays) names += (names.empty() ? "" : ", ") + shown(array.name);
  if (wanted.empty())
    throw FileError(fmt::format("{}: holds {} arrays, {}; expected --array NAME, which says the one to read",
                                file, arrays.size(), names));
  throw FileError(fmt::format("{}: holds no array {}; expected one of: {}", file, shown(wanted), names));
}

AnyFrameReader open_npz(std::unique_ptr<Input> input, const ReadOptions& options) {
  if (input->bytes().empty())
    throw FileError(fmt::format("{}: is empty; expected an .npz file", input->name()));
  const ZipArchive archive(input->bytes(), input->name());
  const std::vector<Array> arrays = arrays_of(archive);
  const Array& array = choose(arrays, options.array, input->name());
  return npy().open(Input::keeping(fmt::format("{}: array {}", input->name(), shown(array.name)),
                                   archive.read(array.member)),
                    options);
}

/// Whether these are the first bytes of an archive whose first member is an array.
bool is_npz(std::string_view bytes, std::string_view extension) {
  if (extension == ".npz") return true;
  constexpr std::size_t name_size_at = 26;
  constexpr std::size_t name_at = 30;
  if (!bytes.starts_with(zip_magic) || bytes.size() < name_at) return false;
  const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(bytes[i])}; };
  const std::size_t size = byte(name_size_at) | byte(name_size_at + 1) << 8;
  return bytes.size() >= name_at + size && bytes.substr(name_at, size).ends_with(array_suffix);
}

}  // namespace

Format npz() {
  return {
      .name = "npz",
      .summary = "boxes as one of the arrays of a NumPy .npz file",
      .extensions = {".npz"},
      .has_arrays = true,
      .recognises = is_npz,
      .open = open_npz,
      .missing = zip_missing(),
  };
}

}  // namespace broadside::lab::readers
