// What is JSON and what is not: as another parser of JSON sees it, too.
#include "lab/formats/json_check.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lab/formats/format.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::HasSubstr;

bool is_json(const std::string& text) {
  try {
    check_json(text, 0, text.size(), "text");
  } catch (const FileError&) {
    return false;
  }
  return true;
}

TEST(JsonCheck, TakesWhatIsJsonAndNothingElse) {
  for (const std::string text : {"{}", "[]", " [1, -0, 0.5, 1e5, 1E+5, -1.25e-7]\n",
                                 R"({"a":[{"b":null},true,false],"c":"\u00e9\\\"/\/"})", "\"text\"", "7",
                                 "[[],[[]],{}]", R"({"":{"":""}})"}) {
    EXPECT_TRUE(is_json(text)) << text;
    EXPECT_TRUE(nlohmann::json::accept(text)) << text;
  }
  for (const std::string text :
       {"",       " ",          "{",    "}",         "[",         "]",        "[}",          "{]",
        "[1,]",   "{\"a\":1,}", "[,1]", "[1 2]",     "{\"a\" 1}", "{\"a\":}", "{a:1}",       "{1:1}",
        "[01]",   "[-]",        "[1.]", "[.5]",      "[+1]",      "[1e]",     "[1e+]",       "[0x1]",
        "[tru]",  "[nulll]",    "NaN",  "\"",        "\"a",       "\"\\x\"",  "\"\\u12g4\"", "\"\\",
        "\"\n\"", "[] []",      "[]]",  "{\"a\":[}", "//\n1",     "['a']"}) {
    EXPECT_FALSE(is_json(text)) << text;
    EXPECT_FALSE(nlohmann::json::accept(text)) << text;
  }
}

TEST(JsonCheck, AgreesWithAnotherParserOnEveryChangeOfOneCharacter) {
  const std::string good = R"({"a" :[1,-0.5e+3, {"b":null,"\n":[[],{}]}] , "c":"\u12ab", "d":true})";
  ASSERT_TRUE(is_json(good));
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (const char c : std::string("{}[]:,\"\\ 01-+.eEtu\n/a")) {
      std::string text = good;
      text[at] = c;
      EXPECT_EQ(is_json(text), nlohmann::json::accept(text)) << text;
    }
    std::string text = good;
    text.erase(at, 1);
    EXPECT_EQ(is_json(text), nlohmann::json::accept(text)) << text;
  }
}

TEST(JsonCheck, LooksAtNothingBeforeItsBeginOrBehindItsEnd) {
  EXPECT_NO_THROW(check_json("]]{}]]", 2, 4, "text"));
  EXPECT_THAT(message_of<FileError>([] { check_json("]][1]]", 2, 4, "text"); }),
              HasSubstr("text: byte 4: the text ends; expected ',' or ']'"));
}

TEST(JsonCheck, TakesAsManyBracketsAsThereAre) {
  EXPECT_TRUE(is_json(std::string(1'000'000, '[') + std::string(1'000'000, ']')));
  EXPECT_FALSE(is_json(std::string(1'000'000, '[')));
}

TEST(ShownJson, IsShortAndPrintable) {
  EXPECT_EQ(shown_json("[1]"), "an array");
  EXPECT_EQ(shown_json("{}"), "an object");
  EXPECT_EQ(shown_json("12,3"), "'12'");
  EXPECT_EQ(shown_json("\"a, b\",3"), "'\"a, b\"'");
  EXPECT_EQ(shown_json("\x1b[31m"), "'?[31m'");
  EXPECT_EQ(shown_json(std::string(100, '1')), "'" + std::string(24, '1') + "...'");
}

}  // namespace
}  // namespace broadside::lab
