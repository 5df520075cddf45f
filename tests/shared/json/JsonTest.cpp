#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "../../support/HostileTexts.h"
#include "shared/json/Json.h"

namespace naiad {
namespace {

using namespace std::string_literals;

constexpr std::size_t kDepth = 8;

/// Parses and writes the text; "refused" if parsing fails.
std::string rewritten(std::string_view text, Json::Duplicates duplicates = Json::Duplicates::kRefuse) {
  const auto json = Json::parse(text, kDepth, duplicates);
  return json ? json->toString() : "refused";
}

std::string nested(std::size_t depth, const std::string& inner) {
  return std::string(depth, '[') + inner + std::string(depth, ']');
}

TEST(Json, WritesCompactlyInInsertionOrder) {
  Json json{{"z", 1}, {"a", "text"}, {"list", Json::Array{true, Json(), -2.5}}};
  EXPECT_EQ(json.toString(), R"({"z":1,"a":"text","list":[true,null,-2.5]})");
  json.set("a", Json::Object());
  json.set("b", Json::Array());
  EXPECT_EQ(json.toString(), R"({"z":1,"a":{},"list":[true,null,-2.5],"b":[]})");
  Json empty;
  empty.set("a", 1);
  EXPECT_EQ(empty.toString(), R"({"a":1})");
}

TEST(Json, ParsedTextIsRewrittenUnchanged) {
  EXPECT_EQ(rewritten(" {\"z\" : [ 1 , -2.5 , true , null ] ,\n\t\"a\":{ } , \"\" : \"\\u00e9\\n\" }\r\n"),
            "{\"z\":[1,-2.5,true,null],\"a\":{},\"\":\"\u00e9\\n\"}");
  for (const char* p_text : {"null", "true", "false", "0", "\"\"", "[]", "{}"})
    EXPECT_EQ(rewritten(p_text), p_text);
}

TEST(Json, RefusesTextThatIsNotExactlyOneValue) {
  for (const std::string& text :
       {""s,      " "s,      "{"s,    "[1"s,     "\"a"s,  "[1,]"s,     "{\"a\":1,}"s, "{\"a\"}"s,
        "{a:1}"s, "{1:2}"s,  "'a'"s,  "tru"s,    "True"s, "1 2"s,      "{} {}"s,      "[]]"s,
        "{}x"s,   "/*a*/1"s, "1//a"s, "\"\n\""s, "["s,    "{\"a\":}"s, "\"\\"s})
    EXPECT_EQ(rewritten(text), "refused") << text;
}

TEST(Json, RefusesNulBytesAnywhere) {
  for (const std::string& text : {"\0"s, "{}\0"s, "{}\0x"s, "\0{}"s, "[1,\0 2]"s, "\"a\0b\""s})
    EXPECT_EQ(rewritten(text), "refused") << text.size();
  const auto escaped = Json::parse(R"("a\u0000b")", kDepth);
  ASSERT_TRUE(escaped && escaped->text());
  EXPECT_EQ(*escaped->text(), "a\0b"s);
  EXPECT_EQ(escaped->toString(), R"("a\u0000b")");
}

TEST(Json, RefusesNestingBeyondTheLimit) {
  EXPECT_EQ(rewritten(nested(kDepth, "1")), nested(kDepth, "1"));
  EXPECT_EQ(rewritten(nested(kDepth + 1, "")), "refused");
  EXPECT_EQ(rewritten("[" + nested(kDepth - 1, "") + "," + nested(kDepth - 1, "") + "]"),
            "[" + nested(kDepth - 1, "") + "," + nested(kDepth - 1, "") + "]")
      << "siblings do not add up";
  EXPECT_EQ(rewritten(std::string(1'000'000, '[')), "refused");
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
  EXPECT_EQ(rewritten(objects), "refused");
  EXPECT_TRUE(Json::parse("1", 0));
  EXPECT_FALSE(Json::parse("[]", 0));
  EXPECT_TRUE(Json::parse(R"({"a":1})", 1));
  EXPECT_FALSE(Json::parse(R"({"a":{}})", 1));
}

TEST(Json, RefusesDuplicateNamesOrKeepsTheLast) {
  const std::string text = R"({"a":1,"b":2,"a":{"c":3,"c":[4]}})";
  EXPECT_EQ(rewritten(text), "refused");
  EXPECT_EQ(rewritten(R"([{"a":{"b":1,"\u0062":1}}])"), "refused") << "spelled with an escape";
  EXPECT_EQ(rewritten(text, Json::Duplicates::kKeepLast), R"({"a":{"c":[4]},"b":2})");
  EXPECT_EQ(rewritten(R"([{"a":1},{"a":1},{"a":{"a":1}}])"), R"([{"a":1},{"a":1},{"a":{"a":1}}])");
}

TEST(Json, KeepsIntegersOf64BitsExactly) {
  for (const char* p_text : {"9223372036854775807", "-9223372036854775808", "18446744073709551615"}) {
    EXPECT_EQ(rewritten(p_text), p_text);
    EXPECT_TRUE(Json::parse(p_text, kDepth)->isInteger()) << p_text;
  }
  EXPECT_EQ(Json::parse("9223372036854775807", kDepth)->integer(), INT64_MAX);
  EXPECT_EQ(Json::parse("-9223372036854775808", kDepth)->integer(), INT64_MIN);
  EXPECT_EQ(Json::parse("9223372036854775808", kDepth)->integer(), std::nullopt);
  EXPECT_EQ(Json::parse("18446744073709551615", kDepth)->number(), 18446744073709551616.0);
  EXPECT_EQ(Json(UINT64_MAX).toString(), "18446744073709551615");
  EXPECT_EQ(Json(INT64_MIN).toString(), "-9223372036854775808");
  EXPECT_EQ(Json(std::uint8_t{200}).toString(), "200");
  EXPECT_EQ(rewritten("-0"), "0");
}

TEST(Json, ReadsOtherNumbersAsDoubles) {
  const std::pair<const char*, const char*> numbers[] = {
      {"18446744073709551616", "1.8446744073709552e+19"},
      {"-9223372036854775809", "-9.223372036854776e+18"},
      {"1.0", "1.0"},
      {"1e3", "1000.0"},
      {"-0.0", "-0.0"},
      {"0.1", "0.1"},
      {"1e-999", "0.0"},
      {"1.7976931348623157e308", "1.7976931348623157e+308"}};
  for (const auto& [text, again] : numbers) {
    const auto json = Json::parse(text, kDepth);
    ASSERT_TRUE(json) << text;
    EXPECT_EQ(json->toString(), again);
    EXPECT_TRUE(json->number()) << text;
    EXPECT_FALSE(json->integer()) << text;
    EXPECT_FALSE(json->isInteger()) << text;
  }
}

TEST(Json, RefusesMalformedAndOverflowingNumbers) {
  for (const char* p_text : {"1e999", "-1e999", "NaN", "nan", "Infinity", "-Infinity", "+1", "01", "-", "1.",
                             ".5", "1e", "1e+", "0x10", "1_000"})
    EXPECT_EQ(rewritten(p_text), "refused") << p_text;
  EXPECT_EQ(rewritten("[" + std::string(400, '9') + "]"), "refused");
}

TEST(Json, WritesNonFiniteNumbersAsNull) {
  EXPECT_EQ(Json(std::numeric_limits<double>::quiet_NaN()).toString(), "null");
  EXPECT_EQ(Json(-std::numeric_limits<double>::infinity()).toString(), "null");
}

TEST(Json, RefusesInvalidUtf8AndLoneSurrogates) {
  for (const std::string& bytes :
       {"\xff"s, "\x80"s, "\xc3"s, "\xc0\xaf"s, "\xe2\x82"s, "\xed\xa0\x80"s, "\xf4\x90\x80\x80"s, "\\ud800"s,
        "\\udc00"s, "\\ud800\\ud800"s, "\\ud83dx"s, "\\u12"s, "\\u12g4"s, "\\x41"s, "\\ud83d\\u"s, "\\x"s}) {
    EXPECT_EQ(rewritten("\"" + bytes + "\""), "refused") << bytes;
    EXPECT_EQ(rewritten("{\"" + bytes + "\":1}"), "refused") << bytes;
  }
  EXPECT_EQ(rewritten(R"("\ud83d\ude00\/")"), "\"\U0001F600/\"");
}

TEST(Json, WritesInvalidUtf8AsReplacementCharacters) {
  EXPECT_EQ(Json("a\xff\xfe z").toString(), "\"a\ufffd\ufffd z\"");
  EXPECT_EQ(Json("cut \xe2\x82").toString(), "\"cut \ufffd\"");
  EXPECT_EQ((Json{{"\xff", "\xc3("}}).toString(), "{\"\ufffd\":\"\ufffd(\"}");
  EXPECT_EQ(Json("\xff").toString(Json::Style::kAscii), "\"\\ufffd\"");
}

TEST(Json, EscapesQuotesAndControlCharacters) {
  EXPECT_EQ(Json("\"\\/\b\f\n\r\t\x01\x1f\x7f \u00e9"s).toString(),
            "\"\\\"\\\\/\\b\\f\\n\\r\\t\\u0001\\u001f\x7f \u00e9\"");
  EXPECT_EQ(Json("a\0b"s).toString(), "\"a\\u0000b\"");
}

TEST(Json, AsciiStyleWritesOnlyPrintableAscii) {
  EXPECT_EQ((Json{{"a", Json::Array{1, Json(), "b"}}, {"c", Json::Array()}}).toString(Json::Style::kAscii),
            R"({"a": [1, null, "b"], "c": []})");
  EXPECT_EQ(Json("na\u00efve \u2588 \U0001F600\x7f").toString(Json::Style::kAscii),
            "\"na\\u00efve \\u2588 \\ud83d\\ude00\\u007f\"");
  for (const test::HostileText& text : test::hostileTexts()) {
    const std::string line = Json{{text.bytes, text.bytes}}.toString(Json::Style::kAscii);
    EXPECT_TRUE(std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c < 0x7f; }))
        << text.what;
    const auto read = Json::parse(line, 1);
    ASSERT_TRUE(read && read->object()) << text.what;
    EXPECT_EQ(read->object()->size(), 1u) << text.what;
    EXPECT_EQ(read->toString(), (Json{{text.bytes, text.bytes}}).toString()) << text.what;
  }
}

