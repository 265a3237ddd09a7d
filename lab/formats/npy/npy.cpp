// Boxes as a NumPy array: a row a box, with the minima on all axes and then the maxima, or with named fields.
#include <algorithm>
#include <array>
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
      : input_(std::move(input)), begin_(begin), layout_(layout) {}

  std::vector<Box<D, Real>> first() override {
    std::vector<Box<D, Real>> boxes(layout_.rows);
    for (std::size_t row = 0; row < layout_.rows; ++row) {
      for (std::size_t axis = 0; axis < D; ++axis) {
        const auto [min, max] = bounds_of(layout_.forms[axis], number(row, layout_.first[axis]),
                                          number(row, layout_.second[axis]));
        boxes[row].min[axis] = static_cast<Real>(min);
        boxes[row].max[axis] = static_cast<Real>(max);
      }
      if (!is_present(boxes[row]) && !is_absent(boxes[row])) refuse_box(row, boxes[row]);
      input_->passed(begin_ + row * layout_.row_step);
    }
    return boxes;
  }

  bool next(Step<D, Real>&) override { return false; }

  std::shared_ptr<const BoxLabels> labels() const override {
    return layout_.unread.empty() ? nullptr
                                  : std::make_shared<BoxLabels>(BoxLabels{.unread = layout_.unread});
  }

  bool is_computed() const override {
    return std::ranges::any_of(layout_.forms, [](BoundsForm form) {
      return form != BoundsForm::min_max && form != BoundsForm::point;
    });
  }

 private:
  double number(std::size_t row, const NpyColumn& column) const {
    const char* const bytes = input_->bytes().data() + begin_ + row * layout_.row_step + column.offset;
    double value = 0;
    if (!column.type.load(bytes, value))
      throw FileError(fmt::format("{}: row {} holds {}; expected at most 2^53, up to which a double is exact",
                                  input_->name(), row, column.type.digits(bytes)));
    return value;
  }

  [[noreturn]] void refuse_box(std::size_t row, const Box<D, Real>& box) const {
    throw FileError(
        fmt::format("{}: row {} has min ({}) and max ({}); expected numbers with min <= max, or inf and -inf "
                    "for an absent box",
                    input_->name(), row, fmt::join(box.min, ", "), fmt::join(box.max, ", ")));
  }

  std::unique_ptr<Input> input_;
  std::size_t begin_;
  NpyLayout layout_;
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
