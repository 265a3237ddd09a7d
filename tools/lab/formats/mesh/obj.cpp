// OBJ, the format of Wavefront. Each line is a vertex, "v x y z", or a face, "f 1/7 2/8 3/9". The first
// numbers of a face are its vertices, counted from 1 or, if negative, back from the last one.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

class ObjReader {
 public:
  explicit ObjReader(Input& input) : input_(input), bytes_(input.bytes()) {}

  IndexedMesh read() {
    mesh_.has_own_vertices = true;
    while (next_line()) {
      const std::string_view word = next_word(rest_);
      if (word == "v") {
        read_vertex();
      } else if (word == "f") {
        read_face();
      } else if (word == "l" || word == "p") {
        ++mesh_.other_elements;
      }
    }
    for (std::size_t i = 0; i < mesh_.corners.size(); ++i) {
      if (mesh_.corners[i] < mesh_.vertices.size()) continue;
      throw FileError(fmt::format("{}: a face names the vertex {}; expected one from 1 to {}", input_.name(),
                                  std::uint64_t{mesh_.corners[i]} + 1, mesh_.vertices.size()));
    }
    return std::move(mesh_);
  }

 private:
  /// The next line, joined with those that follow a backslash at its end.
  bool next_line() {
    if (at_ >= bytes_.size()) return false;
    joined_.clear();
    for (bool goes_on = true; goes_on;) {
      const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
      line_ = bytes_.substr(at_, end - at_);
      if (line_.ends_with('\r')) line_.remove_suffix(1);
      at_ = std::min(end + 1, bytes_.size());
      ++number_;
      goes_on = line_.ends_with('\\') && at_ < bytes_.size();
      if (goes_on || !joined_.empty()) {
        joined_ += line_.substr(0, line_.size() - (goes_on ? 1 : 0));
        joined_ += ' ';
      }
    }
    if (!joined_.empty()) line_ = joined_;
    rest_ = line_;
    input_.passed(at_);
    return true;
  }

  void read_vertex() {
    std::array<double, 3> vertex{};
    for (double& coordinate : vertex) {
      if (!readers::parse_any_number(next_word(rest_), coordinate)) refuse("three numbers behind 'v'");
    }
    if (mesh_.vertices.size() == std::numeric_limits<std::uint32_t>::max())
      refuse("at most 4294967295 vertices");
    mesh_.vertices.push_back(vertex);
  }

  void read_face() {
    const std::size_t begin = mesh_.corners.size();
    for (std::string_view word = next_word(rest_); !word.empty(); word = next_word(rest_)) {
      if (word.starts_with('#')) break;
      mesh_.corners.push_back(vertex_of(word));
    }
    if (mesh_.corners.size() - begin < 3) refuse("at least 3 vertices behind 'f'");
    mesh_.face_ends.push_back(mesh_.corners.size());
  }

  std::uint32_t vertex_of(std::string_view word) const {
    std::int64_t number = 0;
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, number);
    if (error != std::errc() || (end != last && *end != '/')) refuse("whole numbers of vertices behind 'f'");
    if (number < 0) number += static_cast<std::int64_t>(mesh_.vertices.size()) + 1;
    // A vertex number beyond the last may be defined later.
    if (number < 1 || number > std::numeric_limits<std::uint32_t>::max())
      refuse(fmt::format("vertices from 1, or from -{}", mesh_.vertices.size()));
    return static_cast<std::uint32_t>(number - 1);
  }

  [[noreturn]] void refuse(std::string_view expected) const {
    throw FileError(fmt::format("{}:{}: {}; expected {}", input_.name(), number_, shown(line_), expected));
  }

  Input& input_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t number_ = 0;
  std::string_view line_;
  std::string joined_;  // the line, if joined of several
  std::string_view rest_;
  IndexedMesh mesh_;
};

}  // namespace

IndexedMesh read_obj(Input& input) { return ObjReader(input).read(); }

}  // namespace broadside::lab
