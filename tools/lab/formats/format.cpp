// The list of formats, and how a file's format is found.
#include "lab/formats/format.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "broadside/error.hpp"

#include "lab/formats/registry.hpp"
#include "lab/formats/unread_formats.hpp"
#include "lab/formats/write_file.hpp"
#include "src/core/suggestion.hpp"

namespace broadside::lab {
namespace {

bool has_extension(const Format& format, const std::string& extension) {
  return std::ranges::find(format.extensions, extension) != format.extensions.end();
}

/// Whether a user means this format: by its name, or by an extension with or without its dot.
bool is_called(const Format& format, std::string_view name) {
  return format.name == name ||
         has_extension(format, extension_of(fmt::format("file{}{}", name.starts_with('.') ? "" : ".", name)));
}

bool can_be_read(const Format& format) { return bool(format.open) || !format.missing.empty(); }

bool can_be_written(const Format& format) { return bool(format.create); }

/// The formats that `wanted` accepts, for the text of an error.
std::string listed(bool (*wanted)(const Format&)) {
  std::string list;
  for (const Format& format : formats()) {
    if (!wanted(format)) continue;
    list +=
        fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.name, fmt::join(format.extensions, " "));
  }
  return list;
}

/// The suggestion for an unknown format name.
std::string suggested(std::string_view name, bool (*wanted)(const Format&)) {
  std::vector<std::string> known;
  for (const Format& format : formats()) {
    if (wanted(format)) known.push_back(format.name);
  }
  return core::did_you_mean(name, known);
}

/// The format found from a file's first bytes and extension; null if none matches.
const Format* format_of(std::string_view begin, const std::string& extension) {
  const auto find = [begin](std::string_view name) -> const Format* {
    const auto format = std::ranges::find_if(
        formats(), [&](const Format& candidate) { return candidate.recognises(begin, name); });
    return format == formats().end() ? nullptr : &*format;
  };
  const Format* const named = find(extension);
  if (named == nullptr || named->recognises(begin, "")) return named;
  const Format* const told = find("");
  return told != nullptr ? told : named;
}

bool is_text(std::string_view bytes) {
  return std::ranges::none_of(
      bytes, [](char c) { return c >= 0 && c < ' ' && c != '\t' && c != '\r' && c != '\n'; });
}

/// Throws FileError, naming a converter, if the input's format is recognised but unsupported. Recognises it
/// by extension, else by its first bytes.
void refuse_unread(Input& input, std::string_view extension) {
  const std::string_view file = input.path().empty() ? "FILE" : std::string_view(input.name());
  const std::string found = unread_format(input.beginning(), extension, file);
  if (!found.empty()) throw FileError(fmt::format("{}: {}", input.name(), found));
}

const Format& readable_format(Input& input, const ReadOptions& options) {
  const std::string_view name = options.format;
  const std::string_view begin = input.beginning();
  if (begin.starts_with("\xFF\xFE") || begin.starts_with("\xFE\xFF"))
    throw FileError(fmt::format("{}: begins as text in UTF-16; expected UTF-8", input.name()));
  if (begin.size() == Input::beginning_bytes && std::ranges::all_of(begin, [](char c) { return c == 0; }))
    throw FileError(fmt::format("{}: begins with {} zero bytes, as no format does; expected boxes",
                                input.name(), begin.size()));
  const auto wanted =
      std::ranges::find_if(formats(), [&](const Format& format) { return is_called(format, name); });
  if (name.empty()) refuse_unread(input, "");
  const Format* const format = name.empty()                ? format_of(begin, input.extension())
                               : wanted == formats().end() ? nullptr
                                                           : &*wanted;
  if (format != nullptr && format->missing.empty()) return *format;
  if (format != nullptr && name.empty()) refuse_unread(input, input.extension());
  if (format != nullptr) throw FileError(fmt::format("{}: {}", input.name(), format->missing));
  if (!name.empty()) {
    refuse_unread(input, fmt::format(".{}", name));
    throw FileError(fmt::format("{}: unknown format '{}'{}; expected one of: {}", input.name(), name,
                                suggested(name, can_be_read), listed(can_be_read)));
  }
  if (begin.empty()) throw FileError(fmt::format("{}: is empty; expected boxes", input.name()));
  if (!input.extension().empty()) refuse_unread(input, input.extension());
  // If the user names columns, the file is a table.
  const auto table = std::ranges::find_if(formats(), &Format::has_columns);
  if (!options.columns.empty() && table != formats().end()) return *table;
  throw FileError(fmt::format("{}: is in no format known here; expected one of: {}{}", input.name(),
                              listed(can_be_read),
                              is_text(begin) ? "; if it is a table with other names of columns, --format csv "
                                               "says which are known and --columns gives them"
                                             : ""));
}

/// Throws FileError if an option does not apply to the format.
void check_options(const Format& format, const std::string& name, const ReadOptions& options) {
  if (!options.columns.empty() && !format.has_columns)
    throw FileError(fmt::format("{}: is in format {}, which has no columns to name; expected a table", name,
                                format.name));
  if (!options.array.empty() && !format.has_arrays)
    throw FileError(fmt::format("{}: is in format {}, which has no array '{}'; expected an .npz file", name,
                                format.name, options.array));
  if (!options.ids.empty() && !format.has_ids)
    throw FileError(
        fmt::format("{}: is in format {}, which has no ids such as '{}'; expected a table or a map", name,
                    format.name, options.ids));
  if (options.say_invalid && !format.can_skip)
    throw FileError(
        fmt::format("{}: is in format {}, where --skip-invalid can leave nothing out; expected "
                    "a table or a map",
                    name, format.name));
  if (options.boxes.empty() ||
      std::ranges::find(format.parts, options.boxes, &ElementKind::name) != format.parts.end())
    return;
  std::vector<std::string> known;
  for (const ElementKind& part : format.parts) known.push_back(part.name);
  throw FileError(fmt::format("{}: boxes of '{}'{} in format {}; expected {}", name, options.boxes,
                              core::did_you_mean(options.boxes, known), format.name,
                              known.empty() ? "none to be asked for: it holds boxes"
                                            : fmt::format("one of: {}", fmt::join(known, ", "))));
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
      readers::trace(), readers::csv(), readers::npy(), readers::npz(), readers::map(), readers::mesh(),
  };
  return list;
}

