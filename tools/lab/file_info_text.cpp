// Statistics of a file of boxes, as text.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/file_info.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"

namespace broadside::lab {
namespace {

/// The shortest decimal that reads back as exactly this coordinate, in the file's precision.
std::string exact(double coordinate, Precision precision) {
  // Turns -0 into 0.
  coordinate += 0.0;
  return precision == Precision::float32 ? fmt::format("{}", static_cast<float>(coordinate))
                                         : fmt::format("{}", coordinate);
}

/// Four significant digits, or all digits before the point.
std::string shortened(double extent) {
  return extent >= 1e4 && extent < 1e15 ? fmt::format("{:.0f}", extent) : fmt::format("{:.4g}", extent);
}

std::string axes_text(const FileInfo& info) {
  AlignedColumns table("<>>>>>>>>>");
  table.add({"axis", "from", "to", "extent min", "1 %", "25 %", "50 %", "75 %", "99 %", "max"});
  constexpr std::string_view names = "xyz";
  for (std::size_t axis = 0; axis < info.axes.size(); ++axis) {
    const AxisInfo& along = info.axes[axis];
    const bool is_there = along.min <= along.max;
    std::vector<std::string> row = {std::string(1, names[axis]),
                                    is_there ? exact(along.min, info.precision) : "-",
                                    is_there ? exact(along.max, info.precision) : "-"};
    for (const double extent : along.extents) row.push_back(info.present > 0 ? shortened(extent) : "-");
    table.add(std::move(row));
  }
  return table.text("  ");
}

/// One line for each power of two; beyond max_lines, the first line has all smaller sizes.
std::string sizes_text(const FileInfo& info) {
  if (info.sizes.empty()) return {};
  constexpr std::size_t max_lines = 16;
  constexpr double longest_bar = 40;
  std::vector<SizeBin> bins = info.sizes;
  const bool is_merged = bins.size() > max_lines;
  while (bins.size() > max_lines) {
    bins[1].boxes += bins[0].boxes;
    bins.erase(bins.begin());
  }
  const auto max_boxes = static_cast<double>(std::ranges::max(bins, {}, &SizeBin::boxes).boxes);
  AlignedColumns table(">><");
  table.add({"longest side", "boxes", ""});
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double from = std::ldexp(1, bins[i].exponent);
    const std::string range = i == 0 && is_merged ? fmt::format("below {:.4g}", 2 * from)
                                                  : fmt::format("{:.4g} to {:.4g}", from, 2 * from);
    const double bar = std::ceil(longest_bar * static_cast<double>(bins[i].boxes) / max_boxes);
    table.add({range, grouped(bins[i].boxes), std::string(static_cast<std::size_t>(bar), '#')});
  }
  std::string text = table.text("  ");
  if (info.points > 0) text += fmt::format("  {} left out\n", counted(info.points, "point", "points"));
  if (info.infinite > 0)
    text += fmt::format("  {} left out\n", counted(info.infinite, "infinite box", "infinite boxes"));
  return text;
}

std::string motion_text(const FileInfo& info) {
  if (info.frames < 2) return {};
  return fmt::format(
      "  {} after the first: in a frame, {:.3g} % of the boxes move (median; {:.3g} % to {:.3g} %); "
      "in all, {} added, {} removed\n",
      counted(info.frames - 1, "frame", "frames"), 100 * info.moving[1], 100 * info.moving[0],
      100 * info.moving[2], grouped(info.added), grouped(info.removed));
}

std::string pairs_text(const FileInfo& info) {
  if (!info.pairs) return {};
  const RecordedPairsInfo& pairs = *info.pairs;
  std::string text =
      fmt::format("  recorded pairs, margin {:g}: {} in a frame (median; {} to {})", pairs.margin,
                  grouped(pairs.reported[1]), grouped(pairs.reported[0]), grouped(pairs.reported[2]));
  if (info.frames > 1)
    text += fmt::format("; in all, {} begun, {} ended", grouped(pairs.begun), grouped(pairs.ended));
  if (pairs.filters > 0) text += fmt::format("; {}", counted(pairs.filters, "filter", "filters"));
  if (pairs.ignored > 0) text += fmt::format("; up to {} ignored", grouped(pairs.ignored));
  return text + '\n';
}

/// "all", "none" or "7".
std::string share(std::uint64_t some, std::uint64_t all) {
  return some == all ? "all" : some == 0 ? "none" : grouped(some);
}

std::string coordinates_text(const FileInfo& info) {
  if (info.coordinates == 0) return {};
  std::string text = fmt::format("  {}: {} whole", counted(info.coordinates, "coordinate", "coordinates"),
                                 share(info.whole, info.coordinates));
  if (info.precision == Precision::float64) {
    text += fmt::format(", {} exactly floats", share(info.exactly_floats, info.coordinates));
    if (info.exactly_floats < info.coordinates) text += " (--precision float rounds the others)";
  }
  return text + '\n';
}

/// Counts the boxes without a size or with an infinite size; empty if there are none.
std::string kinds_text(const FileInfo& info) {
  std::string text;
  const auto add = [&text](std::uint64_t count, const std::string& what) {
    if (count > 0) text += (text.empty() ? "  " : ", ") + what;
  };
  add(info.points, counted(info.points, "point", "points"));
  add(info.flat, grouped(info.flat) + " flat (without extent on some axis, but not on all)");
  add(info.infinite, grouped(info.infinite) + " infinite");
  return text.empty() ? text : text + '\n';
}

std::string reading_text(const FileInfo& info) {
  if (info.format.empty()) return "";
  const auto size = static_cast<double>(info.bytes);
  // Below this size, the measured time is that of opening the file, not of reading it.
  constexpr std::uint64_t min_bytes = 1'000'000;
  constexpr std::uint64_t min_boxes = 50'000;
  if (info.bytes > 0 ? info.bytes < min_bytes : info.boxes < min_boxes)
    return fmt::format("  read in {}{}\n", duration(info.seconds), info.bytes > 0 ? ": " + bytes(size) : "");
  const double seconds = std::max(info.seconds, 1e-9);
  const double boxes_per_second = static_cast<double>(info.boxes) / seconds;
  std::string text = fmt::format("  read in {}: ", duration(info.seconds));
  if (info.bytes > 0) text += fmt::format("{}, {} a second, ", bytes(size), bytes(size / seconds));
  return text + fmt::format("{} boxes a second\n", whole(boxes_per_second));
}

}  // namespace

std::string text_of(const FileInfo& info) {
  const std::string absent = info.absent > 0 ? fmt::format(", {} of them absent,", grouped(info.absent)) : "";
  std::string text =
      fmt::format("{}: {}, {}{} in {}D, {}, {}\n", info.file, info.format.empty() ? "scene" : info.format,
                  counted(info.present + info.absent, "box", "boxes"), absent, info.dimension,
                  precision_text(info.precision, info.importer), counted(info.frames, "frame", "frames"));
  text += motion_text(info);
  text += pairs_text(info);
  text += coordinates_text(info);
  text += kinds_text(info);
  text += reading_text(info) + '\n' + axes_text(info);
  const std::string sizes = sizes_text(info);
  return sizes.empty() ? text : text + '\n' + sizes;
}

}  // namespace broadside::lab
