// Boxes as a NumPy array: a row a box, with the minima on all axes and then the maxima, or with named fields.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <ostream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/descriptions.hpp"
#include "lab/formats/npy/array.hpp"
#include "lab/formats/npy/header.hpp"
#include "lab/formats/npy/layout.hpp"

namespace broadside::lab::readers {
namespace {

/// The boxes of an array whose rows are all there.
template <int D, typename Real>
class NpyFrame final : public FrameReader<D, Real> {
 public:
  NpyFrame(std::unique_ptr<Input> input, std::size_t begin, const NpyLayout& layout)
      : input_(std::move(input)),
        begin_(begin),
        layout_(layout),
        is_plain_(is_plain(layout)),
        end_row_(layout.rows) {
    settle_top();
  }

  std::vector<Box<D, Real>> first() override {
    std::vector<Box<D, Real>> boxes;
    read(end_row_ - next_row_, boxes);
    return boxes;
  }

  bool first_piece(std::vector<Box<D, Real>>& boxes) override {
    constexpr std::size_t rows_a_piece = std::size_t{1} << 18;
    input_->release(begin_ + next_row_ * layout_.row_step);
    read(std::min(rows_a_piece, end_row_ - next_row_), boxes);
    return !boxes.empty();
  }

  bool has_pieces() const override { return true; }

  bool take_slice(std::size_t slice, std::size_t slices) override {
    next_row_ = layout_.rows / slices * slice + std::min(slice, layout_.rows % slices);
    end_row_ = next_row_ + layout_.rows / slices + (slice < layout_.rows % slices ? 1 : 0);
    return true;
  }

  std::uint64_t estimated_boxes() const override { return end_row_ - next_row_; }

  bool next(Step<D, Real>&) override { return false; }

  std::shared_ptr<const BoxLabels> labels() const override {
    return layout_.unread.empty() ? nullptr
                                  : std::make_shared<BoxLabels>(BoxLabels{.unread = layout_.unread});
  }

  bool is_computed() const override { return std::ranges::any_of(layout_.forms, computes_bounds); }

 private:
  /// Looks for the first row that shows in which direction y grows.
  void settle_top() {
    if (layout_.forms[1] != BoundsForm::bottom_top) return;
    layout_.forms[1] = BoundsForm::min_max;
    for (std::size_t row = 0; row < layout_.rows; ++row) {
      const double bottom = number(row, layout_.first[1]);
      const double top = number(row, layout_.second[1]);
      if (bottom == top || !std::isfinite(bottom) || !std::isfinite(top)) continue;
      if (top < bottom) std::swap(layout_.first[1], layout_.second[1]);
      return;
    }
  }

  /// Reads the next `count` rows.
  void read(std::size_t count, std::vector<Box<D, Real>>& boxes) {
    boxes.resize(count);
    const std::size_t first = std::exchange(next_row_, next_row_ + count);
    if (is_plain_ && count > 0)
      std::memcpy(boxes.data(), input_->bytes().data() + begin_ + first * layout_.row_step,
                  count * layout_.row_step);
    for (std::size_t i = 0; i < count; ++i) {
      if (!is_plain_) boxes[i] = box_of(first + i);
      if (!is_present(boxes[i]) && !is_absent(boxes[i])) refuse_box(first + i, boxes[i]);
      input_->passed(begin_ + (first + i) * layout_.row_step);
    }
  }

  Box<D, Real> box_of(std::size_t row) const {
    Box<D, Real> box;
    for (std::size_t axis = 0; axis < D; ++axis) {
      const auto [min, max] =
          bounds_of(layout_.forms[axis], number(row, layout_.first[axis]), number(row, layout_.second[axis]));
      box.min[axis] = static_cast<Real>(min);
      box.max[axis] = static_cast<Real>(max);
    }
    return box;
  }