BoxFile open_file(const std::filesystem::path& path, const ReadOptions& options) {
  return open_input(std::make_unique<Input>(path, options.progress), options);
}

BoxFile open_input(std::unique_ptr<Input> input, const ReadOptions& options) {
  const Format& format = readable_format(*input, options);
  std::string name = input->name();
  check_options(format, name, options);
  AnyFrameReader frames = format.open(std::move(input), options);
  if (options.dimension == 3 && dimension_of(frames) == 2)
    throw FileError(fmt::format("{}: holds boxes in 2D; expected boxes in 3D", name));
  if (options.dimension == 2) frames = flattened(std::move(frames), name);
  if (options.precision) frames = with_precision(std::move(frames), *options.precision, name);
  return {std::move(name), &format, std::move(frames)};
}

FileContent read_file(const std::filesystem::path& path, const ReadOptions& options) {
  ReadOptions exact = options;
  exact.precision.reset();
  BoxFile file = open_file(path, exact);
  FileContent content;
  const auto read = [&content]<int D>(FrameReader<D, float>& frames) {
    if constexpr (D == 2)
      content.in_2d = read_all(frames);
    else
      content.in_3d = read_all(frames);
  };
  Rounding rounding;
  const bool has_pairs = has_recorded_pairs(file.frames);
  const auto read_any = [&]<int D, typename Real>(std::unique_ptr<FrameReader<D, Real>>& frames) {
    if constexpr (std::is_same_v<Real, float>) {
      read(*frames);
      content.warning = frames->warning();
    } else {
      History<D, Real> history = read_all(*frames);
      content.warning = frames->warning();
      rounding.count(std::span<const Box<D, Real>>(history.boxes));
      for (const Step<D, Real>& step : history.steps)
        rounding.count(std::span<const Box<D, Real>>(step.boxes));
      AnyFrameReader rounded =
          with_precision(std::make_unique<HistoryReader<D, Real>>(std::move(history)), Precision::float32);
      read(*std::get<std::unique_ptr<FrameReader<D, float>>>(rounded));
    }
  };
  std::visit(read_any, file.frames);
  if (rounding.rounded > 0)
    content.warning +=
        fmt::format("{}{}: {}, in which scenes are compared; `pairs` and `verify` take them exactly",
                    content.warning.empty() ? "" : "\n", file.name, rounding.text());
  if (has_pairs)
    content.warning += fmt::format(
        "{}{}: left out the recorded pairs, which scenes do not have; `verify` and `convert` take them",
        content.warning.empty() ? "" : "\n", file.name);
  if (content.in_3d && file.format->is_seen_flat && options.dimension == 0) {
    AnyFrameReader flat = flattened(std::make_unique<HistoryReader<3, float>>(*content.in_3d));
    read(*std::get<std::unique_ptr<FrameReader<2, float>>>(flat));
  }
  return content;
}

