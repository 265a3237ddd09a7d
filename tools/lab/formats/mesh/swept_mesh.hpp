// One mesh at two times: the boxes that its vertices, edges and faces sweep between them.
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

/// Elements of a mesh over two times.
struct SweptElements {
  MeshElements elements;
  std::vector<DoubleBox3> boxes;  ///< the bounds of each element at both times
};

/// A mesh at two times.
class SweptMesh {
 public:
  /// Two meshes of the same vertices and faces, at different places; the names are what errors call them.
  /// Throws FileError, naming both, if they are not that.
  SweptMesh(IndexedMesh before, std::string name_before, IndexedMesh after, std::string name_after);

  /// The elements of a part, in the order that MeshElements has. Throws FileError if one is not at finite
  /// coordinates.
  SweptElements swept(MeshPart part) const;

  /// That of the files: double if either is.
  Precision precision() const noexcept;

  /// The library that read a file and may have rounded its numbers to float; empty if none did.
  std::string_view importer() const noexcept;

 private:
  IndexedMesh before_;
  IndexedMesh after_;
  std::string name_before_;
  std::string name_after_;
};

/// Reads a mesh at two times from two files. Of the options, only `format` and `progress` mean something:
/// coordinates are those of the files, as read_mesh() gives them. In PLY, OBJ and OFF, vertices and faces
/// have the numbers that they have in the files. Throws FileError.
SweptMesh read_swept_mesh(const std::filesystem::path& before, const std::filesystem::path& after,
                          const ReadOptions& options = {});

/// Hands on the pairs whose two elements have no vertex in common. A pair's first is an element of `left`,
/// its second one of `right`, which may be one and the same; they and the sink must outlive this one. The
/// caller flushes both.
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
