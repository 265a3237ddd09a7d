// The include rules: which folder may include which headers.
#include "includes.hpp"

#include <algorithm>
#include <filesystem>
#include <regex>

namespace broadside::architecture {
namespace {

/// Permitted includes of the files in a folder and its subfolders: each must match `allowed` completely.
struct Rule {
  std::string_view folder;
  std::string allowed;
};

/// The first rule that matches a path's folder applies.
const std::vector<Rule>& rules() {
  const std::string standard = "<[a-z_0-9]+>";
  const std::string library = standard + R"(|"broadside/[a-z_/]+\.hpp")";
  const std::string core = library + R"(|"core/[a-z_]+\.hpp")";
  const std::string algorithm = core + R"(|"kernels/[a-z_]+\.hpp"|"algorithms/[a-z_]+\.hpp")";
  const std::string find =
      core + R"(|"find/[a-z_]+\.hpp"|"algorithms/registry\.hpp")" +
      R"(|"kernels/(overlap_flags|observed_tests|last_test|round_boxes|squared_distances)\.hpp")";
  const std::string track = find + R"(|"track/[a-z_]+\.hpp"|"kernels/(all_present|boxes_outside)\.hpp")";
  const std::string bindings = library + R"(|"bindings/c/broadside\.h")";
  // Two of the library's inline functions, which need nothing else of it.
  const std::string lab = library + R"(|"lab/[a-z_/0-9]+\.hpp"|"paper/listings/(registry|phases)\.hpp")" +
                          R"(|"src/core/(bit_cast|suggestion)\.hpp"|<(fmt|nlohmann)/.*>|<(sys/)?[a-z]+\.h>)";
  const std::string engines = R"(|<box2d/.*>|<bullet/.*>|<bt[A-Z].*>|<(Bullet|Linear)[A-Z].*>)";
  const std::string peers = R"(|<(CGAL|boost|geos|embree3|tbb|ode|fcl|chipmunk)/.*>|<geos_c\.h>)"
                            R"(|"lab/peers/rust/include/rust_peers\.h")";
  static const std::vector<Rule> list = {
      {"include/broadside/", library},
      {"bindings/any_kind", bindings},
      {"bindings/status_of_exception", bindings},
      {"bindings/c/", bindings + R"(|"bindings/(any_kind|status_of_exception)\.hpp")"},
      {"bindings/wasm/", core + R"(|"module/[a-z_]+\.hpp"|"algorithms/registry\.hpp")" +
                             R"(|"bindings/status_of_exception\.hpp")"},
      {"bindings/python/", library + R"(|"bindings/(python/[a-z]+|any_kind)\.hpp"|<nanobind/.*>)" +
                               R"(|"lab/((advise|formats|report|scenes)/[a-z_]+|catalogue)\.hpp")"},
      // An integration includes its engine.
      {"integrations/bullet/", library + engines},
      {"src/core/tbb_executor", library + R"(|<tbb/[a-z_]+\.h>)"},
      {"src/core/thread_pool", core + R"(|<unistd\.h>)"},
      {"src/core/large_array", core + R"(|<sys/mman\.h>|<unistd\.h>)"},
      {"src/core/float_environment", core + R"(|<[a-z]+intrin\.h>)"},
      {"src/core/input_check", core + R"(|"kernels/all_present\.hpp")"},
      {"src/core/", core},
      {"src/kernels/",
       standard +
           R"(|"broadside/(box|error|executor|pair)\.hpp"|"core/(bit_cast|moved_box|cell_axis|large_array|margins|rounding|sample)\.hpp")" +
           R"(|"kernels/[a-z_]+\.hpp"|<hwy/[a-z_]+\.h>)"},
      {"src/algorithms/registry", core + R"(|"algorithms/registry\.hpp")"},
      {"src/algorithms/", algorithm},
      // It compares few boxes a thousand times in a search; calling a Searcher would cost more.
      {"src/find/group_search", find + R"(|"kernels/sweep\.hpp")"},
      {"src/find/", find},
      {"src/track/", track},
      {"src/world/", track + R"(|"world/[a-z_/]+\.hpp"|"kernels/enlarged_boxes\.hpp")"},
      {"src/debug/", core + R"(|"debug/[a-z_]+\.hpp"|"algorithms/registry\.hpp")"},
      {"tools/paper/listings/",
       library + R"(|"paper/listings/[a-z_0-9]+\.hpp"|"kernels/observed_tests\.hpp")"},
      {"tools/paper/plain/", library + R"(|"paper/plain/plain\.hpp")"},
      {"integrations/fcl/", library + "|<fcl/.*>"},
      {"distributed/out_of_core/",
       library +
           R"(|"(blocks|box_file|distributor|pair_runs|part_files|part_join|sources|work_folder)\.hpp")" +
           R"(|<nlohmann/json\.hpp>|<xxhash\.h>|<(sys/)?[a-z]+\.h>)"},
      {"distributed/mpi/",
       library + R"(|"(communicator|cuts|followed_part|owned_boxes)\.hpp")" + R"(|<mpi\.h>)"},
      {"distributed/include/broadside/distributed_world", library + R"(|<mpi\.h>)"},
      {"distributed/include/broadside/mpi", library + R"(|<mpi\.h>)"},
      {"distributed/", library},
      {"tools/web/playground/engine/",
       library + R"(|"core/(cell_axis|number_text)\.hpp"|"kernels/(find_changes|observed_tests)\.hpp")" +
           R"(|"algorithms/(grid/hierarchical_cells|outline_text)\.hpp")" +
           R"(|"(lab/formats|lab/scenes|paper/listings)/registry\.hpp")" +
           R"(|"lab/formats/(csv/csv_rows|mesh/indexed_mesh|unread_formats)\.hpp")"},
      {"tools/lab/recordings/", lab + engines},
      {"tools/lab/peers/", lab + engines + peers},
      {"tools/lab/literature/", library + R"(|"lab/peers/peer_follower\.hpp"|<hwy/[a-z_]+\.h>)"},
      {"tools/lab/formats/", lab + R"(|<assimp/.*>)"},
      {"tools/lab/measure/streamed_copy", lab + R"(|<hwy/[a-z_]+\.h>)"},
      {"tools/lab/", lab},
      {"tools/cli/", lab + R"(|"paper/plain/plain\.hpp"|"cli/[a-z_]+\.hpp"|<CLI/.*>)"},
      {"tools/bench/distributed/", lab + R"(|"bench/[a-z_]+\.hpp"|<CLI/.*>)"},
      {"tools/bench/engines/", lab + engines +
                                   R"(|"broadside/bullet\.hpp"|"bench/(engines/)?[a-z_]+\.hpp"|<CLI/.*>)" +
                                   R"(|"lab/peers/rust/include/rust_peers\.h")"},
      {"tools/bench/motion/", lab + R"(|"bench/(motion/)?[a-z_]+\.hpp"|<CLI/.*>)"},
      {"tools/bench/worst/", lab + R"(|"bench/(worst/)?[a-z_]+\.hpp"|<CLI/.*>)"},
      {"tools/bench/fcl_manager", lab + R"(|"bench/[a-z_]+\.hpp"|<broadside/fcl\.hpp>|<fcl/.*>)"},
      {"tools/bench/",
       lab +
           R"(|"bench/[a-z_]+\.hpp"|"(core|kernels)/[a-z_]+\.hpp"|<benchmark/benchmark\.h>|<hwy/targets\.h>)"},
      {"examples/record_", R"(<broadside/recorder\.hpp>|"game\.hpp"|)" + standard + engines},
      // Examples include what users would include.
      {"examples/bullet/", standard + R"(|<broadside/[a-z_]+\.hpp>)" + engines},
      {"examples/fcl_", standard + R"(|<broadside/[a-z_]+\.hpp>|<fcl/.*>)"},
      {"examples/", standard + R"(|<broadside/[a-z_]+\.hpp>)"},
      {"tests/integrations/fcl/", library + "|<fcl/.*>|<gtest/.*>|<gmock/.*>"},
      {"tests/consumer/bullet/", standard + R"(|<broadside/bullet\.hpp>)" + engines},
      {"tests/integrations/", library + engines + R"(|<(gmock|gtest)/.*>|"[a-z_]+\.hpp"|"tests/support/.*")"},
      // Tests may use every folder except the bindings, and reach engines and peers only through the lab.
      // CGAL is their oracle.
      {"tests/",
       R"((?!["<](cli/|box2d|bullet|bt[A-Z]|Bullet[A-Z]|assimp|boost/|geos|embree|ode/|fcl/|chipmunk/)).*)"},
  };
  return list;
}

