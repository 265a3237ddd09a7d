// The trace format, for the list of formats.
#include "lab/formats/trace/trace.hpp"

#include <memory>
#include <ostream>
#include <utility>

#include "lab/formats/registry.hpp"

namespace broadside::lab::readers {
namespace {

/// A trace's frames, of D dimensions and in the trace's precision.
template <int D, typename Real>
class TraceFrames final : public FrameReader<D, Real> {
 public:
  TraceFrames(std::unique_ptr<Input> input, std::unique_ptr<TraceReader> reader)
      : input_(std::move(input)), reader_(std::move(reader)) {}

  std::vector<Box<D, Real>> first() override {
    std::vector<Box<D, Real>> boxes;
    if (reader_->next_frame()) {
      lab::apply(step(), boxes);
    } else if (!reader_->warning().empty()) {
      throw FileError(reader_->warning() + "; expected at least one whole frame");
    }
    return boxes;
  }

  bool next(Step<D, Real>& next) override {
    if (!reader_->next_frame()) return false;
    next = step();
    return true;
  }

  std::string warning() const override { return reader_->warning(); }

  const RecordedPairs* recorded() const override { return reader_->recorded(); }

 private:
  Step<D, Real> step() const {
    const std::span<const BoxId> changed = reader_->changed();
    Step<D, Real> step{reader_->slots(), {changed.begin(), changed.end()}, {}};
    step.boxes.reserve(changed.size());
    for (std::size_t i = 0; i < changed.size(); ++i) step.boxes.push_back(reader_->box<D, Real>(i));
    return step;
  }

  std::unique_ptr<Input> input_;
  std::unique_ptr<TraceReader> reader_;
};

AnyFrameReader open_trace(std::unique_ptr<Input> input, const ReadOptions&) {
  auto reader = std::make_unique<TraceReader>(input->stream(), input->name());
  const Precision precision =
      reader->coordinate_bytes() == sizeof(float) ? Precision::float32 : Precision::float64;
  return for_boxes_of(reader->dimension(), precision, [&]<int D, typename Real>() -> AnyFrameReader {
    return std::make_unique<TraceFrames<D, Real>>(std::move(input), std::move(reader));
  });
}

template <int D, typename Real>
class TraceWriter final : public FrameWriter<D, Real> {
 public:
  explicit TraceWriter(std::ostream& stream) : stream_(stream) {}

  void use_recorded(const RecordedPairs& recorded) override { recorded_ = &recorded; }

  void first(std::span<const Box<D, Real>> boxes) override {
    open();
    recorder_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) set(i, boxes[i]);
    end_frame(boxes.size());
  }

  void next(const Step<D, Real>& step) override {
    recorder_.resize(step.size);
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      if (index(step.changed[i]) < step.size) set(index(step.changed[i]), step.boxes[i]);
    }
    end_frame(step.size);
  }

 private:
  void open() {
    const auto write = [this](const void* bytes, std::size_t count) {
      return bool(stream_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count)));
    };
    if (recorded_ == nullptr)
      recorder_.open_with(write);
    else
      recorder_.open_with(write, recorded_->margin);
  }

  void set(std::size_t slot, const Box<D, Real>& box) {
    if (recorded_ != nullptr && is_absent(box)) emptied_.push_back(BoxId(slot));
    recorder_.set(static_cast<std::uint32_t>(slot), box.min.data(), box.max.data());
  }

  void put_pairs(std::size_t slots) {
    pairs_.apply(*recorded_, slots, emptied_);
    emptied_.clear();
    for (const auto& [slot, filter] : recorded_->filters)
      recorder_.set_filter(index(slot), filter.category, filter.mask, filter.group, filter.is_static);
    for (const Pair pair : pairs_.reported()) recorder_.add_pair(index(pair.first), index(pair.second));
    for (const Pair pair : pairs_.ignored()) recorder_.ignore_pair(index(pair.first), index(pair.second));
  }

  void end_frame(std::size_t slots) {
    if (recorded_ != nullptr) put_pairs(slots);
    // The caller checks the stream for errors.
    if ((!recorder_.end_frame() || !recorder_.error().empty()) && stream_) throw FileError(recorder_.error());
  }

  std::ostream& stream_;
  Recorder<D, Real> recorder_;
  const RecordedPairs* recorded_ = nullptr;  // of the frame being written; null if there are no pairs
  RecordedFrame pairs_;
  std::vector<BoxId> emptied_;  // in the frame being written
};

AnyFrameWriter create_trace(std::ostream& stream, int dimension, Precision precision) {
  return for_boxes_of(dimension, precision, [&]<int D, typename Real>() -> AnyFrameWriter {
    return std::make_unique<TraceWriter<D, Real>>(stream);
  });
}

}  // namespace

Format trace() {
  return {
      .name = "trace",
      .summary = "frames of boxes as an engine recorded them",
      .extensions = {".btrace"},
      .recognises =
          [](std::string_view bytes, std::string_view extension) {
            const std::string_view magic(reinterpret_cast<const char*>(trace::magic.data()),
                                         trace::magic.size());
            return extension == ".btrace" || bytes.starts_with(magic);
          },
      .open = open_trace,
      .create = create_trace,
      .keeps_pairs = true,
  };
}

}  // namespace broadside::lab::readers
