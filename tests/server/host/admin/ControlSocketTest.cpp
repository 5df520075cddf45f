#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "Talk.h"
#include "host/admin/ControlFile.h"
#include "host/admin/ControlSocket.h"
#include "shared/admin/AdminJson.h"
#include "shared/admin/ControlPath.h"
#include "shared/net/stream/TcpListener.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using test::Talk;

const char* const kPing = R"({"command":"ping"})";

class ControlSocketTest : public testing::Test {
 protected:
  ControlSocketTest() { options.path = folder / "control.sock"; }

  /// Opens a socket that answers each command with its text. While `held`, "say" waits for release().
  std::unique_ptr<ControlSocket> open() {
    return std::make_unique<ControlSocket>(
        options,
        [this](const AdminRequest& request, const AdminCaller& caller,
               std::function<void(AdminAnswer)> done) {
          const std::lock_guard lock(mutex);
          callers.push_back(caller);
          if (request.command->name == "say" && held) return waiting.push_back(std::move(done));
          done(AdminAnswer::done(request.redacted()));
        },
        feed,
        [this](const std::string& line) {
          const std::lock_guard lock(mutex);
          log.push_back(line);
        });
  }
  void release() {
    std::vector<std::function<void(AdminAnswer)>> all;
    {
      const std::lock_guard lock(mutex);
      held = false;
      all.swap(waiting);
    }
    for (const auto& done : all) done(AdminAnswer::done("at last"));
  }
  /// Waits until a command waits for release().
  void awaitCommand() {
    for (;; std::this_thread::yield()) {
      const std::lock_guard lock(mutex);
      if (!waiting.empty()) return;
    }
  }
  bool exists() const { return fs::exists(fs::symlink_status(options.path)); }

  const test::TempFolder folder;
  ControlSocketOptions options;
  EventFeed feed;
  std::mutex mutex;
  bool held = false;
  std::vector<std::function<void(AdminAnswer)>> waiting;
  std::vector<AdminCaller> callers;
  std::vector<std::string> log;
};

TEST_F(ControlSocketTest, CommandIsAnsweredAndItsSenderIdentified) {
  const auto control = open();
  Talk talk(options.path);
  EXPECT_EQ(talk.ask(kPing), R"({"ok":true,"text":"ping"})");
  EXPECT_EQ(talk.ask(R"({"command":"kick","arguments":{"player":"Ann"}})"),
            R"({"ok":true,"text":"kick \"Ann\""})");
  const std::lock_guard lock(mutex);
  ASSERT_EQ(callers.size(), 2u);
  EXPECT_EQ(callers[0].name, "user " + std::to_string(getuid()) + ", process " + std::to_string(getpid()));
  EXPECT_EQ(callers[0].level, AdminCommand::Level::kAdmin);
}

TEST_F(ControlSocketTest, SocketHasMode0660AndIsRemovedOnClose) {
  options.path = folder / "deep" / "er" / "control.sock";
  auto control = open();
  EXPECT_EQ(test::modeOf(options.path), 0660u);
  EXPECT_EQ(test::modeOf(options.path.parent_path()), 0750u);
  control.reset();
  EXPECT_FALSE(exists());
  EXPECT_TRUE(fs::is_empty(options.path.parent_path()));
}

TEST_F(ControlSocketTest, OnlyAStaleSocketIsReplaced) {
  auto control = open();
  EXPECT_THROW(open(), ListenError);
  EXPECT_EQ(Talk(options.path).ask(kPing), R"({"ok":true,"text":"ping"})") << "the first one lives";
  control.reset();
  ASSERT_TRUE(test::leaveSocket(options.path));
  ASSERT_TRUE(exists());
  control = open();
  EXPECT_EQ(Talk(options.path).ask(kPing), R"({"ok":true,"text":"ping"})");
}

TEST_F(ControlSocketTest, NonSocketPathIsRefusedAndKept) {
  std::ofstream(options.path) << "mine";
  EXPECT_THROW(open(), ListenError);
  EXPECT_EQ(fs::file_size(options.path), 4u);
  fs::remove(options.path);
  fs::create_symlink(folder / "elsewhere", options.path);
  EXPECT_THROW(open(), ListenError);
  options.path = folder / std::string(120, 'x');
  EXPECT_THROW(open(), ListenError);
}

