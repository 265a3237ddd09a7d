// Enforces the layering: no file includes a header that its folder may not use, and every algorithm's file is
// in the registry.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"

#include "includes.hpp"
#include "tests/support/text_of.hpp"

namespace broadside::architecture {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAreArray;

const fs::path project = BROADSIDE_SOURCE_DIR;

bool is_source(const fs::path& path) { return path.extension() == ".cpp" || path.extension() == ".hpp"; }

/// The names under which the subfolders of `folder` should be registered.
std::vector<std::string> names_of_folders(const std::string& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(project / folder)) {
    if (entry.is_directory()) names.push_back(entry.path().filename());
  }
  return names;
}

std::vector<std::string> registered_names(AlgorithmKind kind) {
  std::vector<std::string> names;
  for (const Algorithm& algorithm : algorithms()) {
    if (algorithm.kind == kind) names.push_back(algorithm.name);
  }
  return names;
}

TEST(Architecture, NoFileBreaksTheIncludeRules) {
  std::size_t files = 0;
  for (const char* const folder :
       {"include", "src", "bindings", "integrations", "distributed", "tools", "tests", "examples"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(project / folder)) {
      const fs::path& path = entry.path();
      if (!is_source(path)) continue;
      ++files;
      const std::string name = path.lexically_relative(project).generic_string();
      EXPECT_THAT(breaches(name, text_of(path)), IsEmpty());
    }
  }
  EXPECT_GT(files, 30U) << "the project's files were not found under " << project;
}

TEST(Architecture, EveryAlgorithmsFolderIsInTheRegistryAndTheOtherWayRound) {
  EXPECT_THAT(registered_names(AlgorithmKind::own),
              UnorderedElementsAreArray(names_of_folders("src/algorithms")));
}

TEST(IncludeRules, SeeEveryFormOfInclude) {
  EXPECT_THAT(
      includes_of("#include <vector>\n  #  include \"core/a.hpp\"\n// #include <no>\n#include NAME\nint i;"),
      ElementsAre("<vector>", "\"core/a.hpp\"", "NAME"));
}

