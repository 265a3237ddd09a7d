// The format of traces among the others: a trace as a history, and a history as a trace.
#include "lab/readers/trace.hpp"

#include <ostream>
#include <utility>

#include "lab/readers/descriptions.hpp"

namespace broadside::lab::readers {
namespace {

template <int D>
Step<D> step_of(const TraceReader& reader) {
  const std::span<const BoxId> changed = reader.changed();
  Step<D> step{reader.slots(), {changed.begin(), changed.end()}, {}};
  step.boxes.reserve(changed.size());
  for (std::size_t i = 0; i < changed.size(); ++i) step.boxes.push_back(reader.box<D>(i));
  return step;
}

template <int D>
History<D> read_history(TraceReader& reader) {
  History<D> history;
  if (!reader.next_frame()) {
    if (reader.warning().empty()) return history;
    throw FileError(reader.warning() + "; expected at least one whole frame");
  }
  lab::apply(step_of<D>(reader), history.boxes);
  while (reader.next_frame()) history.steps.push_back(step_of<D>(reader));
  return history;
}

FileContent read(const std::filesystem::path& path) {
  TraceReader reader(path);
  FileContent content;
  if (reader.dimension() == 2)
    content.in_2d = read_history<2>(reader);
  else
    content.in_3d = read_history<3>(reader);
  content.warning = reader.warning();
  return content;
}

template <int D>
void write(const History<D>& history, std::ostream& stream) {
  Recorder<D> recorder;
  recorder.open_with([&stream](const void* bytes, std::size_t count) {
    return bool(stream.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count)));
  });
  const auto set = [&](std::size_t slot, const Box<D>& box) {
    recorder.set(static_cast<std::uint32_t>(slot), box.min.data(), box.max.data());
  };
  recorder.resize(history.boxes.size());
  for (std::size_t i = 0; i < history.boxes.size(); ++i) set(i, history.boxes[i]);
  recorder.end_frame();
  for (const Step<D>& step : history.steps) {
    recorder.resize(step.size);
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      if (index(step.changed[i]) < step.size) set(index(step.changed[i]), step.boxes[i]);
    }
    recorder.end_frame();
  }
  // What is wrong with the stream, the caller says.
  if (!recorder.close() && stream) throw FileError(recorder.error());
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
      .read = read,
      .write_2d = write<2>,
      .write_3d = write<3>,
  };
}

}  // namespace broadside::lab::readers
