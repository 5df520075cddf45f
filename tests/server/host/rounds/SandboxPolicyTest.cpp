// Files and environment variables for a game in its own process.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "host/rounds/SandboxPolicy.h"
#include "host/world/WorldStart.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

class SandboxPolicyTest : public testing::Test {
 protected:
  SandboxPolicyTest() {
    fs::create_directories(m_folder / "game/sprites");
    fs::create_directories(m_folder / "secret/sprites");
    options.identity = m_folder / "identity";
  }
  ~SandboxPolicyTest() override { m_home ? setenv("HOME", m_home->c_str(), 1) : unsetenv("HOME"); }

  bool reads(const fs::path& path) const {
    const auto paths = makeSandboxPolicy(options, place).sandbox.readable;
    return std::find(paths.begin(), paths.end(), path.string()) != paths.end();
  }
  static bool has(const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  }

  static std::optional<std::string> homeNow() {
    const char* p_home = getenv("HOME");
    return p_home != nullptr ? std::optional<std::string>(p_home) : std::nullopt;
  }

  const std::optional<std::string> m_home = homeNow();  ///< restored after tests that change it
  const test::TempFolder m_temp;
  const fs::path m_folder = fs::canonical(m_temp.path());
  HostOptions options;
  GamePaths place;
};

TEST_F(SandboxPolicyTest, AGamesFolderIsReadable) {
  place.folders = {(m_folder / "game").string()};
  EXPECT_TRUE(reads(m_folder / "game"));
  EXPECT_FALSE(reads(m_folder));
}

TEST_F(SandboxPolicyTest, FolderWithServerSecretsExposesOnlyItsSprites) {
  options.identity = m_folder / "game/identity";
  place.folders = {(m_folder / "game").string()};
  EXPECT_FALSE(reads(m_folder / "game"));
  EXPECT_TRUE(reads(m_folder / "game/sprites"));
  options.identity = m_folder / "identity";
  EXPECT_TRUE(reads(m_folder / "game"));
  options.key = m_folder / "game/key.pem";
  EXPECT_FALSE(reads(m_folder / "game"));
  options.key.clear();
  place.secrets = {(m_folder / "game/server.ini").string()};
  EXPECT_FALSE(reads(m_folder / "game"));
}

TEST_F(SandboxPolicyTest, HomeAndSystemFoldersAreNotReadable) {
  setenv("HOME", (m_folder / "game").c_str(), 1);
  place.folders = {(m_folder / "game").string(), m_folder.string(), "/", "/etc", "/tmp"};
  EXPECT_FALSE(reads(m_folder / "game"));
  EXPECT_TRUE(reads(m_folder / "game/sprites"));
  EXPECT_FALSE(reads(m_folder));
  EXPECT_FALSE(reads("/"));
  EXPECT_FALSE(reads("/etc"));
  EXPECT_FALSE(reads("/tmp"));
}

TEST_F(SandboxPolicyTest, LinksToSpritesAreFollowedWithinAProject) {
  fs::create_directories(m_folder / "build/game");
  fs::create_directory_symlink(m_folder / "game/sprites", m_folder / "build/game/sprites");
  place.folders = {(m_folder / "build/game").string()};
  EXPECT_TRUE(reads(m_folder / "game/sprites"));
  // A link to the user's own files or to the server's is not followed.
  setenv("HOME", m_folder.c_str(), 1);
  EXPECT_FALSE(reads(m_folder / "game/sprites"));
  unsetenv("HOME");
  options.identity = m_folder / "game";
  EXPECT_FALSE(reads(m_folder / "game/sprites"));
}

TEST_F(SandboxPolicyTest, WorkingDirectoryWithServerFilesIsNotWritable) {
  const SandboxPolicy made = makeSandboxPolicy(options, place);
  const bool writable = has(made.sandbox.writable, fs::canonical(firstDirectory()).string());
  EXPECT_EQ(writable, made.notes.empty()) << "or the log says why not";
  options.identity = firstDirectory() + "/identity";
  const SandboxPolicy reserved = makeSandboxPolicy(options, place);
  EXPECT_TRUE(reserved.sandbox.writable.empty());
  ASSERT_EQ(reserved.notes.size(), 1u);
  EXPECT_NE(reserved.notes[0].find("identity"), std::string::npos) << reserved.notes[0];
}

TEST_F(SandboxPolicyTest, TheServersFilesInTheGamesFolderAreNamed) {
  place.is_program = true;  // a program gets the folder even if it contains the server
  if (makeSandboxPolicy(options, place).sandbox.writable.empty()) GTEST_SKIP() << "this folder is not given";
  place.server_files = {"server.log", (m_folder / "join").string(), ""};
  const SandboxPolicy made = makeSandboxPolicy(options, place);
  ASSERT_EQ(made.notes.size(), 1u) << "the one that lies there";
  EXPECT_NE(made.notes[0].find((fs::canonical(firstDirectory()) / "server.log").string()), std::string::npos);
}

TEST_F(SandboxPolicyTest, GameGetsOnlyAllowedVariablesAndNoPassword) {
  setenv("NAIAD_PASSWORD", "open-sesame", 1);
  setenv("SOMETHING_ELSE", "1", 1);
  setenv("WANTED", "1", 1);
  setenv("NAIAD_PLAYERS", "first", 1);  // the former name of NAIAD_INPUT_MODE
  options.world_environment = "WANTED,NAIAD_PASSWORD";
  const auto entries = makeWorldEnvironment(options);
  for (const char* name : {"NAIAD_PASSWORD", "SOMETHING_ELSE", "NAIAD_PLAYERS"}) unsetenv(name);
  EXPECT_TRUE(has(entries, "WANTED=1"));
  EXPECT_TRUE(has(entries, "NAIAD_PLAYERS=first"));
  EXPECT_FALSE(has(entries, "SOMETHING_ELSE=1"));
  EXPECT_FALSE(has(entries, "NAIAD_PASSWORD=open-sesame"));
  options.world_environment.clear();
  EXPECT_FALSE(has(makeWorldEnvironment(options), "WANTED=1"));
  unsetenv("WANTED");
}

TEST(HidePassword, OverwritesThePasswordArgument) {
  char words[][32] = {"dfserver", "--password",       "open-sesame", "--password=open",
                      "--port",   "--admin-password", "open-sesame", "--admin-password=open"};
  char* arguments[] = {words[0], words[1], words[2], words[3], words[4],
                       words[5], words[6], words[7], nullptr};
  hidePassword(8, arguments);
  const char* const hidden[] = {"dfserver", "--password",       "***********", "--password=****",
                                "--port",   "--admin-password", "***********", "--admin-password=****"};
  for (std::size_t i = 0; i < std::size(hidden); ++i) EXPECT_STREQ(words[i], hidden[i]);
}

}  // namespace
}  // namespace naiad
