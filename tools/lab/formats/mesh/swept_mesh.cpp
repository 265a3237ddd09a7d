// One mesh at two times: reads, compares and sweeps it.
#include "lab/formats/mesh/swept_mesh.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/registry.hpp"
#include "lab/pair_filter.hpp"

namespace broadside::lab {
namespace {

IndexedMesh read_one(const std::filesystem::path& path, const ReadOptions& options) {
  Input input(path, options.progress);
  const bool is_told = options.format.empty();
  const auto format = std::ranges::find_if(formats(), [&](const Format& known) {
    return is_told ? known.recognises(input.beginning(), input.extension()) : known.name == options.format;
  });
  const bool is_mesh =
      is_told ? readers::mesh().recognises(input.beginning(), input.extension()) : options.format == "mesh";
  if (!is_mesh)
    throw FileError(
        fmt::format("{}: is in {}; expected a mesh, such as a PLY file", input.name(),
                    format == formats().end() ? "no format known here" : "format " + format->name));
  return lab::read_mesh(input);
}

}  // namespace

SweptMesh::SweptMesh(IndexedMesh before, std::string name_before, IndexedMesh after, std::string name_after)
    : before_(std::move(before)),
      after_(std::move(after)),
      name_before_(std::move(name_before)),
      name_after_(std::move(name_after)) {
  const auto refuse = [&](const std::string& found) {
    throw FileError(
        fmt::format("{} and {}: {}; expected one mesh at two times", name_before_, name_after_, found));
  };
  const auto differ = [&](std::size_t first, std::size_t second, std::string_view what) {
    if (first != second) refuse(fmt::format("{} {} and {}", first, what, second));
  };
  differ(before_.vertices.size(), after_.vertices.size(), "vertices");
  differ(before_.face_count(), after_.face_count(), "faces");
  for (std::size_t f = 0; f < before_.face_count(); ++f) {
    if (!std::ranges::equal(before_.face(f), after_.face(f)))
      refuse(fmt::format("face {} is of vertices {} and of vertices {}", f, fmt::join(before_.face(f), ", "),
                         fmt::join(after_.face(f), ", ")));
  }
  weld(before_, &after_);
}

SweptElements SweptMesh::swept(MeshPart part) const {
  SweptElements swept{MeshElements(before_, part), {}};
  swept.boxes = swept.elements.boxes(before_, name_before_);
  const std::vector<DoubleBox3> after = swept.elements.boxes(after_, name_after_);
  for (std::size_t i = 0; i < after.size(); ++i) swept.boxes[i] = merged(swept.boxes[i], after[i]);
  return swept;
}

Precision SweptMesh::precision() const noexcept { return std::max(before_.precision, after_.precision); }

std::string_view SweptMesh::importer() const noexcept {
  return before_.importer.empty() ? after_.importer : before_.importer;
}

SweptMesh read_swept_mesh(const std::filesystem::path& before, const std::filesystem::path& after,
                          const ReadOptions& options) {
  IndexedMesh first = read_one(before, options);
  IndexedMesh second = read_one(after, options);
  return {std::move(first), before.string(), std::move(second), after.string()};
}

void ApartPairs::consume(std::span<const Pair> pairs) {
  write_if(pairs, pairs_, [this](Pair pair) {
    return !share_vertex(left_.vertices(index(pair.first)), right_.vertices(index(pair.second)));
  });
}

}  // namespace broadside::lab
