// dfctl restart --keep with the real programs: the round continues in the program and game that are then
// installed, if these replay it identically.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <future>
#include <iomanip>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/rounds/RoundHandover.h"
#include "host/world/WorldCheckpoints.h"
#include "shared/net/base/Limits.h"
#include "tests/server/replay/ServerFixture.h"
#include "tests/support/Processes.h"
#include "tests/support/RunProgram.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::countIn;
using test::waitUntil;

constexpr const char* kIsBack = "reconnected to the recovered round";

bool isGone(pid_t process) {
  const char state = test::stateOf(process);
  return state == 'X' || state == 'Z';
}

/// Returns the targets of a process's open descriptors, as in /proc.
std::multiset<std::string> descriptorsOf(pid_t process) {
  std::multiset<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(process) + "/fd", error))
    found.insert(fs::read_symlink(entry.path(), error).string());
  return found;
}

/// Connects to a port repeatedly, from its own address, to check that the port is never closed.
class Visitor {
 public:
  explicit Visitor(int port) : m_port(static_cast<std::uint16_t>(port)), m_thread([this] { run(); }) {}
  ~Visitor() { end(); }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;

  void end() {
    m_ends = true;
    if (m_thread.joinable()) m_thread.join();
  }
  int streams() const { return m_streams; }
  int datagrams() const { return m_datagrams; }
  int refused() const { return m_refused; }

 private:
  static sockaddr_in at(const char* p_host, std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    inet_pton(AF_INET, p_host, &address.sin_addr);
    return address;
  }
  int connectedSocket(int type) {
    const int socket = ::socket(AF_INET, type | SOCK_CLOEXEC, 0);
    const sockaddr_in from = at("127.0.9.9", 0);
    const sockaddr_in to = at("127.0.0.1", m_port);
    bind(socket, reinterpret_cast<const sockaddr*>(&from), sizeof from);
    if (connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0 && errno == ECONNREFUSED)
      ++m_refused;
    return socket;
  }
  // If the port refuses a datagram, the next call on the socket fails.
  void run() {
    const int datagrams = connectedSocket(SOCK_DGRAM);
    while (!m_ends) {
      if (send(datagrams, "x", 1, 0) == 1) ++m_datagrams;
      char answer[16];
      if (recv(datagrams, answer, sizeof answer, MSG_DONTWAIT) < 0 && errno == ECONNREFUSED) ++m_refused;
      close(connectedSocket(SOCK_STREAM));
      ++m_streams;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // slow enough for the rate limit
    }
    close(datagrams);
  }

  const std::uint16_t m_port;
  std::atomic<bool> m_ends{false};
  std::atomic<int> m_streams{0};
  std::atomic<int> m_datagrams{0};
  std::atomic<int> m_refused{0};
  std::thread m_thread;
};

/// The script of a dfreplay that never ends.
constexpr const char* kHangs = "echo $$ > replay.pid; exec sleep 300";

class KeepTest : public test::ServerFixture {
 protected:
  void SetUp() override { fs::copy_file(NAIAD_BINARY_DIR "/../lib/games/hello.so", folder / "mine.so"); }
  void TearDown() override {
    endBots(SIGKILL);
    if (server > 0 && kill(server, SIGKILL) == 0) waitpid(server, nullptr, 0);
    if (const pid_t one = replay(); one > 0) kill(one, SIGKILL);
  }

