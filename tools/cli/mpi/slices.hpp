// Files read by several ranks: each rank has a slice of the boxes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "cli/message.hpp"
#include "cli/mpi/ranks.hpp"
#include "lab/formats/format.hpp"

namespace broadside::cli {

/// Tells whether two ranks see the same file.
struct FileIdentity {
  std::uint64_t bytes = 0;
  std::uint64_t rows = 0;    ///< 0 if not known before the file is read
  std::uint64_t sample = 0;  ///< a hash (FNV-1a) of some of the bytes
};

/// A file, how it is read, and its description by rank 0.
struct SlicedFile {
  /// Takes the read options. Rounding to float happens after reading, as in `broadside pairs`, so that it is
  /// counted.
  SlicedFile(std::string file, lab::ReadOptions read_options)
      : path(std::move(file)),
        options(std::move(read_options)),
        is_rounded(options.precision == lab::Precision::float32) {
    if (is_rounded) options.precision.reset();
  }

  std::string path;
  lab::ReadOptions options;
  bool is_rounded;
  std::optional<lab::BoxFile> opened{};  ///< kept open on rank 0, because a pipe cannot be opened again
  int dimension = 2;
  lab::Precision precision = lab::Precision::float32;
  bool has_slices =
      false;  ///< each rank reads its own slice; otherwise rank 0 reads all and distributes them
  FileIdentity identity{};  ///< only if there are slices
};

inline void open(SlicedFile& file) {
  file.opened.emplace(lab::open_file(file.path, file.options));
  if (file.is_rounded)
    file.opened->frames =
        lab::with_precision(std::move(file.opened->frames), lab::Precision::float32, file.opened->name);
}

inline bool take_slice(lab::BoxFile& file) {
  return std::visit(
      [](auto& frames) {
        return frames->take_slice(static_cast<std::size_t>(rank()), static_cast<std::size_t>(ranks()));
      },
      file.frames);
}

/// Hash of blocks spread evenly over a file; of the whole file up to 256 KiB.
inline std::uint64_t sample_of(const std::string& path, std::uint64_t bytes) {
  constexpr std::uint64_t blocks = 64;
  constexpr std::uint64_t block_bytes = 4096;
  std::ifstream stream(path, std::ios::binary);
  std::array<char, block_bytes> block{};
  std::uint64_t hash = 0xcbf29ce484222325;
  const std::uint64_t step = std::max(block_bytes, bytes / blocks);
  for (std::uint64_t begin = 0; begin < bytes; begin += step) {
    const std::uint64_t size = std::min(block_bytes, bytes - begin);
    stream.seekg(static_cast<std::streamoff>(begin));
    if (!stream.read(block.data(), static_cast<std::streamsize>(size)))
      throw Unusable(fmt::format("{}: cannot read byte {}; expected {} bytes", path, begin, bytes));
    for (const char c : std::span(block).first(static_cast<std::size_t>(size)))
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return hash;
}

/// Identity of an open file, before its slice is taken.
inline FileIdentity identity_of(const SlicedFile& file) {
  FileIdentity identity;
  identity.bytes = std::filesystem::file_size(file.path);
  identity.rows =
      std::visit([](const auto& frames) { return frames->estimated_boxes(); }, file.opened->frames);
  identity.sample = sample_of(file.path, identity.bytes);
  return identity;
}

/// Throws Unusable if this rank has opened another file than rank 0, such as a stale copy on its machine.
/// Slices of different files would overlap or leave gaps.
inline void check_same_file(const SlicedFile& file) {
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw Unusable(
        fmt::format("rank {} finds {} in {}; expected {} as on rank 0", rank(), found, file.path, expected));
  };
  const FileIdentity found = identity_of(file);
  if (found.bytes != file.identity.bytes)
    refuse(fmt::format("{} bytes", found.bytes), std::to_string(file.identity.bytes));
  if (const int dimension = lab::dimension_of(file.opened->frames); dimension != file.dimension)
    refuse(fmt::format("boxes in {}D", dimension), fmt::format("{}D", file.dimension));
  if (const lab::Precision precision = lab::precision_of_frames(file.opened->frames);
      precision != file.precision)
    refuse(std::string(lab::name(precision)), std::string(lab::name(file.precision)));
  if (found.rows != file.identity.rows)
    refuse(fmt::format("{} rows", found.rows), std::to_string(file.identity.rows));
  if (found.sample != file.identity.sample)
    throw Unusable(fmt::format("rank {} finds other content in {} than rank 0; expected the same file",
                               rank(), file.path));
}

/// Lets rank 0 open the file and describe it to all ranks. Pipes and compressed files have no slices: only
/// one process can read a pipe, and a compressed file can be read only from its beginning.
inline void look_at(SlicedFile& file) {
  on_all([&] {
    if (rank() != 0) return;
    open(file);
    file.dimension = lab::dimension_of(file.opened->frames);
    file.precision = lab::precision_of_frames(file.opened->frames);
    const bool is_regular = file.path != "-" && std::filesystem::is_regular_file(file.path);
    if (is_regular && lab::compression_extension_of(file.path).empty()) {
      file.identity = identity_of(file);
      file.has_slices = take_slice(*file.opened);
    }
  });
  broadcast(&file.dimension, sizeof(file.dimension));
  broadcast(&file.precision, sizeof(file.precision));
  broadcast(&file.has_slices, sizeof(file.has_slices));
  broadcast(&file.identity, sizeof(file.identity));
}

/// The boxes of the first frame, or of the slice, with coordinates of type Real.
template <int D, typename Real>
std::vector<Box<D, Real>> read_first(lab::BoxFile file) {
  const lab::AnyFrameReader any =
      lab::with_precision(std::move(file.frames), lab::precision_of<Real>, file.name);
  lab::FrameReader<D, Real>& frames = *std::get<std::unique_ptr<lab::FrameReader<D, Real>>>(any);
  std::vector<Box<D, Real>> boxes = frames.first();
  say_lines(frames.warning());
  if (lab::Step<D, Real> step; rank() == 0 && frames.next(step))
    say(fmt::format("{}: holds several frames; these are the pairs of the first", file.name));
  return boxes;
}

/// Gives each rank its slice of the boxes that rank 0 has read.
template <int D, typename Real>
void send_out(std::vector<Box<D, Real>>& boxes) {
  std::uint64_t all = boxes.size();
  broadcast(&all, sizeof(all));
  const auto count = static_cast<std::uint64_t>(ranks());
  const auto begin_of = [&](int of_rank) {
    const auto number = static_cast<std::uint64_t>(of_rank);
    return all / count * number + std::min(number, all % count);
  };
  const std::uint64_t own = begin_of(rank() + 1) - begin_of(rank());
  on_all([&] {
    if (rank() != 0) boxes.resize(own);
  });
  if (rank() != 0) {
    receive(boxes.data(), own * sizeof(Box<D, Real>), 0);
    return;
  }
  for (int to = 1; to < ranks(); ++to)
    send(boxes.data() + begin_of(to), (begin_of(to + 1) - begin_of(to)) * sizeof(Box<D, Real>), to);
  boxes.resize(own);
}

/// This rank's slice of the file's boxes. Call it once.
template <int D, typename Real>
std::vector<Box<D, Real>> read_slice(SlicedFile& file) {
  std::vector<Box<D, Real>> boxes;
  on_all([&] {
    if (rank() != 0 && !file.has_slices) return;
    if (rank() != 0) {
      open(file);
      check_same_file(file);
      if (!take_slice(*file.opened))
        throw Unusable(
            fmt::format("{}: rank {} cannot read a slice; expected the same file as on rank 0, which can",
                        file.path, rank()));
    }
    boxes = read_first<D, Real>(std::move(*file.opened));
    file.opened.reset();
  });
  if (!file.has_slices) send_out(boxes);
  return boxes;
}

}  // namespace broadside::cli
