// A log event as a sentence and as a JSON object.
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "shared/program/LineLog.h"

namespace naiad {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMost = 2048;
const std::chrono::system_clock::time_point kTime{std::chrono::milliseconds(1'769'860'799'007)};

std::string jsonLine(const LogEvent& event, std::size_t most = kMost) {
  return formatEvent(event, LogFormat::kJson, kTime, most);
}

Json parse(const LogEvent& event, std::size_t most = kMost) {
  return Json::parse(jsonLine(event, most));
}

TEST(LogFormatTest, EventIsFormattedAsText) {
  const LogEvent event{"joined", "192.0.2.1:4000 \"Ann\" joined", {{"player", "Ann"}}};
  EXPECT_EQ(formatEvent(event, LogFormat::kBare, kTime, kMost), "192.0.2.1:4000 \"Ann\" joined\n");
  const std::string line = formatEvent(event, LogFormat::kText, kTime, kMost);
  EXPECT_EQ(line.substr(std::string("2026-01-31 11:59:59").size()), " 192.0.2.1:4000 \"Ann\" joined\n");
}

TEST(LogFormatTest, EventIsFormattedAsJsonWithItsFields) {
  EXPECT_EQ(jsonLine({"joined", "192.0.2.1:4000 \"Ann\" joined", {{"address", "192.0.2.1:4000"}}}),
            R"({"time":"2026-01-31T11:59:59.007Z","level":"info","event":"joined",)"
            R"("text":"192.0.2.1:4000 \"Ann\" joined","address":"192.0.2.1:4000"})"
            "\n");
  EXPECT_EQ(parse("a text").at("event"), "note");
  EXPECT_EQ(parse({LogEvent::Level::kWarning, "warning: x"}).at("level"), "warning");
}

TEST(LogFormatTest, AnyBytesGiveOneLineOfValidJson) {
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  const std::string line = jsonLine({"chat", all, {{"line", all}, {"player", "\"},{\"event\":\"joined"}}});
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const Json object = Json::parse(line);
  EXPECT_EQ(object.at("event"), "chat");
  EXPECT_EQ(object.at("player"), "\"},{\"event\":\"joined");
  for (const char c : object.at("text").get<std::string>()) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
}

TEST(LogFormatTest, LongLineIsTruncatedButStaysValidJson) {
  for (const std::string& piece : {std::string("x"), std::string("\""), std::string("\xe2\x82\xac")}) {
    std::string text;
    while (text.size() < 10'000) text += piece;
    const LogEvent event{"chat", text, {{"line", text}}};
    EXPECT_LE(jsonLine(event).size(), kMost);
    EXPECT_EQ(parse(event).at("event"), "chat");
    EXPECT_FALSE(parse(event).at("text").get<std::string>().empty());
    EXPECT_EQ(formatEvent(event, LogFormat::kText, kTime, kMost).size(), kMost);
  }
}

}  // namespace
}  // namespace naiad
