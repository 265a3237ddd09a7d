// Fuzzes the reader of maps: whatever the bytes, it reads or refuses them, and what the boxes are of does not
// change where the map is.
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "lab/formats/registry.hpp"

namespace broadside::lab {
namespace {

/// Ends the program, which is how a fuzzer learns of a fault.
void expect(bool holds) {
  if (!holds) std::abort();
}

using Boxes = std::vector<DoubleBox2>;

/// Nothing if the bytes are refused.
std::optional<Boxes> read(const Format& format, std::string_view bytes, const std::string& part,
                          ReadOptions options = {}) {
  options.boxes = part;
  try {
    const AnyFrameReader frames = format.open(std::make_unique<Input>("fuzz", bytes), options);
    return std::get<std::unique_ptr<FrameReader<2, double>>>(frames)->first();
  } catch (const FileError&) {
    return std::nullopt;
  }
}

/// The bounds of all boxes that are there.
DoubleBox2 bounds_of(const Boxes& boxes) {
  DoubleBox2 bounds = absent_box<2, double>();
  for (const DoubleBox2& box : boxes) {
    if (is_absent(box)) continue;
    expect(is_present(box));
    bounds = merged(bounds, box);
  }
  return bounds;
}

void check(const Format& format, std::string_view bytes) {
  const auto features = read(format, bytes, "features");
  const auto pieces = read(format, bytes, "pieces");
  const auto segments = read(format, bytes, "segments");
  expect(pieces.has_value() == segments.has_value());
  // Boxes in images, which are COCO's or LabelMe's, have no other parts.
  const bool are_images = features && bytes.find("\"annotations\"") != std::string_view::npos;
  const bool are_shapes = features && bytes.find("\"shapes\"") != std::string_view::npos;
  expect(features.has_value() == pieces.has_value() || are_images || are_shapes);
  ReadOptions lenient;
  lenient.say_invalid = [](std::string_view) {};
  for (const auto& [part, boxes] :
       {std::pair("features", &features), std::pair("pieces", &pieces), std::pair("segments", &segments)}) {
    // What is right stays.
    const auto left = read(format, bytes, part, lenient);
    expect(!*boxes || left == *boxes);
  }
  lenient.ids = "id";
  read(format, bytes, "features", lenient);
  if (!features || !pieces) return;
  // A box is paid for in bytes.
  for (const Boxes* boxes : {&*features, &*pieces, &*segments}) expect(boxes->size() <= bytes.size());
  const DoubleBox2 bounds = bounds_of(*features);
  expect(bounds == bounds_of(*pieces));
  const DoubleBox2 of_segments = bounds_of(*segments);
  if (is_absent(of_segments)) return;
  for (int axis = 0; axis < 2; ++axis)
    expect(bounds.min[axis] <= of_segments.min[axis] && of_segments.max[axis] <= bounds.max[axis]);
}

}  // namespace
}  // namespace broadside::lab

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const broadside::lab::Format format = broadside::lab::readers::map();
  broadside::lab::check(format, {reinterpret_cast<const char*>(data), size});
  return 0;
}
