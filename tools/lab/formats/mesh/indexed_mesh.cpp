// Indexed meshes: detects their format, triangulates and welds them.
#include "lab/formats/mesh/indexed_mesh.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "src/core/bit_cast.hpp"

namespace broadside::lab {

namespace {

/// A position as integers that are equal exactly if the positions are: -0 equals 0, and NaN equals itself.
std::array<std::uint64_t, 3> place_of(const std::array<double, 3>& vertex) {
  std::array<std::uint64_t, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    place[axis] = vertex[axis] == 0 ? 0 : core::bit_cast<std::uint64_t>(vertex[axis]);
  return place;
}

/// For each vertex, the first vertex at the same position, in both `a` and `b`.
std::vector<std::uint32_t> first_in_place(const IndexedMesh& a, const IndexedMesh& b) {
  std::vector<std::array<std::uint64_t, 6>> places(a.vertices.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto now = place_of(a.vertices[i]);
    const auto then = place_of(b.vertices[i]);
    places[i] = {now[0], now[1], now[2], then[0], then[1], then[2]};
  }
  std::vector<std::uint32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    return places[i] < places[j] || (places[i] == places[j] && i < j);
  });
  std::vector<std::uint32_t> first(places.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_first = i == 0 || places[order[i]] != places[order[i - 1]];
    first[order[i]] = is_first ? order[i] : first[order[i - 1]];
  }
  return first;
}

/// Keeps the first vertex at each position, and renumbers the faces' vertices.
void keep_first(IndexedMesh& mesh, const std::vector<std::uint32_t>& first) {
  std::vector<std::uint32_t> numbers(first.size());
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    if (first[i] == i) {
      mesh.vertices[count] = mesh.vertices[i];
      numbers[i] = count++;
    } else {
      numbers[i] = numbers[first[i]];
    }
  }
  mesh.vertices.resize(count);
  for (std::uint32_t& corner : mesh.corners) corner = numbers[corner];
}

}  // namespace

IndexedMesh read_mesh(Input& input) {
  const std::string_view content = mesh_content(input.beginning());
  const std::string extension = input.extension();
  if (content == "ply" || extension == ".ply") return read_ply(input);
  return content == "obj" || extension == ".obj" ? read_obj(input) : import_mesh(input);
}

void weld(IndexedMesh& mesh, IndexedMesh* later) {
  if (mesh.has_own_vertices) return;
  const std::vector<std::uint32_t> first = first_in_place(mesh, later == nullptr ? mesh : *later);
  keep_first(mesh, first);
  if (later != nullptr) keep_first(*later, first);
}

void triangulate(IndexedMesh& mesh) {
  std::vector<std::uint32_t> corners;
  corners.reserve(mesh.corners.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const std::uint32_t> face = mesh.face(f);
    for (std::size_t i = 2; i < face.size(); ++i)
      corners.insert(corners.end(), {face[0], face[i - 1], face[i]});
  }
  mesh.corners = std::move(corners);
  mesh.face_ends.resize(mesh.corners.size() / 3);
  for (std::size_t f = 0; f < mesh.face_ends.size(); ++f) mesh.face_ends[f] = 3 * (f + 1);
}

std::vector<std::array<std::uint32_t, 2>> edges_of(const IndexedMesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(mesh.corners.size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const std::uint32_t> face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const std::uint32_t a = face[i];
      const std::uint32_t b = face[i + 1 == face.size() ? 0 : i + 1];
      // A face that repeats a vertex consecutively has no edge there.
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

namespace {

/// Whether the first line that is neither empty nor a comment begins like a line of OBJ.
bool begins_as_obj(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    if (line.empty() || line.starts_with('#')) continue;
    constexpr std::array<std::string_view, 8> words = {"v", "vn", "vt", "f", "o", "g", "mtllib", "usemtl"};
    const std::size_t end = line.find_first_of(blanks);
    return end != std::string_view::npos &&
           std::find(words.begin(), words.end(), line.substr(0, end)) != words.end();
  }
  return false;
}

}  // namespace

std::string_view mesh_content(std::string_view beginning) {
  if (beginning.starts_with("ply\n") || beginning.starts_with("ply\r")) return "ply";
  if (beginning.starts_with("glTF")) return "glb";
  if (beginning.starts_with("solid ")) return "stl";
  if (beginning.starts_with("OFF\n") || beginning.starts_with("OFF\r")) return "off";
  const std::size_t first = std::min(beginning.find_first_not_of(" \t\r\n"), beginning.size());
  if (beginning.substr(first).starts_with('{') && beginning.find("\"asset\"") != std::string_view::npos)
    return "gltf";
  return begins_as_obj(beginning) ? "obj" : "";
}

}  // namespace broadside::lab
