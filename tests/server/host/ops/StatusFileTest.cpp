#include <gtest/gtest.h>

#include <filesystem>

#include "host/ops/StatusFile.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Version.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

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

TEST(StatusFile, IsWrittenAndRemovedOnDestruction) {
  const test::TempFolder home;
  {
    const StatusFile file(home / "status.json", statusFacts(), kLink);
    EXPECT_EQ(test::contentOf(home / "status.json"), statusText(statusFacts(), kLink));
  }
  EXPECT_FALSE(fs::exists(home / "status.json"));
  EXPECT_THROW(StatusFile(home / "none" / "status.json", statusFacts(), kLink), std::runtime_error);
}

}  // namespace
}  // namespace naiad
