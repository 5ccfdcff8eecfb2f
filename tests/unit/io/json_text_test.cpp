#include "evert/io/json_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace evert {
namespace {

TEST(JsonText, EscapesStrings) {
  EXPECT_EQ(JsonValue("a\"b\\c\n\x01").text(), R"("a\"b\\c\u000a\u0001")");
  EXPECT_EQ(JsonValue("µm").text(), "\"µm\"");
}

TEST(JsonText, NumbersReadBackAndTheOthersAreNull) {
  EXPECT_EQ(JsonValue(0.1).text(), "0.1");
  EXPECT_EQ(JsonValue(-12).text(), "-12");
  EXPECT_EQ(JsonValue(std::numeric_limits<double>::infinity()).text(), "null");
  EXPECT_EQ(JsonValue(std::numeric_limits<double>::quiet_NaN()).text(), "null");
}

TEST(JsonText, ObjectsAndListsNest) {
  EXPECT_EQ(
      JsonValue::object({{"a", 1}, {"b", JsonValue::object({{"c", JsonValue::list({1, "x"})}})}}).text(),
      "{\n  \"a\": 1,\n  \"b\": {\n    \"c\": [1, \"x\"]\n  }\n}");
}

}  // namespace
}  // namespace evert