/// Whether `include` names a header in the file's own folder, by its path from `src/`, `tools/` or the
/// project's root.
bool is_in_own_folder(const std::filesystem::path& path, std::string_view include) {
  const std::filesystem::path header(include.substr(1, include.size() - 2));
  const std::string folder = path.parent_path();
  return !header.parent_path().empty() &&
         (folder == header.parent_path() || folder == "src" / header.parent_path() ||
          folder == "tools" / header.parent_path());
}

}  // namespace

std::vector<std::string> includes_of(std::string_view text) {
  static const std::regex directive(R"re((?:^|\n)[ \t]*#[ \t]*include[ \t]*("[^"\n]*"|<[^>\n]*>|\w+))re");
  std::vector<std::string> includes;
  for (std::cregex_iterator match(text.data(), text.data() + text.size(), directive), end; match != end;
       ++match)
    includes.push_back((*match)[1]);
  return includes;
}

std::vector<std::string> breaches(std::string_view path, std::string_view text) {
  const auto rule = std::ranges::find_if(rules(), [&](const Rule& r) { return path.starts_with(r.folder); });
  if (rule == rules().end())
    return {std::string(path) +
            " lies in no folder with a rule; expected one in tests/architecture/includes.cpp"};
  std::vector<std::string> found;
  for (const std::string& include : includes_of(text)) {
    if (std::regex_match(include, std::regex(rule->allowed)) || is_in_own_folder(path, include)) continue;
    found.push_back(std::string(path) + " includes " + include + ", which files in " +
                    std::string(rule->folder) + " may not");
  }
  return found;
}

}  // namespace broadside::architecture