  /// `games`: options that select the games.
  void start(const std::string& journal, const std::vector<std::string>& games = {"--game=./mine.so"}) {
    fs::remove(folder / "join");
    std::vector<std::string> words{
        dfserver,         "--port=" + port(), "--port-file=port",  "--join-file=join",
        "--identity=key", "--state=off",      "--frame-time=5000", "--control=control.sock"};
    words.insert(words.end(), games.begin(), games.end());
    words.push_back("--journal=" + (journal.empty() ? "off" : journal));
    server = run(words);
    ASSERT_TRUE(waitUntil([this] { return !contentOf(folder / "join").empty(); })) << log();
  }
  /// Starts two more bots, in this room if it is named.
  void startBots(const std::string& room = {}) {
    std::vector<std::string> words{"dfbot", "--clients=2", "--random=1", "--seconds=300", "--rejoin"};
    std::istringstream join(contentOf(folder / "join"));
    for (std::string word; join >> word;) words.push_back(word);
    if (!room.empty()) words[5] += "/" + room;
    bots.push_back(run(words, "bots.txt"));
    const long players = 2 * static_cast<long>(bots.size());
    ASSERT_TRUE(waitUntil([&] { return status("players") == players; })) << contentOf(folder / "bots.txt");
  }
  void endBots(int signal) {
    for (const pid_t one : bots) kill(one, signal);
    for (const pid_t one : std::exchange(bots, {})) waitpid(one, nullptr, 0);
  }
  std::pair<int, std::string> control(const std::string& command) const {
    return test::runProgram(NAIAD_BINARY_DIR "/dfctl --control " + (folder / "control.sock").string() + " " +
                            command + " 2>&1 </dev/null");
  }
  /// Installs another version of the game.
  void install(const std::string& bytes) const {
    std::ofstream(folder / "new.so", std::ios::binary) << bytes;
    fs::rename(folder / "new.so", folder / "mine.so");
  }
  bool areBack(int times) const {
    return waitUntil([&] { return countIn(log(), kIsBack) >= times; });
  }
  /// Installs a copy of dfserver, and this script as dfreplay, in a folder. Later programs are started from
  /// it.
  void installPrograms(const std::string& replay_script) {
    fs::create_directories(folder / "bin");
    fs::copy_file(NAIAD_BINARY_DIR "/dfserver", folder / "bin/dfserver");
    fs::create_directory_symlink(NAIAD_BINARY_DIR "/../lib", folder / "lib");
    dfserver = (folder / "bin/dfserver").string();
    installScript("dfreplay", replay_script);
  }
  void installScript(const std::string& name, const std::string& script) const {
    const fs::path path = folder / "bin" / name;
    fs::remove(path);
    std::ofstream(path) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(path, fs::perms::owner_all);
  }
  /// Returns the process id that the dfreplay script wrote; 0 if it has not yet.
  pid_t replay() const { return std::atoi(contentOf(folder / "replay.pid").c_str()); }
  bool lives() const { return waitpid(server, nullptr, WNOHANG) == 0; }
  /// Returns the inode number of the socket that listens on the port; with `datagrams`, of the UDP socket.
  std::string inodeOf(bool datagrams) const {
    std::ostringstream place;
    place << ":" << std::hex << std::uppercase << std::setw(4) << std::setfill('0')
          << std::atoi(port().c_str()) << " ";
    const std::string state = datagrams ? " 07 " : " 0A ";
    const std::string tables = datagrams ? "/proc/net/udp" : "/proc/net/tcp";
    for (const std::string& table : {tables, tables + "6"}) {
      std::istringstream lines(contentOf(table));
      for (std::string line; std::getline(lines, line);) {
        const std::size_t at = line.find(place.str());
        if (at == std::string::npos || line.find(state) == std::string::npos) continue;
        std::istringstream fields(line);
        std::string field;
        for (int i = 0; i < 10; ++i) fields >> field;
        return field;
      }
    }
    return {};
  }
  /// Checks that the server has this socket and none of its child processes has it.
  void expectToHoldAlone(const std::string& inode) const {
    const std::string socket = "socket:[" + inode + "]";
    EXPECT_EQ(descriptorsOf(server).count(socket), 1u) << socket;
    for (const pid_t process : test::processesBelow(server))
      EXPECT_EQ(descriptorsOf(process).count(socket), 0u)
          << contentOf("/proc/" + std::to_string(process) + "/cmdline");
  }
  void expectOneWholeRound() {
    endBots(SIGKILL);
    end(server, SIGTERM);
    expectOneWholeRound(folder / "rounds");
  }
  void expectOneWholeRound(const fs::path& rounds) const {
    fs::directory_iterator files(rounds);
    ASSERT_NE(files, fs::directory_iterator()) << log();
    const std::string file = files->path().string();
    EXPECT_EQ(std::distance(files, fs::directory_iterator()), 1) << log();
    const auto [code, said] = test::runProgram(NAIAD_BINARY_DIR "/dfreplay " + file + " --verify --game " +
                                               (folder / "mine.so").string() + " 2>&1");
    EXPECT_EQ(code, 0) << said << log();
    for (const std::string& secret : {std::string("127.0.0.1"), folder.string()})
      EXPECT_FALSE(test::has(contentOf(file), secret)) << secret;
  }

  std::string dfserver = "dfserver";
  std::vector<pid_t> bots;
};

