// Pair files: CSV, or a NumPy array of n x 2 numbers.
#include "lab/pair_file.hpp"

#include <array>
#include <charconv>

#include <fmt/format.h>

#include "lab/formats/csv/csv_text.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/write_file.hpp"

namespace broadside::lab {
namespace {

constexpr std::size_t bytes_per_piece = std::size_t{1} << 16;

template <typename Number>
void append(std::string& text, Number number, const std::vector<std::string>* ids, char end) {
  if (ids != nullptr) {
    readers::append_csv_field(text, (*ids)[number]);
    text += end;
    return;
  }
  std::array<char, 21> digits;
  char* const after = std::to_chars(digits.data(), digits.data() + 20, number).ptr;
  *after = end;
  text.append(digits.data(), after + 1);
}

}  // namespace

PairFormat pair_format_of(const std::filesystem::path& path, std::string_view name) {
  if (name == "csv") return PairFormat::csv;
  if (name == "npy") return PairFormat::npy;
  if (!name.empty())
    throw FileError(fmt::format("{}: '{}' is no format for pairs; expected csv or npy", path.string(), name));
  const std::string extension = path.extension().string();
  if (extension == ".npy") return PairFormat::npy;
  if (extension == ".csv" || (extension.empty() && is_written_directly(path))) return PairFormat::csv;
  throw FileError(fmt::format("{}: extension '{}' is of no format for pairs; expected .csv or .npy",
                              path.string(), extension));
}

PairFile::PairFile(std::ostream& stream, PairFormat format, bool is_between, PairIds ids,
                   bool has_large_numbers, std::string_view header, std::size_t columns)
    : stream_(stream), ids_(ids) {
  if (format == PairFormat::npy)
    array_.emplace(stream, has_large_numbers ? "u8" : "u4", columns);
  else if (!header.empty())
    text_ = header;
  else
    text_ = is_between ? "left,right\n" : "first,second\n";
}

void PairFile::write(std::span<const Pair> pairs) {
  static_assert(sizeof(Pair) == 2 * sizeof(std::uint32_t));
  if (array_) return array_->write(pairs);
  for (const Pair pair : pairs) {
    append(text_, index(pair.first), ids_.left, ',');
    append(text_, index(pair.second), ids_.right, '\n');
    if (text_.size() >= bytes_per_piece) write_text();
  }
}

void PairFile::write(std::span<const std::array<std::uint64_t, 2>> pairs) {
  if (array_) return array_->write(pairs);
  for (const std::array<std::uint64_t, 2>& pair : pairs) {
    append(text_, pair[0], ids_.left, ',');
    append(text_, pair[1], ids_.right, '\n');
    if (text_.size() >= bytes_per_piece) write_text();
  }
}

void PairFile::write(std::size_t frame, std::span<const Pair> pairs) {
  using Row = std::array<std::uint32_t, 3>;
  for (const Pair pair : pairs) {
    const Row row = {static_cast<std::uint32_t>(frame), index(pair.first), index(pair.second)};
    if (array_) {
      array_->write(std::span<const Row>(&row, 1));
      continue;
    }
    for (std::size_t i = 0; i < row.size(); ++i) append(text_, row[i], nullptr, i < 2 ? ',' : '\n');
    if (text_.size() >= bytes_per_piece) write_text();
  }
}

void PairFile::finish() {
  if (array_)
    array_->finish();
  else
    write_text();
}

void PairFile::write_text() {
  stream_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
  text_.clear();
}

}  // namespace broadside::lab
