// The one list of formats, and how a path finds its own.
#include "lab/readers/format.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "lab/readers/descriptions.hpp"
#include "lab/readers/write_file.hpp"

namespace broadside::lab {
namespace {

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool has_extension(const Format& format, const std::string& extension) {
  return std::ranges::find(format.extensions, extension) != format.extensions.end();
}

/// The formats that `wanted` picks, for an error's text.
template <typename Wanted>
std::string listed(Wanted wanted) {
  std::string list;
  for (const Format& format : formats()) {
    if (!wanted(format)) continue;
    list +=
        fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.name, fmt::join(format.extensions, " "));
  }
  return list;
}

const Format& format_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 512> bytes;
  // A folder can be opened, but not read.
  if (!file || (file.read(bytes.data(), bytes.size()), file.bad()))
    throw FileError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  const std::string_view begin(bytes.data(), static_cast<std::size_t>(file.gcount()));
  for (const Format& format : formats()) {
    if (!format.recognises(begin, extension_of(path))) continue;
    if (format.missing.empty()) return format;
    throw FileError(fmt::format("{}: {}", path.string(), format.missing));
  }
  throw FileError(fmt::format("{}: is in no format known here; expected one of: {}", path.string(),
                              listed([](const Format&) { return true; })));
}

template <int D>
void describe(std::optional<History<D>> history, MakeBoxes<D>& boxes, MakeHistory<D>& moving) {
  if (!history) return;
  const auto shared = std::make_shared<const History<D>>(*std::move(history));
  if (shared->steps.empty()) {
    boxes = [shared](const Settings&, std::size_t, std::uint64_t) { return shared->boxes; };
    return;
  }
  moving = [shared](const Settings&, const SceneRequest& request) {
    const auto frames = static_cast<std::ptrdiff_t>(std::min(request.frames, shared->steps.size()));
    return History<D>{shared->boxes, {shared->steps.begin(), shared->steps.begin() + frames}};
  };
}

}  // namespace

std::span<const Format> formats() {
  static const std::array list = {
      readers::trace(),
      readers::csv(),
      readers::broadmark(),
      readers::mesh(),
  };
  return list;
}

FileContent read_file(const std::filesystem::path& path) { return format_of(path).read(path); }

template <int D>
void write_scene(const History<D>& history, const std::filesystem::path& path) {
  const auto writer = [](const Format& format) {
    if constexpr (D == 2)
      return format.write_2d;
    else
      return format.write_3d;
  };
  const auto found = std::ranges::find_if(formats(), [&](const Format& format) {
    return writer(format) && has_extension(format, extension_of(path));
  });
  if (found == formats().end()) {
    throw FileError(fmt::format("{}: extension '{}' is of no format that can be written; expected one of: {}",
                                path.string(), extension_of(path), listed(writer)));
  }
  write_file(path, [&](std::ostream& stream) {
    try {
      writer (*found)(history, stream);
    } catch (const FileError& error) {
      throw FileError(fmt::format("{}: {}", path.string(), error.what()));
    }
  });
}

template void write_scene(const History<2>&, const std::filesystem::path&);
template void write_scene(const History<3>&, const std::filesystem::path&);

bool is_path(std::string_view text) {
  const std::filesystem::path path(text);
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) || text.find('/') != std::string_view::npos ||
         std::ranges::any_of(formats(),
                             [&](const Format& format) { return has_extension(format, extension_of(path)); });
}

Scene file_scene(const std::filesystem::path& path) {
  const Format& format = format_of(path);
  FileContent content = format.read(path);
  Scene scene{.name = path.string(),
              .summary = format.summary,
              .source = path.string(),
              .kind = SceneKind::file,
              .fixed_count = true,
              .fixed_seed = true,
              .warning = std::move(content.warning)};
  describe<2>(std::move(content.in_2d), scene.boxes_2d, scene.history_2d);
  describe<3>(std::move(content.in_3d), scene.boxes_3d, scene.history_3d);
  return scene;
}

}  // namespace broadside::lab
