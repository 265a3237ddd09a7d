# Fails unless COMPILER refuses code that the headers in INCLUDE do not take, by one error in few lines, with a sentence
# that says what they take. FOLDER is for the code.
function(expect_refusal code sentence)
  file(WRITE ${FOLDER}/refused.cpp "#include <broadside/broadside.hpp>
using namespace broadside;
struct Thing { Box2 box; int name; };
std::vector<int> ints;
std::vector<Thing> things;
std::vector<Box2> boxes;
std::vector<Box3> solids;
void refused() { ${code} }
")
  execute_process(COMMAND ${COMPILER} -std=c++20 -fsyntax-only -I ${INCLUDE} ${FOLDER}/refused.cpp
    ERROR_VARIABLE message RESULT_VARIABLE status)
  string(REGEX MATCHALL "error: [^\n]*" errors "${message}")
  string(REGEX MATCHALL "\n" lines "${message}")
  list(LENGTH errors error_count)
  list(LENGTH lines line_count)
  if(status EQUAL 0 OR NOT error_count EQUAL 1 OR NOT errors MATCHES "${sentence}" OR line_count GREATER 15)
    message(SEND_ERROR "'${code}' (status ${status}): ${error_count} errors in ${line_count} lines; expected one in at most "
                       "15 that says '${sentence}'\n${message}")
  endif()
endfunction()

set(sentence "Broadside supports boxes of 2 or 3 dimensions with float or double coordinates")
expect_refusal("World<4> world;" "${sentence}")
expect_refusal("World<2, int> world;" "${sentence}")
expect_refusal("const auto bytes = &BoxIndex<4>::bytes;" "${sentence}")

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
