// The real programs: dfserver records a round of bots, dfreplay verifies it, and a killed server loses no
// turn.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <filesystem>
#include <string>

#include "tests/server/replay/ServerFixture.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::waitUntil;

int waitFor(pid_t process) {
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

class ServerRoundTest : public test::ServerFixture {
 protected:
  pid_t startServer(const std::string& more) {
    fs::remove(folder / "port");
    server = run({"dfserver", "--game=saucershoot", "--insecure", "--port=0", "--port-file=port",
                  "--journal=rounds", more});
    waitUntil([this] { return !contentOf(folder / "port").empty(); });
    return server;
  }
  pid_t startBots() const {
    return run({"dfbot", "127.0.0.1:" + port(), "--insecure", "--clients=2", "--random=1", "--seconds=4"});
  }
  int verify(const fs::path& file) const { return waitFor(run({"dfreplay", file.string(), "--verify"})); }
};

TEST_F(ServerRoundTest, RoundOfTwoBotsReplaysIdentically) {
  startServer("--exit-when-empty=1");
  EXPECT_EQ(waitFor(startBots()), 0) << log();
  EXPECT_EQ(waitFor(server), 0) << log();
  EXPECT_EQ(verify(round()), 0) << log();
  const std::string out = log();
  EXPECT_TRUE(test::has(out, "verified ticks="));
  EXPECT_FALSE(test::has(out, "not repeatable"));
  for (const std::string& secret : {std::string("127.0.0.1"), folder.string()})
    EXPECT_FALSE(test::has(contentOf(round()), secret)) << secret;
}

TEST_F(ServerRoundTest, RoundOfAKilledServerGetsItsUnwrittenTurns) {
  startServer("--reconnect-time=5");
  pid_t bots = startBots();
  EXPECT_TRUE(waitUntil([this] { return countTurns(round()) >= 30; })) << log();
  kill(server, SIGKILL);
  EXPECT_EQ(waitFor(server), 128 + SIGKILL);
  end(bots, SIGKILL);
  const std::size_t before = countTurns(round());
  const fs::path killed = round();
  EXPECT_EQ(waitFor(startServer("--ticks=1")), 0);
  EXPECT_TRUE(test::has(log(), "its last turns were added from memory"));
  EXPECT_GE(countTurns(killed), before);
  EXPECT_EQ(verify(killed), 0) << log();
}

}  // namespace
}  // namespace naiad
