#include <gtest/gtest.h>

#include "host/ops/StatusFile.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Version.h"

namespace naiad {
namespace {

constexpr const char* kLink = "naiad://game.example#abcdefghijklmnopqrstuvwxya";

ServerInfo statusFacts() {
  return {"Ann's \"own\"", "hello", kProtocolVersion, 3, 16, true};
}

TEST(StatusFile, TheTextIsJsonWithTheLink) {
  EXPECT_EQ(statusText(statusFacts(), kLink),
            "{\"name\": \"Ann's \\\"own\\\"\", \"game\": \"hello\", \"players\": 3, \"max_players\": 16, "
            "\"password\": true, \"protocol\": " +
                std::to_string(kProtocolVersion) + ", \"version\": \"" + kVersion +
                "\", "
                "\"link\": \"naiad://game.example#abcdefghijklmnopqrstuvwxya\"}\n");
}

TEST(StatusFile, TextOmitsAnEmptyLink) {
  EXPECT_EQ(statusText(statusFacts(), "").find("link"), std::string::npos);
}

TEST(StatusFile, HostileNameIsEscapedInJson) {
  ServerInfo facts = statusFacts();
  facts.name = "a\n\033[2J\"}";
  EXPECT_NE(statusText(facts, kLink).find("\"a ?[2J\\\"}\""), std::string::npos) << statusText(facts, kLink);
}

}  // namespace
}  // namespace naiad
