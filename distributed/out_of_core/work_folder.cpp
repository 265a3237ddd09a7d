// The work folder of a join: a manifest in JSON, a lock, and files for each part's boxes and pairs.
#include "work_folder.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <regex>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "broadside/out_of_core.hpp"

#include "blocks.hpp"

namespace broadside::out_of_core {
namespace {

constexpr const char* schema = "broadside.out_of_core/1";
constexpr const char* manifest_name = "manifest.json";
constexpr const char* new_manifest_name = "manifest.json.new";
constexpr const char* lock_name = "join.lock";

// JSON has no infinities.
nlohmann::json json_of(const std::vector<double>& bounds) {
  nlohmann::json json = nlohmann::json::array();
  for (const double bound : bounds)
    json.push_back(std::isfinite(bound) ? nlohmann::json(bound) : nlohmann::json());
  return json;
}

std::vector<double> bounds_of(const nlohmann::json& json, double where_null) {
  std::vector<double> bounds;
  for (const nlohmann::json& bound : json)
    bounds.push_back(bound.is_null() ? where_null : bound.get<double>());
  return bounds;
}

/// Whether a file of this name belongs to a part. No other files are ever removed.
bool is_of_a_part(const std::string& name) {
  static const std::regex pattern(
      R"([0-9]+(\.[0-9]+)*\.((left|right)\.boxes|[0-9]+\.pairs)|merged\.[0-9]+\.pairs)");
  return std::regex_match(name, pattern);
}

bool is_of_a_join(const std::string& name) {
  return name == manifest_name || name == new_manifest_name || name == lock_name || is_of_a_part(name);
}

std::string checksum_text(const nlohmann::json& json) {
  const std::string text = json.dump();
  return std::to_string(checksum_of(std::as_bytes(std::span(text))));
}

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, const std::string& why) {
  throw OutOfCoreError(path.string() + ": " + what + ": " + why);
}

}  // namespace

WorkFolder::WorkFolder(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (!std::filesystem::is_directory(path_, error))
    throw OutOfCoreError(path_.string() +
                         ": is no folder and cannot be created as one; expected a folder to work in");
  for (std::filesystem::directory_iterator entry(path_, error), end; !error && entry != end;
       entry.increment(error)) {
    if (const std::string name = entry->path().filename().string(); !is_of_a_join(name))
      throw OutOfCoreError(path_.string() + ": holds " + name +
                           "; expected an empty folder, or the work folder of a join");
  }
  if (error) fail(path_, "cannot be listed", error.message());
  lock();
}

void WorkFolder::lock() {
  const std::filesystem::path path = path_ / lock_name;
  while (true) {
    lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ < 0) fail(path, "cannot be written", std::strerror(errno));
    // The kernel releases the lock when the process ends, however it ends. Host names and clocks are
    // irrelevant.
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      const int why = errno;
      ::close(std::exchange(lock_, -1));
      if (why != EWOULDBLOCK) fail(path_, "cannot be locked", std::strerror(why));
      throw OutOfCoreError(path_.string() + ": another join is using this folder; expected one at a time");
    }
    // A join that has just ended may have removed the locked file.
    struct stat locked {};
    struct stat present {};
    if (::fstat(lock_, &locked) == 0 && ::stat(path.c_str(), &present) == 0 &&
        locked.st_ino == present.st_ino)
      return;
    ::close(std::exchange(lock_, -1));
  }
}

WorkFolder::~WorkFolder() {
  if (lock_ >= 0) ::close(lock_);
}

