#include <gtest/gtest.h>

#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminJson.h"

namespace naiad {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

AdminAnswer readAll(const std::string& text) {
  AnswerReader reader;
  const auto lines = linesOf(text);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_last = i + 1 == lines.size();
    EXPECT_EQ(reader.readLine(lines[i]),
              is_last ? AnswerReader::LineKind::kAnswer : AnswerReader::LineKind::kMore);
  }
  return reader.answer();
}

TEST(AdminJson, RequestSurvivesTheRoundTrip) {
  const AdminRequest request = readAdminRequest({"ban", "\"Ann\\\xc3\xa9\"", "2h", "a\nb"});
  std::string line = requestLine(request);
  ASSERT_EQ(line.back(), '\n');
  line.pop_back();
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(readRequestLine(line).arguments, request.arguments);
  EXPECT_EQ(readRequestLine(R"({"command":"who"})").command->name, "who");
  EXPECT_EQ(readRequestLine(R"({"arguments":{"player":7},"command":"kick"})").of("player"), "7");
}

TEST(AdminJson, MalformedRequestIsRefusedWithAnError) {
  const std::string deep(2000, '[');
  const std::string nested = R"({"command":"kick","arguments":{"player":{"a":1}}})";
  for (const std::string& line :
       {std::string(), std::string("[]"), std::string("null"), std::string("{}"),
        std::string(R"({"command":3})"), std::string(R"({"command":"who","command":"stop"})"),
        std::string(R"({"command":"who","extra":1})"), std::string(R"({"command":"kick","arguments":[]})"),
        std::string(R"({"command":"kick","arguments":{"player":"a","player":"b"}})"),
        std::string(R"({"command":"kick","arguments":{"player":null}})"),
        std::string(R"({"command":"kick","arguments":{"player":1.5}})"),
        std::string(R"({"command":"constructor"})"), deep, nested}) {
    EXPECT_THROW(readRequestLine(line), AdminUsageError) << line.substr(0, 60);
  }
}

TEST(AdminJson, LargeAnswerSurvivesTheRoundTrip) {
  AdminAnswer answer = AdminAnswer::done("");
  answer.is_list = true;
  for (std::int64_t i = 0; i < 500; ++i)
    answer.rows.push_back({{"id", i}, {"name", "player " + std::to_string(i)}, {"away", i % 2 == 0}});
  const std::string text = answerLines(answer);
  for (const std::string& line : linesOf(text)) EXPECT_LE(line.size(), kMaxControlLine);
  const AdminAnswer read = readAll(text);
  EXPECT_TRUE(read.ok);
  EXPECT_EQ(read.rows, answer.rows);
}

TEST(AdminJson, FactsKeepOrderAndRefusalsKeepCandidates) {
  AdminAnswer facts = AdminAnswer::done("");
  facts.facts = {{"z", std::string("last")}, {"a", std::int64_t{1}}, {"m", 0.5}};
  EXPECT_EQ(readAll(answerLines(facts)).facts, facts.facts);
  AdminAnswer refused = AdminAnswer::refused("Which?");
  refused.candidates = {"#1 Ann", "#2 Anna"};
  const AdminAnswer read = readAll(answerLines(refused));
  EXPECT_FALSE(read.ok);
  EXPECT_EQ(read.text, "Which?");
  EXPECT_EQ(read.candidates, refused.candidates);
}

TEST(AdminJson, HostileTextStaysWithinOneLine) {
  for (const std::string& text :
       {std::string(10'000, '\x01'), std::string(10'000, '\xff'), std::string("a\nb\r\n"),
        std::string(3000, '"'), std::string("\xe2\x82") + std::string(5000, 'x')}) {
    for (const std::string& line : {eventLine("log", text), answerLines(AdminAnswer::done(text)),
                                    answerLines(AdminAnswer::refused(text))}) {
      EXPECT_EQ(line.find('\n'), line.size() - 1);
      EXPECT_LE(line.size() - 1, kMaxControlLine);
    }
  }
  AnswerReader reader;
  std::string line = eventLine("log", "a\nb");
  line.pop_back();
  ASSERT_EQ(reader.readLine(line), AnswerReader::LineKind::kEvent);
  EXPECT_EQ(reader.event(), "a\nb");
  line = droppedLine(12);
  line.pop_back();
  ASSERT_EQ(reader.readLine(line), AnswerReader::LineKind::kDropped);
  EXPECT_EQ(reader.dropped(), 12u);
  EXPECT_EQ(reader.readLine("SSH-2.0-OpenSSH"), AnswerReader::LineKind::kMalformed);
}

TEST(AdminText, RowsAlignInColumnsAndControlCharactersAreEscaped) {
  AdminAnswer answer = AdminAnswer::done("");
  answer.is_list = true;
  answer.rows = {{{"id", std::int64_t{1}}, {"name", std::string("\xc3\x84nn")}, {"away", false}},
                 {{"id", std::int64_t{12}}, {"name", std::string("Bob\x1b[2J")}, {"away", true}}};
  EXPECT_EQ(answerText(answer), (std::vector<std::string>{"id  name        away", "1   \xc3\x84nn         -",
                                                          "12  Bob\\x1b[2J  yes"}));
}

TEST(AdminText, JsonHasRowsTextOrError) {
  AdminAnswer answer = AdminAnswer::done("No players.");
  EXPECT_EQ(answerJson(answer), R"({"text":"No players."})");
  answer.is_list = true;
  EXPECT_EQ(answerJson(answer), "[]");
  EXPECT_EQ(answerJson(AdminAnswer::refused("No.")), R"({"error":"No."})");
}

}  // namespace
}  // namespace naiad
