#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "client/trust/SessionFile.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

const std::string kServer = "game.example:9876";

Fingerprint keyOf(char digit) {
  return *Fingerprint::parse(std::string(64, digit));
}

class SessionFileTest : public testing::Test {
 protected:
  std::unique_ptr<SessionFile> open(const std::string& server = kServer,
                                    const std::optional<std::string>& name = std::nullopt) {
    return std::make_unique<SessionFile>(directory, server, name, now);
  }
  static SavedSession session(const std::string& token, const std::string& name = "ann") {
    return {.server = "", .key = keyOf('a'), .name = name, .token = token, .grace = 60s};
  }
  void leave(const std::string& token, const std::string& name = "ann", const std::string& server = kServer) {
    SessionFile(directory, server, "nobody", now).save(session(token, name), now);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    if (!fs::exists(directory)) return found;
    for (const auto& entry : fs::directory_iterator(directory)) {
      if (entry.path().filename() != "lock") found.push_back(entry.path());
    }
    return found;
  }
  static void put(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
  }

  test::TempFolder home;
  const fs::path directory = home / "state" / "naiad" / "sessions";
  SessionFile::Time now{std::chrono::hours(24 * 365 * 50)};
};

TEST_F(SessionFileTest, NextClientFindsTheFileOfAKilledClient) {
  auto first = open();
  EXPECT_EQ(first->tokenFor(keyOf('a')), "");
  EXPECT_FALSE(fs::exists(directory)) << "reading makes no directory";
  const std::string another("\0\n\xff and so on", 12);
  first->save(session("token"), now);
  first->save(session(another), now);
  EXPECT_EQ(files().size(), 1u) << "a new token takes the place of the old one";
  EXPECT_EQ(test::modeOf(files()[0]), 0600u);
  EXPECT_EQ(test::modeOf(directory), 0700u);
  EXPECT_EQ(open()->tokenFor(keyOf('a')), "") << "not while it runs";
  first.reset();
  auto second = open();
  EXPECT_EQ(second->tokenFor(keyOf('b')), "") << "for the server that gave it, and no other";
  EXPECT_EQ(second->tokenFor(keyOf('a')), another);
  EXPECT_EQ(open()->tokenFor(keyOf('a')), "") << "it is taken";
  second->save(session("third"), now);
  EXPECT_EQ(files().size(), 1u);
  EXPECT_TRUE(second->problems().empty());
}

TEST_F(SessionFileTest, FindsOnlyFilesOfTheSameServerAndName) {
  leave("here");
  EXPECT_EQ(open("elsewhere.example:9876")->tokenFor(keyOf('a')), "");
  EXPECT_EQ(open(kServer, "bob")->tokenFor(keyOf('a')), "");
  EXPECT_EQ(open(kServer, "ann")->tokenFor(keyOf('a')), "here");
  EXPECT_EQ(open()->tokenFor(keyOf('a')), "here");
}

TEST_F(SessionFileTest, ReturnsEachFileOnceNewestFirst) {
  leave("old");
  now += 5s;
  leave("new");
  now += 5s;
  const auto first = open();
  EXPECT_EQ(first->tokenFor(keyOf('a')), "new");
  const auto second = open();
  EXPECT_EQ(second->tokenFor(keyOf('a')), "old");
  EXPECT_EQ(open()->tokenFor(keyOf('a')), "");
}

TEST_F(SessionFileTest, FilesPastTheirGraceAreRemoved) {
  leave("token");
  now += 60s;
  EXPECT_EQ(open()->tokenFor(keyOf('a')), "token");
  now += 1s;
  auto late = open();
  EXPECT_EQ(late->tokenFor(keyOf('a')), "");
  EXPECT_TRUE(files().empty());
  EXPECT_TRUE(late->problems().empty()) << "nothing is wrong with that";
}

TEST_F(SessionFileTest, GraceTimeStartsWhenTheSessionWasLastAlive) {
  auto running = open();
  running->save(session("token"), now);
  for (int i = 0; i < 100; ++i) running->refresh(now += 2s);
  running.reset();
  now += 59s;
  EXPECT_EQ(open()->tokenFor(keyOf('a')), "token");
}