const Format& writable_format(const std::filesystem::path& path, std::string_view name) {
  // Output is never compressed.
  const std::string compression = compression_extension_of(path);
  const std::string extension = compression.empty() ? extension_of(path) : compression;
  for (const Format& format : formats()) {
    if (!can_be_written(format)) continue;
    if (name.empty() ? has_extension(format, extension) : is_called(format, name)) return format;
  }
  if (name.empty() && path == "-")
    throw FileError(
        fmt::format("standard output has no extension that says its format; expected --to FORMAT, "
                    "one of: {}",
                    listed(can_be_written)));
  const std::string found = name.empty()
                                ? fmt::format("extension '{}' is of no format", extension)
                                : fmt::format("'{}'{} is no format", name, suggested(name, can_be_written));
  throw FileError(fmt::format("{}: {} that can be written; expected one of: {}", path.string(), found,
                              listed(can_be_written)));
}

void write_frames(AnyFrameReader frames, const std::filesystem::path& path, const Format& format) {
  const int dimension = dimension_of(frames);
  const Precision precision = precision_of_frames(frames);
  // The reader's errors name the input file; errors about the output format name the output file.
  const auto written = [&](const auto& write) {
    try {
      write();
    } catch (const FileError& error) {
      throw FileError(fmt::format("{}: {}", path.string(), error.what()));
    }
  };
  const auto copy = [&]<int D, typename Real>(FrameReader<D, Real>& reader, std::ostream& stream) {
    std::unique_ptr<FrameWriter<D, Real>> writer;
    written([&] {
      writer = std::get<std::unique_ptr<FrameWriter<D, Real>>>(format.create(stream, dimension, precision));
    });
    const std::shared_ptr<const BoxLabels> labels = reader.labels();
    if (labels && labels->has_ids && format.keeps_ids) writer->use_ids(labels->ids);
    if (reader.recorded() != nullptr && format.keeps_pairs) writer->use_recorded(*reader.recorded());
    const std::vector<Box<D, Real>> boxes = reader.first();
    written([&] { writer->first(boxes); });
    for (Step<D, Real> step; reader.next(step);) written([&] { writer->next(step); });
    written([&] { writer->finish(); });
  };
  write_file(path, [&](std::ostream& stream) {
    std::visit([&](const auto& reader) { copy(*reader, stream); }, frames);
  });
}

template <int D, typename Real>
void write_scene(const History<D, Real>& history, const std::filesystem::path& path) {
  write_frames(std::make_unique<HistoryReader<D, Real>>(history), path, writable_format(path));
}

template void write_scene(const History<2>&, const std::filesystem::path&);
template void write_scene(const History<3>&, const std::filesystem::path&);
template void write_scene(const History<2, double>&, const std::filesystem::path&);
template void write_scene(const History<3, double>&, const std::filesystem::path&);

bool is_path(std::string_view text) {
  const std::filesystem::path path(text);
  std::error_code ignored;
  const std::filesystem::file_type type = std::filesystem::status(path, ignored).type();
  return text == "-" || type == std::filesystem::file_type::regular ||
         type == std::filesystem::file_type::fifo || text.find('/') != std::string_view::npos ||
         std::ranges::any_of(formats(),
                             [&](const Format& format) { return has_extension(format, extension_of(path)); });
}

Scene file_scene(const std::filesystem::path& path, const ReadOptions& options) {
  FileContent content = read_file(path, options);
  Scene scene{.name = path.string(),
              .summary = "boxes of a file",
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
