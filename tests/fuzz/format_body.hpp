// The body of a fuzzer of a format: whatever the bytes, its reader reads or refuses them, in no more memory
// than they justify, and what it reads can be written and read again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "broadside/box.hpp"

#include "lab/formats/format.hpp"

namespace broadside::lab {

/// Ends the program, which is how a fuzzer learns of a fault.
inline void expect(bool holds) {
  if (!holds) std::abort();
}

inline const Format& format_of_name(std::string_view name) {
  const auto format = std::ranges::find(formats(), name, &Format::name);
  expect(format != formats().end());
  return *format;
}

/// The frames of a file up to the last one that is right. No more than 50 are kept: enough for what can go
/// wrong, in little memory.
template <int D, typename Real>
History<D, Real> play(FrameReader<D, Real>& frames, std::size_t bytes) {
  History<D, Real> history;
  const auto check = [bytes](const std::vector<Box<D, Real>>& boxes) {
    for (const Box<D, Real>& box : boxes) expect(is_present(box) || is_absent(box));
    // A box takes at least a byte, and a small file may take a little more than it needs.
    expect(boxes.capacity() <= bytes + 2000);
  };
  try {
    history.boxes = frames.first();
    check(history.boxes);
    for (Step<D, Real> step; frames.next(step);) {
      check(step.boxes);
      expect(step.size <= bytes);
      expect(step.changed.size() == step.boxes.size());
      for (const BoxId id : step.changed) expect(index(id) < step.size);
      if (history.steps.size() < 50) history.steps.push_back(step);
    }
  } catch (const FileError&) {
    // Refused: the frames before were right.
  }
  return history;
}

/// The boxes of every frame, without absent ones at an array's end, which a format need not keep.
template <int D, typename Real>
std::vector<std::vector<Box<D, Real>>> frames_of(const History<D, Real>& history) {
  std::vector<std::vector<Box<D, Real>>> frames;
  std::vector<Box<D, Real>> boxes = history.boxes;
  const auto add = [&] {
    frames.push_back(boxes);
    while (!frames.back().empty() && is_absent(frames.back().back())) frames.back().pop_back();
  };
  add();
  for (const Step<D, Real>& step : history.steps) {
    lab::apply(step, boxes);
    add();
  }
  return frames;
}

template <int D, typename Real>
void check_written_and_read_again(const Format& format, const History<D, Real>& history) {
  std::ostringstream stream;
  {
    AnyFrameWriter writer = format.create(stream, D, precision_of<Real>);
    FrameWriter<D, Real>& frames = *std::get<std::unique_ptr<FrameWriter<D, Real>>>(writer);
    frames.first(history.boxes);
    for (const Step<D, Real>& step : history.steps) frames.next(step);
    frames.finish();
  }
  const std::string bytes = stream.str();
  ReadOptions options;
  options.dimension = D;
  options.precision = precision_of<Real>;
  AnyFrameReader reader = format.open(std::make_unique<Input>("written", bytes), options);
  // As the caller of a format does: without boxes, some cannot say that they are in 2D.
  if (D == 2) reader = flattened(std::move(reader));
  FrameReader<D, Real>* const frames = std::get<std::unique_ptr<FrameReader<D, Real>>>(reader).get();
  expect(frames_of(read_all(*frames)) == frames_of(history));
}

/// Reads the bytes as a file of this format.
inline void check_format(std::string_view name, std::string_view bytes, const ReadOptions& options = {}) {
  const Format& format = format_of_name(name);
  AnyFrameReader reader;
  try {
    reader = format.open(std::make_unique<Input>("fuzz", bytes), options);
  } catch (const FileError&) {
    return;
  }
  std::visit([&](auto& frames) { check_written_and_read_again(format, play(*frames, bytes.size())); },
             reader);
}

}  // namespace broadside::lab