  /// Whether the rows are boxes as they are in memory.
  static bool is_plain(const NpyLayout& layout) {
    if constexpr (std::endian::native != std::endian::little) return false;
    const auto load = npy_type_of(sizeof(Real) == sizeof(float) ? "<f4" : "<f8")->load;
    const auto is_at = [load](const NpyColumn& column, std::size_t place) {
      return column.offset == place * sizeof(Real) && column.type.load == load;
    };
    bool is_plain = layout.row_step == sizeof(Box<D, Real>);
    for (std::size_t axis = 0; axis < D; ++axis)
      is_plain = is_plain && layout.forms[axis] == BoundsForm::min_max && is_at(layout.first[axis], axis) &&
                 is_at(layout.second[axis], D + axis);
    return is_plain;
  }

  double number(std::size_t row, const NpyColumn& column) const {
    const char* const bytes = input_->bytes().data() + begin_ + row * layout_.row_step + column.offset;
    double value = 0;
    if (!column.type.load(bytes, value))
      throw FileError(fmt::format("{}: row {} holds {}; expected at most 2^53, up to which a double is exact",
                                  input_->name(), row, column.type.digits(bytes)));
    return value;
  }

  /// Whether all rows are valid as a corner and the size.
  bool are_sizes() const {
    for (std::size_t row = 0; row < layout_.rows; ++row) {
      for (std::size_t axis = 0; axis < D; ++axis) {
        if (layout_.forms[axis] != BoundsForm::min_max || !(number(row, layout_.second[axis]) >= 0))
          return false;
      }
    }
    return true;
  }

  [[noreturn]] void refuse_box(std::size_t row, const Box<D, Real>& box) const {
    throw FileError(fmt::format(
        "{}: row {} has min ({}) and max ({}); expected numbers with min <= max, or inf and -inf "
        "for an absent box{}",
        input_->name(), row, fmt::join(box.min, ", "), fmt::join(box.max, ", "),
        are_sizes() ? fmt::format("; as a corner and the size all {} rows are valid: make maxima by "
                                  "boxes[:, {}:] += boxes[:, :{}]",
                                  layout_.rows, int{D}, int{D})
                    : ""));
  }

  std::unique_ptr<Input> input_;
  std::size_t begin_;
  NpyLayout layout_;
  bool is_plain_;
  std::size_t next_row_ = 0;
  std::size_t end_row_;
};

AnyFrameReader open_npy(std::unique_ptr<Input> input, const ReadOptions&) {
  const std::string_view bytes = input->bytes();
  const NpyHeader header = read_npy_header(bytes, input->name());
  const NpyLayout layout = npy_layout(header, bytes.size() - header.bytes, input->name());
  return for_boxes_of(layout.dimension, layout.precision, [&]<int D, typename Real>() -> AnyFrameReader {
    return std::make_unique<NpyFrame<D, Real>>(std::move(input), header.bytes, layout);
  });
}

template <int D, typename Real>
class NpyWriter final : public FrameWriter<D, Real> {
 public:
  explicit NpyWriter(std::ostream& stream) : array_(stream, 2 * D) {}

  void first(std::span<const Box<D, Real>> boxes) override {
    std::array<Real, 2 * D> row;
    for (const Box<D, Real>& box : boxes) {
      std::ranges::copy(box.min, row.begin());
      std::ranges::copy(box.max, row.begin() + D);
      array_.write(row);
    }
  }

  void next(const Step<D, Real>&) override {
    throw FileError("more than one frame; expected one, which is what a .npy file holds");
  }

  void finish() override { array_.finish(); }

 private:
  NpyArrayWriter<Real> array_;
};

AnyFrameWriter create_npy(std::ostream& stream, int dimension, Precision precision) {
  return for_boxes_of(dimension, precision, [&]<int D, typename Real>() -> AnyFrameWriter {
    return std::make_unique<NpyWriter<D, Real>>(stream);
  });
}

}  // namespace

Format npy() {
  return {
      .name = "npy",
      .summary = "boxes as a NumPy array",
      .extensions = {".npy"},
      .recognises =
          [](std::string_view bytes, std::string_view extension) {
            return extension == ".npy" || bytes.starts_with(npy_magic);
          },
      .open = open_npy,
      .create = create_npy,
  };
}

}  // namespace broadside::lab::readers
