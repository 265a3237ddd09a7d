// Boxes as text: comma-separated values, one line a box, or one line a box that changes in a frame.
//
// With columns frame and box, frame 0 lists every box in order, and a later frame those that change; a box
// one beyond the last is new. Empty coordinates, or min = inf and max = -inf, stand for an absent box, and a
// line with nothing but a frame for a frame in which nothing changes.
#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <ostream>
#include <utility>

#include <fmt/format.h>

#include "lab/readers/descriptions.hpp"

namespace broadside::lab::readers {
namespace {

template <int D>
constexpr std::array<std::string_view, 2 + 2 * D> columns() {
  if constexpr (D == 2)
    return {"frame", "box", "min_x", "min_y", "max_x", "max_y"};
  else
    return {"frame", "box", "min_x", "min_y", "min_z", "max_x", "max_y", "max_z"};
}

/// The first line of a file with columns frame and box, or without them.
template <int D>
std::string header(bool has_frames) {
  const auto names = columns<D>();
  return fmt::format("{}", fmt::join(std::span(names).subspan(has_frames ? 0 : 2), ","));
}

/// A file's lines, one after the other.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& path) : path_(path) {
    std::ifstream file(path, std::ios::binary);
    text_.assign(std::istreambuf_iterator<char>(file), {});
    if (file.bad() || !file.is_open()) throw FileError(path.string() + ": cannot be read");
    rest_ = text_;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
    // Editors leave empty lines at the end; they say nothing.
    while (rest_.ends_with('\n') || rest_.ends_with('\r')) rest_.remove_suffix(1);
  }

  /// Whether there was another line; line() is then that one, without its end.
  bool next() {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    ++number_;
    return true;
  }

  std::string_view line() const noexcept { return line_; }

  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw FileError(fmt::format("{}:{}: {}; expected {}", path_.string(), number_, found, expected));
  }

 private:
  std::filesystem::path path_;
  std::string text_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
};

/// One line, split at its commas.
template <int D>
class Row {
 public:
  Row(const Lines& lines, bool has_frames) : lines_(lines), first_(has_frames ? 0 : 2) {
    std::size_t count = 0;
    std::string_view rest = lines.line();
    for (bool more = true; more; ++count) {
      const std::size_t comma = rest.find(',');
      more = comma != std::string_view::npos;
      if (first_ + count < fields_.size()) fields_[first_ + count] = rest.substr(0, comma);
      rest.remove_prefix(more ? comma + 1 : rest.size());
    }
    if (first_ + count != fields_.size())
      lines.refuse(fmt::format("{} columns", count),
                   fmt::format("the {} columns {}", fields_.size() - first_, header<D>(has_frames)));
  }

  bool has_box() const {
    return std::ranges::any_of(std::span(fields_).subspan(1),
                               [](std::string_view field) { return !field.empty(); });
  }

  std::size_t whole_number(std::size_t column) const {
    std::uint32_t value = 0;
    if (!parse(fields_[column], value)) refuse(column, "a whole number from 0 to 4294967295");
    return value;
  }

  Box<D> box() const {
    if (std::ranges::all_of(std::span(fields_).subspan(2),
                            [](std::string_view field) { return field.empty(); }))
      return absent_box<D>();
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = number(2 + axis);
      box.max[axis] = number(2 + D + axis);
    }
    if (!is_present(box) && !is_absent(box))
      lines_.refuse(fmt::format("min ({}) and max ({})", fmt::join(box.min, ", "), fmt::join(box.max, ", ")),
                    "min <= max on every axis, or no coordinates for an absent box");
    return box;
  }

  [[noreturn]] void refuse(std::size_t column, const std::string& expected) const {
    lines_.refuse(fmt::format("column {} is '{}'", columns<D>()[column], fields_[column]), expected);
  }

 private:
  template <typename Number>
  static bool parse(std::string_view text, Number& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  }

  float number(std::size_t column) const {
    float value = 0;
    // A NaN is no number, and nothing equals it.
    if (!parse(fields_[column], value) || value != value) refuse(column, "a number that a float can hold");
    return value;
  }

  const Lines& lines_;
  std::size_t first_;
  std::array<std::string_view, 2 + 2 * D> fields_;
};

template <int D>
History<D> read_boxes(Lines& lines) {
  History<D> history;
  while (lines.next()) history.boxes.push_back(Row<D>(lines, false).box());
  return history;
}