TEST_F(KeepTest, PlayersStayInTheRoundAndPortsStayOpen) {
  installPrograms("ls -l /proc/$$/fd > replay.fds; exec " NAIAD_BINARY_DIR "/dfreplay \"$@\"");
  start("rounds");
  startBots();
  ASSERT_TRUE(playTicks(100));
  const std::string streams = inodeOf(false);
  const std::string datagrams = inodeOf(true);
  ASSERT_NE(streams, "");
  ASSERT_NE(datagrams, "");
  std::size_t open_before = 0;
  for (int i = 1; i <= 2; ++i) {
    Visitor visitor(std::atoi(port().c_str()));
    const auto [code, said] = control("restart --keep");
    ASSERT_EQ(code, 0) << said << log();
    EXPECT_TRUE(test::has(said, "The round resumes in the installed program."));
    ASSERT_TRUE(areBack(2 * i)) << log();
    visitor.end();
    EXPECT_EQ(visitor.refused(), 0) << "of " << visitor.streams() << " and " << visitor.datagrams();
    EXPECT_GT(visitor.streams(), 3);
    EXPECT_GT(visitor.datagrams(), 3);
    EXPECT_TRUE(lives()) << "it is the same process";
    EXPECT_EQ(inodeOf(false), streams) << "players who come meanwhile wait";
    EXPECT_EQ(inodeOf(true), datagrams);
    EXPECT_FALSE(test::has(contentOf(folder / "replay.fds"), "socket:"));
    ASSERT_TRUE(playTicks(50));
    expectToHoldAlone(streams);
    expectToHoldAlone(datagrams);
    if (i == 1) open_before = descriptorsOf(server).size();
  }
  EXPECT_TRUE(test::has(log(), "replaying the round that was handed over: "));
  EXPECT_FALSE(test::has(log(), "server was killed"));
  // The server has a descriptor for each waiting copy of the world, of which new ones may have been made.
  EXPECT_TRUE(waitUntil([&] {
    return descriptorsOf(server).size() <= open_before + WorldCheckpoints::kMaxCheckpoints + 1;
  })) << open_before
      << ", and then " << descriptorsOf(server).size();
  for (const pid_t process : test::processesBelow(server)) EXPECT_NE(test::stateOf(process), 'Z') << process;
  expectOneWholeRound();
}

TEST_F(KeepTest, RebuiltGameContinuesTheRoundAndSurvivesAKill) {
  start("rounds");
  startBots();
  ASSERT_TRUE(playTicks(100));
  install(contentOf(folder / "mine.so") + "another build");
  const auto [code, said] = control("restart --keep");
  EXPECT_EQ(code, 0) << said << log();
  EXPECT_TRUE(areBack(2)) << log();
  ASSERT_TRUE(playTicks(100));
  end(server, SIGKILL);
  start("rounds");
  EXPECT_TRUE(areBack(4)) << log();
  expectOneWholeRound();
}

TEST_F(KeepTest, ChangedGameIsRefusedAndPlayersFinishTheRound) {
  start("rounds", {"--game=./mine.so", "--reconnect-time=1"});
  startBots();
  ASSERT_TRUE(playTicks(100));
  install(contentOf(NAIAD_BINARY_DIR "/../lib/games/maze.so"));
  const auto [code, said] = control("restart --keep");
  EXPECT_EQ(code, 1) << said;
  EXPECT_TRUE(test::has(said, "Cannot move the round to the installed program: tick "));
  EXPECT_TRUE(test::has(said, "The server restarts when all players have left"));
  EXPECT_TRUE(playTicks(100)) << "the game continues";
  EXPECT_EQ(status("players"), 2);
  EXPECT_EQ(countIn(log(), " hosts mine on "), 1);
  endBots(SIGKILL);
  EXPECT_TRUE(waitUntil([this] { return countIn(log(), " hosts mine on ") == 2; })) << log();
  EXPECT_TRUE(lives());
  EXPECT_TRUE(playTicks(50)) << "in the other game: " << log();
}

TEST_F(KeepTest, RoundsOfAllRoomsContinue) {
  start("rounds", {"--room=one=./mine.so", "--room=two=./mine.so", "--room=asleep=hello"});
  startBots();
  startBots("two");
  ASSERT_TRUE(playTicks(100));
  const auto [code, said] = control("restart --keep");
  ASSERT_EQ(code, 0) << said << log();
  EXPECT_TRUE(areBack(4)) << log();
  for (const char* p_room : {"one", "two"}) {
    const std::string line = "room " + std::string(p_room) + ": replaying the round that was handed over: ";
    EXPECT_EQ(countIn(log(), line), 1) << log();
  }
  EXPECT_EQ(status("players"), 4);
  ASSERT_TRUE(playTicks(50));
  install(contentOf(NAIAD_BINARY_DIR "/../lib/games/maze.so"));
  const auto [other_code, other_said] = control("restart --keep");
  EXPECT_EQ(other_code, 1);
  EXPECT_TRUE(test::has(other_said, "Cannot move the round to the installed program: room one: tick "));
  EXPECT_EQ(control("cancel").first, 0);
  EXPECT_TRUE(playTicks(50));
  EXPECT_EQ(status("players"), 4);
  install(contentOf(NAIAD_BINARY_DIR "/../lib/games/hello.so"));
  endBots(SIGKILL);
  end(server, SIGTERM);
  expectOneWholeRound(folder / "rounds/one");
  expectOneWholeRound(folder / "rounds/two");
}