std::optional<Manifest> WorkFolder::read(std::size_t dimension) const {
  const std::filesystem::path path = path_ / manifest_name;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    if (error) fail(path, "cannot be read", error.message());
    return std::nullopt;
  }
  std::ifstream stream(path);
  if (!stream) fail(path, "cannot be read", std::strerror(errno));
  const auto refuse = [&path](const std::string& found) {
    throw OutOfCoreError(path.string() + ": " + found +
                         "; expected what a join wrote. Remove the folder to start over");
  };
  Manifest manifest;
  try {
    nlohmann::json json = nlohmann::json::parse(stream);
    const auto found = json.at("schema").get<std::string>();
    if (found != schema) refuse("schema " + found + " instead of " + schema);
    const std::string checksum = json.at("checksum");
    json.erase("checksum");
    if (checksum != checksum_text(json)) refuse("is damaged: its checksum is not that of its text");
    manifest.kind = json.at("kind");
    manifest.identity = json.at("identity");
    manifest.is_read = json.at("is_read");
    manifest.boxes = json.at("boxes");
    manifest.has_large_ids = json.at("has_large_ids");
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const nlohmann::json& part : json.at("parts")) {
      manifest.parts.push_back({.name = part.at("name"),
                                .low = bounds_of(part.at("low"), -infinity),
                                .high = bounds_of(part.at("high"), infinity),
                                .boxes = part.at("boxes"),
                                .blocks = part.at("blocks"),
                                .is_whole = part.at("is_whole"),
                                .is_joined = part.at("is_joined"),
                                .pairs = part.at("pairs"),
                                .runs = part.at("runs")});
      const PartRecord& read = manifest.parts.back();
      if (read.low.size() != dimension || read.high.size() != dimension)
        refuse("part " + read.name + " has " + std::to_string(read.low.size()) + " bounds instead of " +
               std::to_string(dimension));
    }
  } catch (const nlohmann::json::exception& caught) {
    refuse(std::string("cannot be read: ") + caught.what());
  }
  return manifest;
}

void WorkFolder::write(const Manifest& manifest) const {
  nlohmann::json parts = nlohmann::json::array();
  for (const PartRecord& part : manifest.parts)
    parts.push_back({{"name", part.name},
                     {"low", json_of(part.low)},
                     {"high", json_of(part.high)},
                     {"boxes", part.boxes},
                     {"blocks", part.blocks},
                     {"is_whole", part.is_whole},
                     {"is_joined", part.is_joined},
                     {"pairs", part.pairs},
                     {"runs", part.runs}});
  nlohmann::json json = {{"schema", schema},
                         {"kind", manifest.kind},
                         {"identity", manifest.identity},
                         {"is_read", manifest.is_read},
                         {"boxes", manifest.boxes},
                         {"has_large_ids", manifest.has_large_ids},
                         {"parts", std::move(parts)}};
  json["checksum"] = checksum_text(json);
  const std::filesystem::path path = path_ / new_manifest_name;
  std::ofstream stream(path);
  stream << json.dump() << '\n';
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(path, path_ / manifest_name, error);
  if (!stream || error)
    fail(path, "cannot be written", error ? error.message() : std::string(std::strerror(errno)));
}

std::filesystem::path WorkFolder::box_file(const PartRecord& part, std::size_t side) const {
  return path_ / (part.name + (side == 0 ? ".left.boxes" : ".right.boxes"));
}

std::filesystem::path WorkFolder::pair_file(const PartRecord& part, std::size_t run) const {
  return path_ / (part.name + "." + std::to_string(run) + ".pairs");
}

std::filesystem::path WorkFolder::merged_file(std::size_t number) const {
  return path_ / ("merged." + std::to_string(number) + ".pairs");
}

void WorkFolder::remove_boxes(const PartRecord& part, std::size_t side) const {
  std::error_code error;
  std::filesystem::remove(box_file(part, side), error);
  if (error) fail(box_file(part, side), "cannot be removed", error.message());
}

void WorkFolder::remove_others(const Manifest& manifest) const {
  std::set<std::string> needed;
  for (const PartRecord& part : manifest.parts) {
    if (!part.is_joined) {
      needed.insert(box_file(part, 0).filename());
      needed.insert(box_file(part, 1).filename());
    }
    for (std::size_t run = 0; run < part.runs.size(); ++run) needed.insert(pair_file(part, run).filename());
  }
  std::error_code error;
  std::vector<std::filesystem::path> others;
  for (std::filesystem::directory_iterator entry(path_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (is_of_a_part(name) && !needed.contains(name)) others.push_back(entry->path());
  }
  for (const std::filesystem::path& other : others)
    if (!error) std::filesystem::remove(other, error);
  if (error) fail(path_, "cannot be cleared", error.message());
}

void WorkFolder::remove() noexcept {
  try {
    remove_others({});
    std::error_code error;
    for (const char* const name : {manifest_name, new_manifest_name, lock_name})
      std::filesystem::remove(path_ / name, error);
    std::filesystem::remove(path_, error);
  } catch (const std::exception&) {
    // Files that cannot be removed stay; the join is done.
  }
}

// A path may be any bytes, but JSON must be UTF-8.
std::string identity_text(const std::string& identity) {
  std::string escaped;
  for (const char c : identity) {
    constexpr std::string_view digits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f && c != '%')
      escaped += c;
    else
      escaped += {'%', digits[byte / 16], digits[byte % 16]};
  }
  return escaped;
}

}  // namespace broadside::out_of_core
