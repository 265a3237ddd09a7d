// Boxes as text: comma-separated values, one line a box, or one line a box that changes in a frame.
//
// With columns frame and box, frame 0 lists every box in order, and a later frame those that change; a box
// one beyond the last is new. Empty coordinates, or min = inf and max = -inf, stand for an absent box, and a
// line with nothing but a frame for a frame in which nothing changes.
#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
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
  explicit Lines(Input& input) : input_(input), rest_(input.bytes()) {
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
    throw FileError(fmt::format("{}:{}: {}; expected {}", input_.name(), number_, found, expected));
  }

 private:
  Input& input_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
};

/// One line, split at its commas.
template <int D, typename Real>
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

  Box<D, Real> box() const {
    if (std::ranges::all_of(std::span(fields_).subspan(2),
                            [](std::string_view field) { return field.empty(); }))
      return absent_box<D, Real>();
    Box<D, Real> box;
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

  Real number(std::size_t column) const {
    Real value = 0;
    // A NaN is no number, and nothing equals it.
    if (!parse(fields_[column], value) || value != value)
      refuse(column, fmt::format("a number that a {} can hold", name(precision_of<Real>)));
    return value;
  }

  const Lines& lines_;
  std::size_t first_;
  std::array<std::string_view, 2 + 2 * D> fields_;
};

template <int D, typename Real>
History<D, Real> read_boxes(Lines& lines) {
  History<D, Real> history;
  while (lines.next()) history.boxes.push_back(Row<D, Real>(lines, false).box());
  return history;
}

template <int D, typename Real>
History<D, Real> read_frames(Lines& lines) {
  History<D, Real> history;
  std::vector<std::size_t> last_change;  // for each box, the frame in which it was last listed
  std::size_t frame = 0;
  while (lines.next()) {
    const Row<D, Real> row(lines, true);
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
    Step<D, Real>& step = history.steps.back();
    step.size = last_change.size();
    step.changed.push_back(BoxId(place));
    step.boxes.push_back(row.box());
  }
  return history;
}

AnyFrameReader open(std::unique_ptr<Input> input, const ReadOptions& options) {
  Lines lines(*input);
  const std::string expected =
      fmt::format("'{}' or '{}', with or without 'frame,box,' before it", header<2>(false), header<3>(false));
  if (!lines.next()) lines.refuse("the file is empty", expected);
  for (const bool has_frames : {false, true}) {
    for (const int dimension : {2, 3}) {
      if (lines.line() != (dimension == 2 ? header<2>(has_frames) : header<3>(has_frames))) continue;
      const Precision precision = options.precision.value_or(Precision::float64);
      return for_boxes_of(dimension, precision, [&]<int D, typename Real>() -> AnyFrameReader {
        return std::make_unique<HistoryReader<D, Real>>(has_frames ? read_frames<D, Real>(lines)
                                                                   : read_boxes<D, Real>(lines));
      });
    }
  }
  lines.refuse(fmt::format("'{}'", lines.line().substr(0, 100)), expected);
}

template <typename Real>
void append(std::string& text, Real number) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  text.append(digits.data(), end);
}

template <int D, typename Real>
void append_row(std::string& text, std::size_t frame, BoxId id, const Box<D, Real>& box) {
  text += fmt::format("{},{}", frame, index(id));
  for (const std::array<Real, D>& corner : {box.min, box.max}) {
    for (const Real coordinate : corner) {
      text += ',';
      if (!is_absent(box)) append(text, coordinate);
    }
  }
  text += '\n';
}

/// What a file must list so that its boxes become those of `step`: the boxes that change, those that go
/// because the array ends before them, and those that come absent; sorted.
template <int D, typename Real>
std::vector<std::pair<BoxId, Box<D, Real>>> rows_of(const Step<D, Real>& step,
                                                    std::span<const Box<D, Real>> before,
                                                    std::size_t places) {
  std::vector<std::pair<BoxId, Box<D, Real>>> rows;
  for (std::size_t i = step.size; i < before.size(); ++i) {
    if (!is_absent(before[i])) rows.emplace_back(BoxId(i), absent_box<D, Real>());
  }
  for (std::size_t i = places; i < step.size; ++i) rows.emplace_back(BoxId(i), absent_box<D, Real>());
  for (std::size_t i = 0; i < step.changed.size(); ++i) {
    if (index(step.changed[i]) < step.size) rows.emplace_back(step.changed[i], step.boxes[i]);
  }
  // Of two rows for a box the later one, from the list of changes, holds.
  std::ranges::reverse(rows);
  std::ranges::stable_sort(rows, {}, &std::pair<BoxId, Box<D, Real>>::first);
  // Not std::ranges' version: clang 14 cannot compile what it returns.
  rows.erase(
      std::unique(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
      rows.end());
  return rows;
}

template <int D, typename Real>
class CsvWriter final : public FrameWriter<D, Real> {
 public:
  explicit CsvWriter(std::ostream& stream) : stream_(stream) {}

  void first(std::span<const Box<D, Real>> boxes) override {
    boxes_.assign(boxes.begin(), boxes.end());
    places_ = boxes.size();
    std::string text = header<D>(true) + '\n';
    for (std::size_t i = 0; i < boxes.size(); ++i) append_row(text, 0, BoxId(i), boxes[i]);
    stream_ << text;
  }

  void next(const Step<D, Real>& step) override {
    ++frame_;
    std::string text;
    for (const auto& [id, box] : rows_of<D, Real>(step, boxes_, places_)) append_row(text, frame_, id, box);
    if (text.empty()) text = fmt::format("{}{:,>{}}\n", frame_, "", columns<D>().size() - 1);
    stream_ << text;
    lab::apply(step, boxes_);
    places_ = std::max(places_, boxes_.size());
  }

 private:
  std::ostream& stream_;
  std::vector<Box<D, Real>> boxes_;
  std::size_t places_ = 0;  // in the file, where the array never becomes shorter
  std::size_t frame_ = 0;
};

AnyFrameWriter create(std::ostream& stream, int dimension, Precision precision) {
  return for_boxes_of(dimension, precision, [&]<int D, typename Real>() -> AnyFrameWriter {
    return std::make_unique<CsvWriter<D, Real>>(stream);
  });
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
      .open = open,
      .create = create,
  };
}

}  // namespace broadside::lab::readers
