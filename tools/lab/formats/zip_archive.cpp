// Reads zip archives, by libzip.
#include "lab/formats/zip_archive.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include <fmt/format.h>
#include <zip.h>

#include "lab/formats/format.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

/// libzip's description of an error.
class ZipError {
 public:
  ZipError() { zip_error_init(&error_); }
  ~ZipError() { zip_error_fini(&error_); }
  ZipError(const ZipError&) = delete;
  ZipError& operator=(const ZipError&) = delete;

  zip_error_t* get() noexcept { return &error_; }
  std::string text() { return zip_error_strerror(&error_); }

 private:
  zip_error_t error_{};
};

}  // namespace

ZipArchive::ZipArchive(std::string_view bytes, std::string name) : name_(std::move(name)) {
  ZipError error;
  zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, error.get());
  if (source == nullptr) throw std::bad_alloc();
  zip_t* const archive = zip_open_from_source(source, ZIP_RDONLY, error.get());
  if (archive == nullptr) {
    zip_source_free(source);
    refuse(error.text());
  }
  archive_.reset(archive, zip_discard);
  const zip_int64_t count = zip_get_num_entries(archive, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const member = zip_get_name(archive, static_cast<zip_uint64_t>(i), 0);
    members_.emplace_back(member == nullptr ? "" : member);
  }
}

std::string ZipArchive::read(std::size_t member) const {
  zip_file_t* const opened = zip_fopen_index(archive_.get(), member, 0);
  if (opened == nullptr) refuse(fmt::format("{}: {}", shown(members_[member]), zip_strerror(archive_.get())));
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(opened, zip_fclose);
  std::string content;
  while (true) {
    // Reads in growing chunks, so that a forged size allocates nothing.
    const std::size_t used = content.size();
    content.resize(std::max<std::size_t>(2 * used, std::size_t{1} << 16));
    const zip_int64_t got = zip_fread(opened, content.data() + used, content.size() - used);
    if (got < 0) refuse(fmt::format("{}: {}", shown(members_[member]), zip_file_strerror(opened)));
    content.resize(used + static_cast<std::size_t>(got));
    if (got == 0) return content;
  }
}

void ZipArchive::refuse(std::string_view found) const {
  throw FileError(fmt::format("{}: {}; expected a zip archive", name_, found));
}

std::string zip_missing() { return {}; }

}  // namespace broadside::lab
