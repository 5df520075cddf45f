#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/ops/StatusFile.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Version.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLink = "naiad://game.example#abcdefghijklmnopqrstuvwxya";

ServerFacts statusFacts() {
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

TEST(StatusFile, WithoutALinkThereIsNone) {
  EXPECT_EQ(statusText(statusFacts(), "").find("link"), std::string::npos);
}

TEST(StatusFile, AHostileNameStaysInItsQuotes) {
  ServerFacts facts = statusFacts();
  facts.name = "a\n\033[2J\"}";
  EXPECT_NE(statusText(facts, kLink).find("\"a ?[2J\\\"}\""), std::string::npos) << statusText(facts, kLink);
}

TEST(StatusFile, IsThereWhileItLivesAndGoneAfterwards) {
  std::string name = fs::temp_directory_path() / "naiad-status-XXXXXX";
  const fs::path home = mkdtemp(name.data());
  {
    const StatusFile file(home / "status.json", statusFacts(), kLink);
    std::stringstream text;
    text << std::ifstream(home / "status.json").rdbuf();
    EXPECT_EQ(text.str(), statusText(statusFacts(), kLink));
  }
  EXPECT_FALSE(fs::exists(home / "status.json"));
  EXPECT_THROW(StatusFile(home / "none" / "status.json", statusFacts(), kLink), std::runtime_error);
  fs::remove_all(home);
}

}  // namespace
}  // namespace naiad
