// Which file may include what: each floor of the house only the one below.
#include "includes.hpp"

#include <algorithm>
#include <filesystem>
#include <regex>

namespace broadside::architecture {
namespace {

/// What the files in a folder (and the folders in it) may include: texts that match `allowed` from end to
/// end.
struct Rule {
  std::string_view folder;
  std::string allowed;
};

/// The first rule whose folder a path lies in is the one that counts.
const std::vector<Rule>& rules() {
  const std::string standard = "<[a-z_0-9]+>";
  const std::string library = standard + R"(|"broadside/[a-z_]+\.hpp")";
  const std::string inner = library + R"(|"(core|kernels)/[a-z_]+\.hpp")";
  const std::string lab = library + R"(|"lab/[a-z_/0-9]+\.hpp"|<(fmt|nlohmann)/.*>|<(sys/)?[a-z]+\.h>)";
  const std::string engines = R"(|<box2d/.*>|<bullet/.*>|<bt[A-Z].*>|<(Bullet|Linear)[A-Z].*>)";
  const std::string peers = R"(|<(CGAL|boost|geos|embree3|tbb|ode|fcl|chipmunk)/.*>|<geos_c\.h>)";
  static const std::vector<Rule> list = {
      {"include/broadside/", library},
      {"src/core/tbb_executor", library + R"(|<tbb/[a-z_]+\.h>)"},
      {"src/core/float_environment", library + R"(|"core/[a-z_]+\.hpp"|<[a-z]+intrin\.h>)"},
      {"src/core/", library + R"(|"core/[a-z_]+\.hpp")"},
      {"src/kernels/",
       standard +
           R"(|"broadside/(box|error|instruction_set|pair)\.hpp"|"kernels/[a-z_]+\.hpp"|<hwy/[a-z_]+\.h>)"},
      {"src/algorithms/", inner + R"(|"algorithms/descriptions\.hpp")"},
      {"src/paper/", inner + R"(|"paper/(descriptions|shared/[a-z_0-9]+)\.hpp")"},
      {"src/double_follower", inner + R"(|"(double_follower|algorithms/hierarchical_grid_tracker)\.hpp")"},
      {"src/segment_join", inner + R"(|"segment_join\.hpp")"},
      {"src/", library + R"(|"core/[a-z_]+\.hpp"|"(algorithms|paper)/descriptions\.hpp")" +
                   R"(|"(auto_tracker|double_follower|segment_join|world_state)\.hpp")"},
      {"lab/recordings/", lab + engines},
      {"lab/peers/", lab + engines + peers},
      {"lab/readers/", lab + "|<assimp/.*>"},
      {"lab/", lab},
      {"cli/", lab + R"(|"cli/[a-z_]+\.hpp"|<CLI/.*>)"},
      {"bench/motion/", lab + R"(|"bench/motion/[a-z_]+\.hpp"|<CLI/.*>)"},
      {"bench/worst/", lab + R"(|"bench/worst/[a-z_]+\.hpp"|<CLI/.*>)"},
      {"bench/", lab + R"(|"(core|kernels)/[a-z_]+\.hpp"|<benchmark/benchmark\.h>|<hwy/targets\.h>)"},
      {"examples/record_", R"(<broadside/recorder\.hpp>|"game\.hpp"|)" + standard + engines},
      // As a user writes it.
      {"examples/", standard + R"(|<broadside/[a-z_]+\.hpp>)"},
      // Tests look into every room but the faces, and at the engines and the peers through the lab alone;
      // CGAL is their oracle.
      {"tests/",
       R"((?!["<](cli/|box2d|bullet|bt[A-Z]|Bullet[A-Z]|assimp|boost/|geos|embree|ode/|fcl/|chipmunk/)).*)"},
  };
  return list;
}

/// Whether `include` is a header of the file's own: one folder, and the name of one begins that of the other
/// ("algorithms/grid_layout.hpp" from grid.cpp), or they differ in the last word (from grid_sweep.cpp).
bool is_own_header(const std::filesystem::path& path, std::string_view include) {
  const std::filesystem::path header(include.substr(1, include.size() - 2));
  if (path.parent_path().filename() != header.parent_path()) return false;
  const std::string file = path.stem();
  const std::string own = header.stem();
  const auto family = [](const std::string& name) { return name.substr(0, name.rfind('_')); };
  return file == own || file.starts_with(own + "_") || own.starts_with(file + "_") ||
         (family(file) != file && family(own) != own && family(file) == family(own));
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
    if (std::regex_match(include, std::regex(rule->allowed)) || is_own_header(path, include)) continue;
    found.push_back(std::string(path) + " includes " + include + ", which files in " +
                    std::string(rule->folder) + " may not");
  }
  return found;
}

}  // namespace broadside::architecture