template <int D>
History<D> read_frames(Lines& lines) {
  History<D> history;
  std::vector<std::size_t> last_change;  // for each box, the frame in which it was last listed
  std::size_t frame = 0;
  while (lines.next()) {
    const Row<D> row(lines, true);
    const std::size_t next = row.whole_number(0);
    if (next == frame + 1) {
      history.steps.push_back({last_change.size(), {}, {}});
      ++frame;
    } else if (next != frame) {
      row.refuse(0, fmt::format("{} or {}: frames follow one another", frame, frame + 1));
    }
    if (!row.has_box()) continue;
    const std::size_t place = row.whole_number(1);
    // Nothing may be left out: a single line must not be able to ask for any amount of memory.
    if (place > last_change.size())
      row.refuse(1, fmt::format("a box from 0 to {}: new ones are numbered one after the other",
                                last_change.size()));
    if (place == last_change.size())
      last_change.push_back(frame);
    else if (last_change[place] == frame)
      row.refuse(1, "each box once in a frame");
    last_change[place] = frame;
    if (frame == 0) {
      history.boxes.push_back(row.box());
      continue;
    }
    Step<D>& step = history.steps.back();
    step.size = last_change.size();
    step.changed.push_back(BoxId(place));
    step.boxes.push_back(row.box());
  }
  return history;
}

FileContent read(const std::filesystem::path& path) {
  Lines lines(path);
  const std::string expected =
      fmt::format("'{}' or '{}', with or without 'frame,box,' before it", header<2>(false), header<3>(false));
  if (!lines.next()) lines.refuse("the file is empty", expected);
  if (lines.line() == header<2>(false)) return {read_boxes<2>(lines), {}};
  if (lines.line() == header<3>(false)) return {{}, read_boxes<3>(lines)};
  if (lines.line() == header<2>(true)) return {read_frames<2>(lines), {}};
  if (lines.line() == header<3>(true)) return {{}, read_frames<3>(lines)};
  lines.refuse(fmt::format("'{}'", lines.line().substr(0, 100)), expected);
}

void append(std::string& text, float number) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  text.append(digits.data(), end);
}

template <int D>
void append_row(std::string& text, std::size_t frame, BoxId id, const Box<D>& box) {
  text += fmt::format("{},{}", frame, index(id));
  for (const std::array<float, D>& corner : {box.min, box.max}) {
    for (const float coordinate : corner) {
      text += ',';
      if (!is_absent(box)) append(text, coordinate);
    }
  }
  text += '\n';
}

/// What a file must list so that its boxes become those of `step`: the boxes that change, those that go
/// because the array ends before them, and those that come absent; sorted.
template <int D>
std::vector<std::pair<BoxId, Box<D>>> rows_of(const Step<D>& step, std::span<const Box<D>> before,
                                              std::size_t places) {
  std::vector<std::pair<BoxId, Box<D>>> rows;
  for (std::size_t i = step.size; i < before.size(); ++i) {
    if (!is_absent(before[i])) rows.emplace_back(BoxId(i), absent_box<D>());
  }
  for (std::size_t i = places; i < step.size; ++i) rows.emplace_back(BoxId(i), absent_box<D>());
  for (std::size_t i = 0; i < step.changed.size(); ++i) {
    if (index(step.changed[i]) < step.size) rows.emplace_back(step.changed[i], step.boxes[i]);
  }
  // Of two rows for a box the later one, from the list of changes, holds.
  std::ranges::reverse(rows);
  std::ranges::stable_sort(rows, {}, &std::pair<BoxId, Box<D>>::first);
  // Not std::ranges' version: clang 14 cannot compile what it returns.
  rows.erase(
      std::unique(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
      rows.end());
  return rows;
}

template <int D>
void write(const History<D>& history, std::ostream& stream) {
  std::string text = header<D>(true) + '\n';
  for (std::size_t i = 0; i < history.boxes.size(); ++i) append_row(text, 0, BoxId(i), history.boxes[i]);
  stream << text;

  std::vector<Box<D>> boxes = history.boxes;
  std::size_t places = boxes.size();  // in the file, where the array never becomes shorter
  for (std::size_t frame = 1; frame <= history.steps.size(); ++frame) {
    const Step<D>& step = history.steps[frame - 1];
    text.clear();
    for (const auto& [id, box] : rows_of<D>(step, boxes, places)) append_row(text, frame, id, box);
    if (text.empty()) text = fmt::format("{}{:,>{}}\n", frame, "", columns<D>().size() - 1);
    stream << text;
    lab::apply(step, boxes);
    places = std::max(places, boxes.size());
  }
}

}  // namespace

Format csv() {
  return {
      .name = "csv",
      .summary = "boxes as comma-separated values",
      .extensions = {".csv"},
      .recognises =
          [](std::string_view bytes, std::string_view extension) {
            return extension == ".csv" || bytes.starts_with(header<2>(true).substr(0, 10)) ||
                   bytes.starts_with(header<2>(false).substr(0, 6));
          },
      .read = read,
      .write_2d = write<2>,
      .write_3d = write<3>,
  };
}

}  // namespace broadside::lab::readers
