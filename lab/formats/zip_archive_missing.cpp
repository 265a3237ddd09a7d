// What stands in for zip archives where libzip was missing at configure time.
#include "lab/formats/format.hpp"
#include "lab/formats/zip_archive.hpp"

namespace broadside::lab {

ZipArchive::ZipArchive(std::string_view, std::string name) : name_(std::move(name)) { refuse(zip_missing()); }

std::string ZipArchive::read(std::size_t) const { refuse(zip_missing()); }

void ZipArchive::refuse(std::string_view found) const { throw FileError(name_ + ": " + std::string(found)); }

std::string zip_missing() {
  return "libzip-dev was missing at configure time; install it and configure again";
}

}  // namespace broadside::lab
