// A game's log file never blocks the game, whatever kind of file it is.
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "engine/managers/Config.h"
#include "engine/managers/LogManager.h"
#include "engine/managers/ResourceManager.h"
#include "tests/server/engine/Probe.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace df::test {
namespace {

namespace fs = std::filesystem;

class LogFileTest : public WorldTest {
 protected:
  LogFileTest() {
    LM.setSink({});
    LM.setFlush(true);
    Config::getInstance().setLogFile(file.string());
  }

  naiad::test::TempFolder base;
  const fs::path file = base / "game.log";
};

TEST_F(LogFileTest, FileIsTruncatedAtStartAndNotWorldReadable) {
  std::ofstream(file) << "of yesterday\n";
  LM.writeLog("first");
  LM.writeLog("second\n");
  EXPECT_EQ(naiad::test::contentOf(file), "first\nsecond\n");
  const fs::path other = base / "other.log";
  Config::getInstance().setLogFile(other.string());
  LM.writeLog("x");
  struct stat facts {};
  ASSERT_EQ(stat(other.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0137, 0u) << std::oct << facts.st_mode;
}

TEST_F(LogFileTest, UnreadPipeDoesNotBlockTheGame) {
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  LM.writeLog("nobody is there");
  EXPECT_EQ(LM.writeMyLog(file.string(), "nobody"), -1);
  const fs::path stalled = base / "stalled";
  ASSERT_EQ(mkfifo(stalled.c_str(), 0600), 0);
  const int reader = open(stalled.c_str(), O_RDONLY | O_NONBLOCK);
  Config::getInstance().setLogFile(stalled.string());
  const std::string line(1000, 'x');
  for (int i = 0; i < 1000; ++i) LM.writeLog("%s", line.c_str());  // the pipe holds 64 KiB
  char piece[65536];
  EXPECT_GT(::read(reader, piece, sizeof piece), 0);
  while (::read(reader, piece, sizeof piece) > 0) {
  }
  LM.writeLog("read again");
  std::string seen(100, '\0');
  const ssize_t size = ::read(reader, seen.data(), seen.size());
  EXPECT_NE(seen.substr(0, size > 0 ? static_cast<std::size_t>(size) : 0).find("read again\n"),
            std::string::npos);
  close(reader);
}

TEST_F(LogFileTest, FullDiskDoesNotBlockTheGame) {
  Config::getInstance().setLogFile("/dev/full");
  for (int i = 0; i < 100; ++i) LM.writeLog("line %d", i);
  EXPECT_EQ(LM.writeMyLog("/dev/full", "line"), -1);
}

TEST_F(LogFileTest, ReadingAPipeAsAFileDoesNotBlock) {
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(RM.loadSprite(file.string(), "pipe"), -1);
  setenv("DRAGONFLY_CONFIG", file.c_str(), 1);
  Config::getInstance().loadConfig();
  unsetenv("DRAGONFLY_CONFIG");
  EXPECT_EQ(Config::getInstance().match("logfile"), "");
}

}  // namespace
}  // namespace df::test
