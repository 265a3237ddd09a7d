// The arguments of `broadside pairs`, and whether they go together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"

#include "cli/options.hpp"
#include "lab/catalogue.hpp"
#include "lab/formats/mesh/swept_mesh.hpp"

namespace broadside::cli {

struct PairsArguments {
  std::vector<std::string> files;
  InputOptions input;
  std::vector<std::string> ids;  // of both files, or of each
  std::string within;
  std::string algorithm{default_algorithm};
  std::string threads{};  ///< empty: as the spec says
  std::string frame;
  std::string output = "-";
  std::string to;
  std::string order = "sorted";
  bool counts = false;
  std::string memory;  // a limit, with which the join works on disk
  std::string work;    // the folder for that
  bool is_swept = false;
  std::string left;  // parts of a swept mesh
  std::string right;
  bool excludes_shared = false;
};

/// The part of a mesh that `text` names. Throws Unusable, naming `option`, if it names none.
lab::MeshPart read_part(const std::string& option, const std::string& text);

/// The distance of --within. Throws Unusable if it is invalid.
double read_distance(const std::string& text);

/// The bytes of --memory. Throws Unusable if it is invalid or too little.
std::uint64_t read_memory(const std::string& text);

/// The algorithm with its number of threads. Throws Unusable if it is not one, or cannot use several.
lab::Entry entry_of(const PairsArguments& arguments, const lab::Catalogue& catalogue);

/// Throws Unusable if the arguments contradict each other, as far as that is known before a file is read.
void check(const PairsArguments& arguments, const lab::Catalogue& catalogue);

}  // namespace broadside::cli
