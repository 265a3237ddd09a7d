// The arguments of `broadside pairs`, and checks of their combinations.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "broadside/algorithm.hpp"

#include "cli/options.hpp"
#include "lab/catalogue.hpp"
#include "lab/formats/mesh/swept_mesh.hpp"

namespace broadside::cli {

struct PairsArguments {
  std::vector<std::string> files;
  InputOptions input;
  std::vector<std::string> ids;  // one for both files, or one for each
  std::string within;
  std::string period;
  bool is_longitude = false;  // whether the first axis is in degrees around the earth
  bool is_euclidean = false;  // how the distance of --within is measured
  bool leaves_out_touching = false;
  std::string algorithm{default_algorithm};
  std::string threads{};  ///< empty: as the spec says
  std::string frame;
  std::string output = "-";
  std::string to;
  std::string order = "sorted";
  bool counts = false;
  std::string same;       // a column or property of keys that must be equal
  std::string different;  // or must not
  bool finds_components = false;
  std::string memory;  // a limit that makes the join work on disk
  std::string work;    // the work folder of such a join
  bool is_swept = false;
  std::string left;  // parts of a swept mesh
  std::string right;
  bool excludes_shared = false;
};

/// Whether the pairs of every frame of a file are found.
inline bool takes_all_frames(const PairsArguments& arguments) { return arguments.frame == "all"; }

/// The part of a mesh that `text` names. Throws Unusable, naming `option`, if there is no such part.
lab::MeshPart read_part(const std::string& option, const std::string& text);

/// The distance of --within. Throws Unusable if it is invalid.
double read_distance(const std::string& text);

/// The periods of --period; none if it is not given. Throws Unusable if one is invalid.
std::vector<double> read_periods(const std::string& text);

/// The bytes of --memory. Throws Unusable if the value is invalid or too small.
std::uint64_t read_memory(const std::string& text);

/// The algorithm with its number of threads. Throws Unusable if there is no such algorithm, or it cannot use
/// several.
lab::Entry entry_of(const PairsArguments& arguments, const lab::Catalogue& catalogue);

/// Throws Unusable for arguments that contradict --same, --different or --components, which `verb` must have.
void check_keys(const CLI::App& verb, const PairsArguments& arguments);
void check_components(const CLI::App& verb, const PairsArguments& arguments);

/// Throws Unusable for contradictory arguments, as far as they can be detected before a file is read.
void check(const PairsArguments& arguments, const lab::Catalogue& catalogue);

}  // namespace broadside::cli