TEST_F(SessionFileTest, LeavingRemovesTheFile) {
  auto file = open();
  file->save(session("token"), now);
  file->remove();
  EXPECT_TRUE(files().empty());
  file->save(session(""), now);
  EXPECT_TRUE(files().empty()) << "a session that ends with its stream";
  file->refresh(now + 5s);
  EXPECT_TRUE(files().empty());
  file->save(session("again"), now);
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(SessionFileTest, DamagedFilesAreReportedAndRemoved) {
  leave("token");
  const fs::path path = files()[0];
  const std::string good = test::contentOf(path);
  std::vector<std::string> bad = {"",
                                  "x",
                                  good.substr(1),
                                  good.substr(0, 500),
                                  good + "\n",
                                  std::string(kSavedSessionSize, '\0'),
                                  std::string(100'000, 'x')};
  for (const char* field : {"server", "key", "name", "token", "grace", "alive"}) {
    std::string text = good;
    text.replace(text.find(field), 1, "X");
    bad.push_back(text);
    text = good;
    text[text.find('\n', text.find(field)) - 1] = 'z';
    if (std::string(field) != "server" && std::string(field) != "name") bad.push_back(text);
  }
  for (const std::string& text : bad) {
    put(path, text);
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
    const auto file = open();
    EXPECT_EQ(file->tokenFor(keyOf('a')), "") << text;
    ASSERT_EQ(file->problems().size(), 1u) << text;
    EXPECT_EQ(file->problems()[0], path.string() + " was damaged and has been removed.");
    EXPECT_TRUE(files().empty());
  }
}

TEST_F(SessionFileTest, EveryChangedByteIsRejectedOrReadExactly) {
  leave("token");
  const std::string good = test::contentOf(files()[0]);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string text = good;
    text[i] = static_cast<char>(text[i] ^ 0x55);
    const auto read = readSavedSession(text);
    if (read) {
      EXPECT_EQ(writeSavedSession(*read), text) << i;
    }
  }
}

TEST_F(SessionFileTest, FilesThatOthersCanReadAreNotUsed) {
  leave("token");
  const fs::path path = files()[0];
  fs::permissions(path, fs::perms::group_read, fs::perm_options::add);
  auto file = open();
  EXPECT_EQ(file->tokenFor(keyOf('a')), "");
  ASSERT_EQ(file->problems().size(), 1u);
  EXPECT_EQ(file->problems()[0],
            path.string() + " is ignored: expected a regular file of yours with mode 0600.");
  EXPECT_TRUE(fs::exists(path)) << "it is kept for the user to look at";
  file->save(session("mine"), now);
  EXPECT_EQ(files().size(), 2u) << "play goes on with another file";
}

TEST_F(SessionFileTest, DirectoriesThatOthersCanWriteAreNotUsed) {
  leave("token");
  fs::permissions(directory, fs::perms::others_write, fs::perm_options::add);
  auto file = open();
  EXPECT_EQ(file->tokenFor(keyOf('a')), "");
  ASSERT_EQ(file->problems().size(), 1u);
  EXPECT_EQ(file->problems()[0],
            directory.string() + " cannot be used: expected a directory of yours with mode 0700.");
  file->save(session("mine"), now);
  EXPECT_EQ(files().size(), 1u) << "nothing is written there";
}

TEST_F(SessionFileTest, LinksAreNotFollowed) {
  leave("token");
  const fs::path elsewhere = home / "elsewhere";
  fs::rename(files()[0], elsewhere);
  fs::create_symlink(elsewhere, directory / "session-link");
  const auto file = open();
  EXPECT_EQ(file->tokenFor(keyOf('a')), "");
  EXPECT_EQ(file->problems().size(), 1u);
  EXPECT_TRUE(fs::exists(elsewhere));
}

TEST_F(SessionFileTest, AFailureToWriteIsReportedOnce) {
  put(home / "state", "a file where a directory should be");
  auto file = open();
  for (int i = 0; i < 3; ++i) file->save(session("token"), now);
  file->refresh(now + 1h);
  EXPECT_EQ(file->problems().size(), 1u);
}

TEST_F(SessionFileTest, LiesInTheStateDirectory) {
  const char* before = std::getenv("XDG_STATE_HOME");
  const std::string kept = before != nullptr ? before : "";
  setenv("XDG_STATE_HOME", "/somewhere", 1);
  EXPECT_EQ(SessionFile::defaultDirectory(), "/somewhere/naiad/sessions");
  unsetenv("XDG_STATE_HOME");
  if (const char* user = std::getenv("HOME")) {
    EXPECT_EQ(SessionFile::defaultDirectory(), fs::path(user) / ".local/state/naiad/sessions");
  }
  if (before != nullptr) setenv("XDG_STATE_HOME", kept.c_str(), 1);
}

}  // namespace
}  // namespace naiad