TEST_F(ControlSocketTest, OnlyStaleServerSocketsAreRemoved) {
  options.path = folder / "control-1.sock";
  const auto control = open();
  std::ofstream(folder / "control-2.sock") << "no socket";
  for (const char* name : {"control-3.sock", "other.sock"}) ASSERT_TRUE(test::leaveSocket(folder / name));
  removeStaleControls(folder);
  EXPECT_TRUE(exists());
  EXPECT_TRUE(fs::exists(folder / "control-2.sock"));
  EXPECT_FALSE(fs::exists(folder / "control-3.sock"));
  EXPECT_TRUE(fs::exists(folder / "other.sock"));
  EXPECT_EQ(controlSockets(folder), std::vector<fs::path>{options.path});
}

TEST_F(ControlSocketTest, HostileLinesGetAnErrorAndTheConnectionStays) {
  const auto control = open();
  Talk talk(options.path);
  std::vector<std::string> lines{"",
                                 "who",
                                 "{",
                                 "}{",
                                 "[]",
                                 "[[[[[[[[",
                                 "null",
                                 "\xff\xfe\xfd",
                                 "\x1b[2J",
                                 R"({"command":"nothing"})",
                                 R"({"command":"who","command":"who"})",
                                 R"({"command":"kick"})",
                                 R"({"command":"kick","arguments":{"x":1}})",
                                 R"({"command":"help"} trailing)",
                                 std::string("{\"command\":\"pi\0ng\"}", 19),
                                 "GET / HTTP/1.1\r",
                                 std::string(4096, 'x'),
                                 std::string(4096, '['),
                                 std::string(4097, 'x'),
                                 std::string(100'000, '{'),
                                 std::string(1'000'000, 'y')};
  for (std::size_t i = 0; i <= std::string(kPing).size(); ++i) {
    if (i < std::string(kPing).size()) lines.push_back(std::string(kPing).substr(0, i));
    std::string flipped = kPing;
    if (i < flipped.size()) flipped[i] = static_cast<char>(flipped[i] ^ 0x80);
    if (i < flipped.size()) lines.push_back(flipped);
  }
  for (const std::string& line : lines) {
    const std::string answer = talk.ask(line);
    EXPECT_EQ(answer.rfind(R"({"ok":false,"error":")", 0), 0u) << line.substr(0, 40) << ": " << answer;
    EXPECT_LE(answer.size(), kMaxControlLine);
    ASSERT_EQ(talk.ask(kPing), R"({"ok":true,"text":"ping"})") << line.substr(0, 40);
  }
}

TEST_F(ControlSocketTest, LinesMayComeInPiecesAndTogether) {
  const auto control = open();
  Talk talk(options.path);
  const std::string line = std::string(kPing) + "\n";
  for (const char c : line) talk.send(std::string(1, c));
  EXPECT_EQ(talk.readLine(), R"({"ok":true,"text":"ping"})");
  std::string many;
  for (int i = 0; i < 1000; ++i) many += line;
  std::thread writer([&] { talk.send(many); });
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(talk.readLine(), R"({"ok":true,"text":"ping"})");
  writer.join();
}

TEST_F(ControlSocketTest, HalfClosedClientStillGetsItsAnswer) {
  held = true;
  const auto control = open();
  Talk talk(options.path);
  talk.send("{\"command\":\"say\",\"arguments\":{\"text\":\"x\"}}\n");
  talk.shutDown();
  awaitCommand();
  release();
  EXPECT_EQ(talk.readLine(), R"({"ok":true,"text":"at last"})");
  EXPECT_FALSE(talk.readLine());
}

TEST_F(ControlSocketTest, LastConnectionIsReservedForShortCommands) {
  options.short_time = std::chrono::seconds(4);
  const auto control = open();
  std::vector<std::unique_ptr<Talk>> talks;
  for (std::size_t i = 0; i + 1 < options.max_connections; ++i) {
    talks.push_back(std::make_unique<Talk>(options.path));
    ASSERT_EQ(talks.back()->ask(R"({"command":"watch"})"), R"({"ok":true,"text":"The log follows."})");
  }
  Talk last(options.path);
  EXPECT_EQ(last.ask(kPing), R"({"ok":true,"text":"ping"})");
  EXPECT_TRUE(test::has(last.ask(R"({"command":"watch"})"), "short commands"));
  EXPECT_FALSE(last.readLine()) << "it has had its time";
  Talk next(options.path);
  EXPECT_EQ(next.ask(kPing), R"({"ok":true,"text":"ping"})") << "the place is free again";
}

TEST_F(ControlSocketTest, ConnectionBeyondTheLimitGetsAnError) {
  options.short_time = std::chrono::minutes(10);
  const auto control = open();
  std::vector<std::unique_ptr<Talk>> talks;
  for (std::size_t i = 0; i < options.max_connections; ++i) {
    talks.push_back(std::make_unique<Talk>(options.path));
    ASSERT_EQ(talks.back()->ask(kPing), R"({"ok":true,"text":"ping"})");
  }
  Talk more(options.path);
  EXPECT_EQ(more.readLine(), R"({"ok":false,"error":"Too many connections are open."})");
  EXPECT_FALSE(more.readLine());
}

TEST_F(ControlSocketTest, RefusedPeersAreDisconnected) {
  options.is_refused = [](pid_t process) { return process == getpid(); };
  const auto control = open();
  Talk talk(options.path);
  talk.send(std::string(kPing) + "\n");
  EXPECT_FALSE(talk.readLine());
  const std::lock_guard lock(mutex);
  EXPECT_TRUE(callers.empty());
}

TEST_F(ControlSocketTest, AWatcherSeesWhatIsPublished) {
  const auto control = open();
  Talk talk(options.path);
  ASSERT_EQ(talk.ask(R"({"command":"watch"})"), R"({"ok":true,"text":"The log follows."})");
  ASSERT_EQ(talk.ask(kPing), R"({"ok":true,"text":"ping"})");  // the answer shows that watching has begun
  feed.publish("log", "first\nline");
  feed.publish("chat", "\"Ann\": \x1b");
  EXPECT_EQ(talk.readLine(), R"({"event":"log","text":"first\nline"})");
  EXPECT_EQ(talk.readLine(), R"({"event":"chat","text":"\"Ann\": \u001b"})");
}

TEST_F(ControlSocketTest, StalledWatcherLosesEventsAndLearnsTheCount) {
  const auto control = open();
  Talk stalled(options.path);
  Talk other(options.path);
  ASSERT_EQ(stalled.ask(R"({"command":"watch"})"), R"({"ok":true,"text":"The log follows."})");
  ASSERT_EQ(stalled.ask(kPing), R"({"ok":true,"text":"ping"})");
  constexpr int kEvents = 20'000;
  for (int i = 0; i < kEvents; ++i) feed.publish("log", std::string(100, 'x') + std::to_string(i));
  EXPECT_EQ(other.ask(kPing), R"({"ok":true,"text":"ping"})") << "others are served meanwhile";
  std::uint64_t seen = 0;
  std::uint64_t dropped = 0;
  while (seen + dropped < kEvents) {
    const auto line = stalled.readLine();
    ASSERT_TRUE(line) << seen << " seen, " << dropped << " dropped";
    AnswerReader reader;
    const auto got = reader.readLine(*line);
    if (got == AnswerReader::LineKind::kEvent) ++seen;
    if (got == AnswerReader::LineKind::kDropped) dropped += reader.dropped();
  }
  EXPECT_EQ(seen + dropped, static_cast<std::uint64_t>(kEvents));
  EXPECT_GT(dropped, 0u);
}

TEST_F(ControlSocketTest, AnswerAfterCloseIsDropped) {
  held = true;
  auto control = open();
  Talk talk(options.path);
  talk.send("{\"command\":\"say\",\"arguments\":{\"text\":\"x\"}}\n");
  awaitCommand();
  control.reset();
  release();
  EXPECT_FALSE(talk.readLine());
}

}  // namespace
}  // namespace naiad
