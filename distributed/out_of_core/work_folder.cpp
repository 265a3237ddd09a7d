// The work folder of a join: a manifest in JSON, a lock, and files for each part's boxes and pairs.
#include "work_folder.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

#include "broadside/out_of_core.hpp"

namespace broadside::out_of_core {
namespace {

constexpr const char* schema = "broadside.out_of_core/1";
constexpr const char* manifest_name = "manifest.json";
constexpr const char* new_manifest_name = "manifest.json.new";
constexpr const char* lock_name = "lock";

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

bool is_of_a_part(const std::string& name) { return name.ends_with(".boxes") || name.ends_with(".pairs"); }

}  // namespace

WorkFolder::WorkFolder(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  std::filesystem::create_directories(path_, error);
  if (!std::filesystem::is_directory(path_, error))
    throw OutOfCoreError(path_.string() +
                         ": is no folder and cannot be created as one; expected a folder to work in");
  const std::filesystem::path lock = path_ / lock_name;
  lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) throw OutOfCoreError(lock.string() + ": cannot be written: " + std::strerror(errno));
  // The kernel releases the lock when the process ends, however it ends. Host names and clocks play no part.
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  const int why = errno;
  ::close(lock_);
  throw OutOfCoreError(path_.string() + (why == EWOULDBLOCK
                                             ? ": another join is using this folder; expected one at a time"
                                             : std::string(": cannot be locked: ") + std::strerror(why)));
}

WorkFolder::~WorkFolder() {
  if (lock_ >= 0) ::close(lock_);
}

std::optional<Manifest> WorkFolder::read() const {
  const std::filesystem::path path = path_ / manifest_name;
  std::ifstream stream(path);
  if (!stream) return std::nullopt;
  Manifest manifest;
  try {
    const nlohmann::json json = nlohmann::json::parse(stream);
    const auto found = json.at("schema").get<std::string>();
    if (found != schema)
      throw OutOfCoreError(path.string() + ": schema " + found + "; expected " + schema +
                           ", or a folder without a join");
    manifest.kind = json.at("kind");
    manifest.identity = json.at("identity");
    manifest.boxes = json.at("boxes");
    manifest.has_large_ids = json.at("has_large_ids");
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const nlohmann::json& part : json.at("parts"))
      manifest.parts.push_back({.name = part.at("name"),
                                .low = bounds_of(part.at("low"), -infinity),
                                .high = bounds_of(part.at("high"), infinity),
                                .boxes = part.at("boxes"),
                                .blocks = part.at("blocks"),
                                .is_whole = part.at("is_whole"),
                                .is_joined = part.at("is_joined"),
                                .pairs = part.at("pairs"),
                                .runs = part.at("runs")});
  } catch (const nlohmann::json::exception& error) {
    throw OutOfCoreError(path.string() + ": cannot be read: " + error.what() +
                         "; expected what a join wrote. Remove the folder to begin anew");
  }
  return manifest;
}

void WorkFolder::write(const Manifest& manifest) const {
  nlohmann::json parts = nlohmann::json::array();
  for (const Part& part : manifest.parts)
    parts.push_back({{"name", part.name},
                     {"low", json_of(part.low)},
                     {"high", json_of(part.high)},
                     {"boxes", part.boxes},
                     {"blocks", part.blocks},
                     {"is_whole", part.is_whole},
                     {"is_joined", part.is_joined},
                     {"pairs", part.pairs},
                     {"runs", part.runs}});
  const nlohmann::json json = {{"schema", schema},
                               {"kind", manifest.kind},
                               {"identity", manifest.identity},
                               {"boxes", manifest.boxes},
                               {"has_large_ids", manifest.has_large_ids},
                               {"parts", std::move(parts)}};
  const std::filesystem::path path = path_ / new_manifest_name;
  std::ofstream stream(path);
  stream << json.dump() << '\n';
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(path, path_ / manifest_name, error);
  if (!stream || error)
    throw OutOfCoreError(path.string() + ": cannot be written: " +
                         (error ? error.message() : std::string(std::strerror(errno))));
}

std::filesystem::path WorkFolder::box_file(const Part& part, std::size_t side) const {
  return path_ / (part.name + (side == 0 ? ".left.boxes" : ".right.boxes"));
}

std::filesystem::path WorkFolder::pair_file(const Part& part, std::size_t run) const {
  return path_ / (part.name + "." + std::to_string(run) + ".pairs");
}

void WorkFolder::remove_others(const Manifest& manifest) const {
  std::set<std::string> needed;
  for (const Part& part : manifest.parts) {
    if (!part.is_joined) {
      needed.insert(box_file(part, 0).filename());
      needed.insert(box_file(part, 1).filename());
    }
    for (std::size_t run = 0; run < part.runs.size(); ++run) needed.insert(pair_file(part, run).filename());
  }
  std::vector<std::filesystem::path> others;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    const std::string name = entry.path().filename().string();
    if (is_of_a_part(name) && !needed.contains(name)) others.push_back(entry.path());
  }
  for (const std::filesystem::path& other : others) std::filesystem::remove(other);
}

void WorkFolder::remove() {
  std::error_code error;
  remove_others({});
  for (const char* const name : {manifest_name, new_manifest_name, lock_name})
    std::filesystem::remove(path_ / name, error);
  std::filesystem::remove(path_, error);
}

}  // namespace broadside::out_of_core