TEST(Json, ValueHasExactlyOneKind) {
  const auto json = Json::parse(R"({"n":null,"b":false,"i":-1,"d":0.5,"t":"1","a":[1],"o":{"p":7}})", 2);
  ASSERT_TRUE(json);
  const auto kinds = [&](const char* p_name) {
    const Json& value = (*json)[p_name];
    return std::string(value.boolean() ? "b" : "") + (value.integer() ? "i" : "") +
           (value.number() ? "n" : "") + (value.text() ? "t" : "") + (value.array() ? "a" : "") +
           (value.object() ? "o" : "");
  };
  const std::pair<const char*, const char*> all[] = {{"n", ""},  {"b", "b"}, {"i", "in"}, {"d", "n"},
                                                     {"t", "t"}, {"a", "a"}, {"o", "o"},  {"missing", ""}};
  for (const auto& [name, kind] : all) EXPECT_EQ(kinds(name), kind) << name;
  EXPECT_NE(json->find("n"), nullptr);
  EXPECT_EQ(json->find("missing"), nullptr);
  EXPECT_EQ((*json)["a"].find("p"), nullptr);
  EXPECT_EQ((*json)["o"]["p"].integer(), 7);
  EXPECT_EQ((*json)["t"]["p"]["q"].integer(), std::nullopt);
}

// Quadratic time would exceed the test's time limit.
TEST(Json, ReadsLargeObjectsInLinearTime) {
  std::string text = "{";
  for (int i = 0; i < 300'000; ++i) text += "\"" + std::to_string(i) + "\":0,";
  const auto json = Json::parse(text + "\"last\":1}", 1);
  ASSERT_TRUE(json && json->object());
  EXPECT_EQ(json->object()->size(), 300'001u);
  EXPECT_EQ((*json)["last"].integer(), 1);
}

}  // namespace
}  // namespace naiad