TEST(IncludeRules, AllowPermittedIncludes) {
  EXPECT_THAT(breaches("include/broadside/a.hpp", "#include <span>\n#include \"broadside/box.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(breaches("src/kernels/a.cpp", "#include \"broadside/pair.hpp\"\n#include \"kernels/run.hpp\""),
              IsEmpty());
  EXPECT_THAT(breaches("src/algorithms/tree/tree.cpp",
                       "#include \"algorithms/tree/tree.hpp\"\n#include \"algorithms/tree/cells.hpp\"\n"
                       "#include \"algorithms/registry.hpp\"\n#include \"kernels/run.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(breaches("src/find/finder.cpp",
                       "#include \"find/search.hpp\"\n#include \"algorithms/registry.hpp\"\n"
                       "#include \"kernels/last_test.hpp\"\n#include \"core/input_check.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(
      breaches("src/track/tracker.cpp", "#include \"find/search.hpp\"\n#include \"track/updater.hpp\"\n"),
      IsEmpty());
  EXPECT_THAT(
      breaches("src/world/world.cpp", "#include \"find/search.hpp\"\n#include \"track/updater.hpp\"\n"),
      IsEmpty());
  EXPECT_THAT(breaches("tools/lab/recordings/box2d.cpp", "#include <box2d/box2d.h>"), IsEmpty());
  EXPECT_THAT(breaches("tools/lab/peers/embree_collide.cpp",
                       "#include <embree3/rtcore.h>\n#include \"lab/peers/peers.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(
      breaches("examples/record_box2d/main.cpp",
               "#include <box2d/box2d.h>\n#include <broadside/recorder.hpp>\n#include \"game.hpp\"\n"),
      IsEmpty());
  EXPECT_THAT(breaches("tools/cli/main.cpp",
                       "#include <CLI/CLI.hpp>\n#include \"lab/verify.hpp\"\n#include <unistd.h>"),
              IsEmpty());
}

TEST(IncludeRules, CatchEveryKindOfBreach) {
  const struct {
    const char* path;
    const char* include;
  } wrong[] = {
      {"include/broadside/world.hpp", "\"core/radix_sort.hpp\""},
      {"include/broadside/world.hpp", "<fmt/format.h>"},
      {"src/core/spec.cpp", "\"kernels/run.hpp\""},
      {"src/core/spec.cpp", "\"algorithms/registry.hpp\""},
      {"src/kernels/sweep.cpp", "\"broadside/algorithm.hpp\""},
      {"src/kernels/sweep.cpp", "\"core/parallel.hpp\""},
      {"src/algorithms/grid/grid.cpp", "\"algorithms/quadtree/quadtree_nodes.hpp\""},
      {"src/algorithms/grid/grid.cpp", "\"paper/listings/world.hpp\""},
      {"src/algorithms/grid/grid.cpp", "\"layout.hpp\""},
      {"src/algorithms/registry.cpp", "\"paper/listings/registry.hpp\""},
      {"tools/paper/listings/grid.cpp", "\"algorithms/grid/grid_layout.hpp\""},
      {"tools/paper/listings/grid.cpp", "\"algorithms/outline_text.hpp\""},
      {"tools/paper/listings/grid.cpp", "\"lab/verify/verify.hpp\""},
      {"src/algorithms/registry.cpp", "\"algorithms/quadtree/quadtree_nodes.hpp\""},
      {"distributed/plan/partition.cpp", "\"core/sort_pairs.hpp\""},
      {"distributed/out_of_core/out_of_core.cpp", "\"communicator.hpp\""},
      {"distributed/include/broadside/partition.hpp", "<mpi.h>"},
      {"distributed/mpi/find_pairs.cpp", "\"core/radix_sort.hpp\""},
      {"src/world/world.cpp", "\"lab/verify/verify.hpp\""},
      {"src/world/world.cpp", "\"kernels/run.hpp\""},
      {"src/find/finder.cpp", "\"track/updater.hpp\""},
      {"src/find/finder.cpp", "\"kernels/sweep.hpp\""},
      {"src/find/finder.cpp", "\"algorithms/grid/grid_layout.hpp\""},
      {"src/track/tracker.cpp", "\"world/world.hpp\""},
      {"src/track/tracker.cpp", "\"algorithms/followers.hpp\""},
      {"src/algorithms/grid/grid.cpp", "\"find/search.hpp\""},
      {"src/algorithms/auto/auto.cpp", "\"track/update_policy.hpp\""},
      {"src/algorithms/registry.cpp", "\"find/search.hpp\""},
      {"src/core/input_check.cpp", "\"find/search.hpp\""},
      {"tools/lab/verify/verify.cpp", "\"core/input_check.hpp\""},
      {"tools/lab/verify/verify.cpp", "\"../src/core/input_check.hpp\""},
      {"tools/lab/verify/verify.cpp", "\"cli/compare.hpp\""},
      {"tools/lab/verify/verify.cpp", "<box2d/box2d.h>"},
      {"tools/lab/scenes/scene.cpp", "<bullet/btBulletDynamicsCommon.h>"},
      {"tools/lab/recordings/box2d.cpp", "<chipmunk/chipmunk.h>"},
      {"tools/lab/catalogue.cpp", "<boost/geometry.hpp>"},
      {"tools/lab/peers/geos_strtree.cpp", "<assimp/scene.h>"},
      {"tools/lab/recordings/box2d.cpp", "<assimp/scene.h>"},
      {"tools/lab/formats/mesh/mesh.cpp", "<box2d/box2d.h>"},
      {"tools/cli/main.cpp", "\"core/input_check.hpp\""},
      {"examples/own_algorithm/main.cpp", "\"core/radix_sort.hpp\""},
      {"examples/own_algorithm/main.cpp", "\"lab/catalogue.hpp\""},
      {"examples/own_algorithm/main.cpp", "<box2d/box2d.h>"},
      {"examples/record_box2d/main.cpp", "<broadside/broadside.hpp>"},
      {"tests/tools/lab/cli_test.cpp", "\"cli/compare.hpp\""},
      {"tests/tools/lab/engine_test.cpp", "<box2d/box2d.h>"},
      {"tests/laws/oracle_test.cpp", "<embree3/rtcore.h>"},
  };
  for (const auto& [path, include] : wrong) {
    const std::string text = "// A file.\n#include <vector>\n#include " + std::string(include) + "\n";
    EXPECT_THAT(breaches(path, text), ElementsAre(HasSubstr(include))) << path;
  }
}

TEST(IncludeRules, CatchAFileInAFolderWithoutARule) {
  EXPECT_THAT(breaches("attic/old.cpp", ""), ElementsAre(HasSubstr("attic/old.cpp")));
}

}  // namespace
}  // namespace broadside::architecture
