# Fails unless COMPILER refuses code that the headers in INCLUDE do not take, by one error. What it prints must name
# `what`, a regular expression, in at most max_lines lines, of which one names the header below. FOLDER is for the code.
set(max_lines 18)  # clang++ takes a line for each file of the chain of includes
# Compiled once for all: g++ and clang++ look for the precompiled header beside the header.
file(WRITE ${FOLDER}/headers.hpp "#include <broadside/broadside.hpp>\n#include <broadside/recorder.hpp>\n")
execute_process(COMMAND ${COMPILER} -std=c++20 -I ${INCLUDE} -x c++-header ${FOLDER}/headers.hpp -o ${FOLDER}/headers.hpp.gch
  COMMAND_ERROR_IS_FATAL ANY)
function(expect_refusal code what)
  file(WRITE ${FOLDER}/refused.cpp "
using namespace broadside;
struct Thing { Box2 box; int name; };
std::vector<int> ints;
std::vector<Thing> things;
std::vector<Box2> boxes;
std::vector<Box3> solids;
std::vector<DoubleBox2> doubles;
World2 game;
std::vector<Handle> handles;
std::vector<HandlePair> pairs;
PairCounter counter;
BoxIndex<2> boxes_index;
void refused() { ${code} }
")
  execute_process(COMMAND ${COMPILER} -std=c++20 -fsyntax-only -I ${INCLUDE} -include ${FOLDER}/headers.hpp ${FOLDER}/refused.cpp
    ERROR_VARIABLE message RESULT_VARIABLE status)
  string(REGEX MATCHALL "error: [^\n]*" errors "${message}")
  string(REGEX MATCHALL "\n" lines "${message}")
  list(LENGTH errors error_count)
  list(LENGTH lines line_count)
  if(status EQUAL 0 OR NOT error_count EQUAL 1 OR NOT message MATCHES "${what}" OR line_count GREATER max_lines)
    message(SEND_ERROR "'${code}' (status ${status}): ${error_count} errors in ${line_count} lines; expected one in at most "
                       "${max_lines} that says '${what}'\n${message}")
  endif()
endfunction()

set(sentence "Broadside supports boxes of 2 or 3 dimensions with float or double coordinates")
expect_refusal("World<4> world;" "${sentence}")
expect_refusal("World<2, int> world;" "${sentence}")
expect_refusal("Finder<1> finder;" "${sentence}")
expect_refusal("Tracker<3, long double> tracker;" "${sentence}")
expect_refusal("const auto bytes = &BoxIndex<4>::bytes;" "${sentence}")
expect_refusal("Recorder<4> recorder;" "a trace has two or three dimensions")
expect_refusal("Recorder<2, int> recorder;" "a trace holds float or double")

set(sentence "find_pairs\\(\\) takes boxes .*, as in find_pairs\\(boxes_of\\(things, &Thing::box\\)\\)")
expect_refusal("const auto pairs = find_pairs(ints);" "${sentence}")
expect_refusal("for (const auto [a, b] : find_pairs(ints, ints, {.algorithm = \"grid\"})) {}" "${sentence}")
expect_refusal("const auto pairs = find_pairs(things);" "${sentence}")
expect_refusal("const auto pairs = find_pairs(things, &Thing::name);" "${sentence}")
expect_refusal("const auto pairs = find_pairs(std::vector<Box<4>>());" "${sentence}")

set(sentence "takes other boxes of the same type, a PairSink or a function of a Pair or of a std::span<const Pair>")
expect_refusal("const auto pairs = find_pairs(boxes, solids);" "${sentence}")
expect_refusal("const auto pairs = find_pairs(boxes, 5);" "${sentence}")
expect_refusal("const auto pairs = find_pairs(boxes, [](int) {});" "${sentence}")
expect_refusal("const auto pairs = find_pairs(boxes, \"grid\");" "options such as {.algorithm = .?\"grid")
expect_refusal("find_pairs(boxes, boxes, \"grid\");" "options such as {.algorithm = .?\"grid")

# Boxes of another dimension or of other coordinates than what takes them.
set(max_lines 40)
expect_refusal("game.add(Box3{});" "no known conversion [^\n]*Box<3[^\n]* to [^\n]*Box<2")
expect_refusal("game.add(DoubleBox2{});" "no known conversion [^\n]*Box<[^\n]*, double>[^\n]* to [^\n]*Box<")
expect_refusal("game.add(solids, handles);" "no known conversion [^\n]*Box<3[^\n]* to [^\n]*BoxView<2")
expect_refusal("game.move(Handle{}, DoubleBox2{});" "no known conversion [^\n]*Box<[^\n]*, double>[^\n]* to [^\n]*Box<")
expect_refusal("game.join(DoubleWorld2(), pairs);" "(cannot convert|no known conversion|no viable conversion)[^\n]*World")
expect_refusal("Finder<2>().find(doubles, counter);" "no known conversion [^\n]*Box<2, double>[^\n]* to [^\n]*BoxView<2")
expect_refusal("Tracker<3>().update(Frame<2>{}, counter, counter);" "no known conversion [^\n]*Frame<2[^\n]* to [^\n]*Frame<3")
expect_refusal("Box2 box = DoubleBox2{};" "conver[^\n]*(Box2|Box<)")
expect_refusal("const bool meet = overlap(Box2{}, Box3{});" "(conflicting|deduced)[^\n]*(2|3)")

# What else is given to them.
expect_refusal("boxes_index.overlapping(Box2{}, [](Handle) {});" "VisitFunction")
expect_refusal("Finder<2>().find(boxes, [](int) {});" "PairCallback")
expect_refusal("Spec spec(nullptr);" "deleted")
expect_refusal("World2 copy = game;" "deleted")