TEST_F(KeepTest, KilledDfreplayIsReportedAndTheGameContinues) {
  installPrograms(kHangs);
  start("rounds");
  startBots();
  auto first = std::async(std::launch::async, [this] { return control("restart --keep"); });
  ASSERT_TRUE(waitUntil([this] { return replay() > 0; })) << log();
  EXPECT_TRUE(playTicks(50)) << "the game continues meanwhile";
  const auto [code, said] = control("restart --keep");
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(test::has(said, "Cannot keep the round: a handover is already in progress."));
  kill(replay(), SIGKILL);
  const auto [first_code, first_said] = first.get();
  EXPECT_EQ(first_code, 1);
  EXPECT_TRUE(test::has(first_said, "dfreplay was killed by signal 9"));
  EXPECT_TRUE(playTicks(50));
  EXPECT_EQ(status("players"), 2);
  EXPECT_EQ(control("cancel").first, 0) << "it was to begin again when all have left";
}

TEST_F(KeepTest, ServerShutdownEndsTheTrialReplay) {
  installPrograms(kHangs);
  start("rounds");
  startBots();
  auto first = std::async(std::launch::async, [this] { return control("restart --keep"); });
  ASSERT_TRUE(waitUntil([this] { return replay() > 0; })) << log();
  kill(server, SIGINT);
  EXPECT_EQ(waitpid(std::exchange(server, 0), nullptr, 0) > 0, true);
  EXPECT_NE(first.get().first, 0);
  EXPECT_TRUE(isGone(replay()));
}

TEST_F(KeepTest, ProgramRejectingTheOptionsIsRefused) {
  installPrograms("exit 0");
  start("rounds");
  ASSERT_TRUE(playTicks(10));
  installScript("dfserver", "echo 'dfserver: there is no option --journal' >&2; exit 2");
  const auto [code, said] = control("restart --keep");
  EXPECT_EQ(code, 1);
  EXPECT_TRUE(test::has(
      said, "the installed dfserver rejects this server's options: dfserver: there is no option --journal"));
  EXPECT_TRUE(test::has(said, "Cannot keep the round: "));
  EXPECT_NE(control("cancel").first, 0) << "nor is it begun later";
  EXPECT_TRUE(playTicks(10)) << log();
  EXPECT_TRUE(lives());
}

TEST_F(KeepTest, WorldsStartAfterTheirProgramWasReplaced) {
  installPrograms("exit 0");
  start("rounds");
  startBots();
  ASSERT_TRUE(waitUntil([this] { return countTurns(round()) > 0; })) << log();
  installScript("dfserver", "exit 2");
  const auto children = test::processesBelow(server);
  for (const int signal : {SIGSTOP, SIGKILL})  // stopped first, so that no copy of the world replaces it
    for (const pid_t process : children) kill(process, signal);
  EXPECT_TRUE(isLogged("game recovered: a new world replayed ")) << log();
  EXPECT_TRUE(playTicks(10)) << log();
}

ChildExit ended(int code, const std::string& output_text) {
  return {.code = code, .output_text = output_text};
}

TEST(RoundHandoverTest, VerdictFollowsDfreplaysOutput) {
  const std::string good = "note: x\nverified ticks=9 times_real_time=9 protocol=";
  const std::string ours = std::to_string(kProtocolVersion);
  EXPECT_EQ(parseVerifyResult(ended(0, good + ours + " read to its end\n")), "");
  EXPECT_EQ(parseVerifyResult(ended(0, good + "9000 read to its end\n")),
            "it uses protocol 9000, but the players' clients use " + ours);
  EXPECT_EQ(parseVerifyResult(ended(0, "verified ticks=9\n")), "it does not report its protocol version");
  EXPECT_EQ(parseVerifyResult(
                ended(1, "note: x\ntick 51: the state differs from the recording\nPicture of player 1\n")),
            "tick 51: the state differs from the recording");
  EXPECT_EQ(parseVerifyResult(ended(3, "dfreplay: the file is damaged.\n")), "dfreplay: the file is damaged");
  EXPECT_EQ(parseVerifyResult(ended(3, "")), "dfreplay ended with code 3");
  EXPECT_EQ(parseVerifyResult(ended(ChildExit::kNotStarted, "")), "dfreplay cannot be started");
  EXPECT_EQ(parseVerifyResult({.timed_out = true, .output_text = {}}), "dfreplay timed out");
}

}  // namespace
}  // namespace naiad
