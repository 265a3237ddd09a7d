// One mesh at two times: the boxes that its vertices, edges and faces sweep.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/elements.hpp"

namespace broadside::lab {

/// Elements of a mesh over the interval between two times.
struct SweptElements {
  MeshElements elements;
  std::vector<DoubleBox3> boxes;  ///< the bounds of each element over both times
};

/// A mesh at two times.
class SweptMesh {
 public:
  /// Two meshes with the same vertices and faces, at different positions. Errors use the names. Throws
  /// FileError, naming both, if they do not match.
  SweptMesh(IndexedMesh before, std::string name_before, IndexedMesh after, std::string name_after);

  /// The elements of a kind, in the order of MeshElements. Throws FileError if an element has coordinates
  /// that are not finite.
  SweptElements swept(MeshPart part) const;

  /// That of the files: double if either is double.
  Precision precision() const noexcept;

  /// The library that read a file and may have rounded its numbers to float; otherwise empty.
  std::string_view importer() const noexcept;

 private:
  IndexedMesh before_;
  IndexedMesh after_;
  std::string name_before_;
  std::string name_after_;
};

/// Reads a mesh at two times from two files. Only the options `format` and `progress` apply: coordinates are
/// as read_mesh() gives them. In PLY, OBJ and OFF, vertices and faces keep their numbers in the files. Throws
/// FileError.
SweptMesh read_swept_mesh(const std::filesystem::path& before, const std::filesystem::path& after,
                          const ReadOptions& options = {});

/// Passes on the pairs whose two elements have no vertex in common. A pair's first is an element of `left`,
/// its second one of `right`, which may be the same object; both and the sink must outlive this one. The
/// caller flushes both sinks.
class ApartPairs final : public PairSink {
 public:
  ApartPairs(const MeshElements& left, const MeshElements& right, PairSink& pairs)
      : left_(left), right_(right), pairs_(pairs) {}

 private:
  void consume(std::span<const Pair> pairs) override;

  const MeshElements& left_;
  const MeshElements& right_;
  PairSink& pairs_;
};

}  // namespace broadside::lab
