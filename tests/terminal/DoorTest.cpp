// The ssh door with a real sshd on loopback: deploy/door sets it up, and ssh connects through it.
#include <gtest/gtest.h>
#include <signal.h>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "ProgramEnd.h"
#include "PtyTerminal.h"
#include "tests/support/RunProgram.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/TempFolder.h"

namespace naiad::test {
namespace {

namespace fs = std::filesystem;
using asio::ip::tcp;

/// Returns a port that was free a moment ago.
std::string freePort() {
  asio::io_context context;
  const tcp::acceptor acceptor(context, {asio::ip::address_v4::loopback(), 0});
  return std::to_string(acceptor.local_endpoint().port());
}

std::string firstLine(const std::string& command) {
  const std::string text = runProgram(command).second;
  return text.substr(0, text.find('\n'));
}

/// Splits a file at its zero bytes, like /proc/PID/cmdline.
std::vector<std::string> zeroEnded(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  return words;
}

class DoorTest : public testing::Test {
 protected:
  void SetUp() override {
    if (firstLine("PATH=$PATH:/usr/sbin command -v sshd").empty() || firstLine("command -v ssh").empty())
      GTEST_SKIP() << "no sshd here: openssh-server is not installed";
  }

  std::unique_ptr<PtyTerminal> run(const std::vector<std::string>& command,
                                   const std::map<std::string, std::string>& environment = {}) {
    PtyTerminal::Options options;
    options.command = command;
    options.environment = environment;
    options.environment["NAIAD_BIN"] = fs::path(programPath("dfdoor")).parent_path();
    options.columns = 120;
    return std::make_unique<PtyTerminal>(options);
  }
  void door(const std::vector<std::string>& words) {
    std::vector<std::string> command{NAIAD_SOURCE_DIR "/deploy/door"};
    command.insert(command.end(), words.begin(), words.end());
    const auto program = run(command);
    EXPECT_EQ(program->waitForExit(), 0) << program->output();
  }

  /// Starts a server with a visitors' socket, and a door to it.
  void open(const std::vector<std::string>& options = {}) {
    m_server = run({programPath("dfserver"), "--game", "hello", "--address", "127.0.0.1", "--port", "0",
                    "--identity", m_home / "identity", "--proxy-socket", m_home / "hello.visitors"});
    ASSERT_TRUE(m_server->waitFor("Only this machine can join")) << m_server->output();
    m_link = linkIn(m_server->output());
    ASSERT_TRUE(m_link.starts_with("naiad://")) << m_server->output();
    for (int i = 0; i < 5 && !m_door; ++i) openAt(freePort(), options);
    ASSERT_TRUE(m_door);
    makeKey("ann");
    makeKey("bob");
  }
  void openAt(const std::string& port, std::vector<std::string> options) {
    m_port = port;
    options.insert(options.begin(), {"setup", m_home / "door", "--port", port});
    door(options);
    door({"add", m_home / "door", "hello", m_link, m_home / "hello.visitors"});
    m_door = run({NAIAD_SOURCE_DIR "/deploy/door", "run", m_home / "door"});
    const bool decided = m_door->waitUntil(
        [this] { return has(m_door->output(), "Server listening") || has(m_door->output(), "in use"); });
    if (!decided || has(m_door->output(), "in use")) m_door.reset();
  }
  void makeKey(const std::string& name) {
    const auto program =
        run({firstLine("command -v ssh-keygen"), "-q", "-t", "ed25519", "-N", "", "-f", m_home / name});
    EXPECT_EQ(program->waitForExit(), 0) << program->output();
  }

  std::vector<std::string> ssh(const std::string& key, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> command{firstLine("command -v ssh"), "-F", "none", "-p", m_port};
    command.insert(command.end(), {"-i", m_home / key, "-o", "IdentitiesOnly=yes", "-o", "BatchMode=yes"});
    command.insert(command.end(), {"-o", "StrictHostKeyChecking=accept-new", "-o",
                                   "UserKnownHostsFile=" + (m_home / "known_hosts").string()});
    command.insert(command.end(), options.begin(), options.end());
    command.push_back(firstLine("id -un") + "@127.0.0.1");
    return command;
  }
  /// Connects a visitor. Where this sshd can allocate terminals, it then asks for a name.
  PtyTerminal* visit(const std::string& key, const std::vector<std::string>& options = {},
                     const std::map<std::string, std::string>& environment = {}) {
    m_visitors.push_back(run(ssh(key, options), environment));
    return m_visitors.back().get();
  }
  /// Connects a visitor and joins the game. Null if this machine's sshd cannot allocate terminals.
  PtyTerminal* play(const std::string& key, const std::vector<std::string>& options = {},
                    const std::map<std::string, std::string>& environment = {}) {
    PtyTerminal* p_visitor = visit(key, options, environment);
    if (!p_visitor->waitFor("Your name?")) {
      m_door->read(std::chrono::milliseconds(100));
      EXPECT_TRUE(has(m_door->output(), "Operation not permitted"))
          << p_visitor->output() << m_door->output();
      return nullptr;
    }
    p_visitor->forget();
    p_visitor->type(key + "\r");
    EXPECT_TRUE(p_visitor->waitFor(" player")) << p_visitor->output() << m_server->output();
    return p_visitor;
  }
  static void expectEnd(PtyTerminal& program, const std::string& sentence) {
    program.waitForExit();
    EXPECT_TRUE(has(program.output(), sentence));
  }
  bool serverSays(const std::string& text) { return m_server->waitFor(text); }
  /// Returns the process of this door's dfclient that plays under this name; 0 if not found.
  pid_t clientOf(const std::string& name) const {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::vector<std::string> words = zeroEnded(entry.path() / "cmdline");
      if (words.size() < 4 || !words[0].ends_with("/dfclient") || words[1] != m_link) continue;
      if (words[2] == "--name=" + name) return static_cast<pid_t>(std::stol(entry.path().filename()));
    }
    return 0;
  }

  /// True if no visitor is left in this door.
  bool isEmpty() const {
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::vector<std::string> words = zeroEnded(entry.path() / "cmdline");
      if (words.size() > 2 && words[0].ends_with("/dfdoor") && has(words[2], m_home.string())) return false;
    }
    return true;
  }

  TempFolder m_home;
  std::string m_link;
  std::string m_port;
  std::unique_ptr<PtyTerminal> m_server;
  std::unique_ptr<PtyTerminal> m_door;
  std::vector<std::unique_ptr<PtyTerminal>> m_visitors;
};

#define NAIAD_SKIP_WITHOUT(terminal) \
  if ((terminal) == nullptr) GTEST_SKIP() << "this sshd, which is not root's, gives no terminals here"

TEST_F(DoorTest, TwoVisitorsPlayUnderTheirOwnAddresses) {
  open();
  PtyTerminal* ann = play("ann", {"-b", "127.0.0.2"});
  NAIAD_SKIP_WITHOUT(ann);
  EXPECT_TRUE(serverSays("\"ann\" joined")) << m_server->output();
  EXPECT_TRUE(has(m_server->output(), "127.0.0.2:"));
  // The ssh command that the door prints has these options.
  PtyTerminal* bob = play("bob", {"-b", "127.0.0.3", "-o", "IgnoreUnknown=ObscureKeystrokeTiming", "-o",
                                  "ObscureKeystrokeTiming=no"});
  ASSERT_NE(bob, nullptr);
  EXPECT_TRUE(serverSays("\"bob\" joined")) << m_server->output();
  EXPECT_TRUE(has(m_server->output(), "127.0.0.3:"));
  bob->forget();
  ann->type("\035t");
  ann->type("greetings\r");
  EXPECT_TRUE(bob->waitFor("greetings")) << bob->newOutput();
  ann->type("\003");
  EXPECT_TRUE(serverSays("\"ann\" left")) << m_server->output();
  expectEnd(*ann, "");
}

TEST_F(DoorTest, BrokenConnectionKeepsTheSession) {
  open();
  PtyTerminal* ann = play("ann");
  NAIAD_SKIP_WITHOUT(ann);
  ASSERT_TRUE(serverSays("\"ann\" joined")) << m_server->output();
  ann->signal(SIGKILL);
  ann->waitForExit();
  ASSERT_TRUE(m_server->waitUntil([this] { return isEmpty(); }));
  PtyTerminal* again = visit("ann");
  ASSERT_TRUE(again->waitFor("Your name? [ann]")) << again->output();
  again->type("\r");
  EXPECT_TRUE(serverSays("\"ann\" reconnected with a new client")) << m_server->output();
  EXPECT_FALSE(has(m_server->output(), "\"ann\" left"));
}

/// The old connection is dead but not yet timed out.
TEST_F(DoorTest, VisitorResumesInAnotherTerminal) {
  open();
  PtyTerminal* ann = play("ann");
  NAIAD_SKIP_WITHOUT(ann);
  ASSERT_TRUE(serverSays("\"ann\" joined")) << m_server->output();
  PtyTerminal* again = visit("ann");
  ASSERT_TRUE(again->waitFor("You are already playing here")) << again->output();
  again->type("\r");
  ASSERT_TRUE(again->waitFor("Your name? [ann]")) << again->output();
  again->type("\r");
  EXPECT_TRUE(serverSays("\"ann\" reconnected with a new client")) << m_server->output();
  expectEnd(*ann, "");
}

TEST_F(DoorTest, NoCommandRuns) {
  open();
  for (const std::string& command :
       {std::string("id; echo pwned-$((6*7))"), std::string("$(touch pwned)"), std::string("-oX"),
        std::string("scp -t /tmp"), std::string("\033[2J`id`")}) {
    for (const char* terminal : {"-T", "-tt"}) {
      auto words = ssh("ann", {terminal});
      words.push_back("--");
      words.push_back(command);
      const auto visitor = run(words);
      visitor->waitForExit();
      if (has(m_door->output(), "Operation not permitted"))
        GTEST_SKIP() << "this sshd gives no terminals here";
      EXPECT_TRUE(has(visitor->output(), "This door does not run commands"));
      EXPECT_FALSE(has(visitor->output(), "uid=") || has(visitor->output(), "pwned-42"));
      EXPECT_TRUE(exits(*visitor, 2));
    }
  }
  auto words = ssh("ann", {"-s"});
  words.push_back("sftp");
  const auto sftp = run(words);
  EXPECT_NE(sftp->waitForExit(), 0);
  expectEnd(*run(ssh("ann", {"-T"})), "A terminal is required");
  EXPECT_FALSE(has(m_server->output(), "joined"));
}

TEST_F(DoorTest, NothingIsForwarded) {
  open();
  const std::string server = m_link.substr(m_link.find("//") + 2, m_link.find('#') - m_link.find("//") - 2);
  const auto direct = run(ssh("ann", {"-W", server}));
  EXPECT_NE(direct->waitForExit(), 0);
  EXPECT_TRUE(has(direct->output(), "prohibited") || has(direct->output(), "failed"));
  const auto remote = run(ssh("ann", {"-N", "-o", "ExitOnForwardFailure=yes", "-R", "0:" + server}));
  EXPECT_NE(remote->waitForExit(), 0) << remote->output();
}

TEST_F(DoorTest, ClientGetsDoorEnvironmentAndPlainTerminalType) {
  open();
  PtyTerminal* ann = play("ann", {"-o", "SetEnv=LD_PRELOAD=/nowhere/x.so NAIAD_SERVER=evil LANG=x LC_ALL=y"},
                          {{"TERM", "../../../../etc/passwd"}});
  NAIAD_SKIP_WITHOUT(ann);
  pid_t client = 0;
  ASSERT_TRUE(m_server->waitUntil([&] { return (client = clientOf("ann")) != 0; }));
  const auto variables = zeroEnded("/proc/" + std::to_string(client) + "/environ");
  ASSERT_EQ(variables.size(), 7u);
  for (const std::string& variable : variables) {
    const std::string name = variable.substr(0, variable.find('='));
    const bool is_home = name == "HOME" || name.starts_with("XDG_");
    EXPECT_TRUE(is_home ? has(variable, (m_home / "door" / "state" / "keys").string())
                        : variable == "PATH=/usr/bin:/bin" || variable == "LC_ALL=C.UTF-8" ||
                              variable == "TERM=xterm-256color")
        << variable;
  }
  ann->forget();
  ann->resize(19, 9);
  EXPECT_TRUE(ann->waitFor("too small")) << ann->newOutput();
  ann->forget();
  ann->resize(120, 30);
  EXPECT_TRUE(ann->waitFor(" player")) << ann->newOutput() << ": the size follows the visitor's terminal";
  ann->forget();
  ann->type("\032\007h");
  EXPECT_TRUE(ann->waitFor("Ctrl-G")) << ann->newOutput() << ": Ctrl-Z suspends nothing";
  EXPECT_NE(clientOf("ann"), 0);
}

TEST_F(DoorTest, NamesAreNotOptionsOrCommands) {
  open();
  PtyTerminal* ann = visit("ann");
  if (!ann->waitFor("Your name?")) GTEST_SKIP() << "this sshd, which is not root's, gives no terminals here";
  ann->type("--help $(id)\r");
  EXPECT_TRUE(serverSays("\"--help $(id)\" joined")) << m_server->output() << ann->output();
}

TEST_F(DoorTest, PlacesAreLimited) {
  open({"--max-visitors", "1"});
  PtyTerminal* ann = play("ann");
  NAIAD_SKIP_WITHOUT(ann);
  expectEnd(*visit("bob"), "All places are taken");
  ann->type("\003");
  ann->waitForExit();
  EXPECT_TRUE(visit("bob")->waitFor("Your name?"));
}

TEST_F(DoorTest, IdleVisitorIsDisconnected) {
  open({"--idle-limit", "2"});
  PtyTerminal* ann = play("ann");
  NAIAD_SKIP_WITHOUT(ann);
  expectEnd(*ann, "You left: no input for too long");
  EXPECT_TRUE(serverSays("\"ann\" left")) << m_server->output();
}

TEST_F(DoorTest, VisitorsChooseOnlyAmongTheListedGames) {
  open();
  door({"add", m_home / "door", "other", m_link, m_home / "other.visitors"});
  PtyTerminal* ann = visit("ann");
  if (!ann->waitFor("Which game?")) GTEST_SKIP() << "this sshd, which is not root's, gives no terminals here";
  for (const char* answer : {"127.0.0.1:22", "3", "../hello"}) {
    ann->forget();
    ann->type(std::string(answer) + "\r");
    EXPECT_TRUE(ann->waitFor("Type a number from 1 to")) << ann->output();
  }
  ann->waitForExit();
  PtyTerminal* again = visit("ann");
  ASSERT_TRUE(again->waitFor("Which game?")) << again->output();
  again->type("1\r");
  EXPECT_TRUE(again->waitFor("Your name?")) << again->output();
}

TEST_F(DoorTest, SilentConnectionsDoNotCloseIt) {
  open();
  asio::io_context context;
  std::vector<tcp::socket> sockets;
  const tcp::endpoint silent(asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(std::stoi(m_port)));
  for (int i = 0; i < 30; ++i) sockets.emplace_back(context).connect(silent);
  // Uses another address, because silent connections are limited per address.
  PtyTerminal* bob = visit("bob", {"-b", "127.0.0.2"});
  const bool in = bob->waitFor("Your name?");
  sockets.clear();
  if (!in && has(m_door->output(), "Operation not permitted"))
    GTEST_SKIP() << "this sshd gives no terminals here";
  EXPECT_TRUE(in) << bob->output();
}

TEST_F(DoorTest, RemoveDeletesTheDoorsFolder) {
  open();
  m_door.reset();
  m_server.reset();
  door({"remove", m_home / "door"});
  EXPECT_FALSE(fs::exists(m_home / "door"));
}

/// Needs no sshd: dfdoor runs on a terminal of the test, and a program that prints its limits is its client.
TEST(DoorClientTest, MemoryAndProcessorTimeAreLimited) {
  if (kSanitized) GTEST_SKIP() << "the memory of a sanitizer is not limited";
  const TempFolder home;
  std::ofstream(home / "client") << "#!/bin/sh\nexec cat /proc/self/limits\n";
  fs::permissions(home / "client", fs::perms::owner_all);
  std::ofstream(home / "games.list") << "hello naiad://127.0.0.1:9#abcdefghijklmnopqrstuvwxya /nowhere\n";
  PtyTerminal::Options options;
  options.command = {programPath("dfdoor"), "--games",  home / "games.list", "--state",
                     home / "state",        "--client", home / "client"};
  options.environment["SSH_CONNECTION"] = "192.0.2.7 50312 198.51.100.1 22";
  PtyTerminal visitor(options);
  ASSERT_TRUE(visitor.waitFor("Your name?")) << visitor.output();
  visitor.type("ann\r");
  EXPECT_TRUE(exits(visitor, 0));
  std::map<std::string, std::string> limits;  // soft and hard limit by name
  std::istringstream lines(visitor.newOutput());
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 67) continue;
    std::istringstream numbers(line.substr(26, 41));
    std::string soft, hard;
    numbers >> soft >> hard;
    limits[line.substr(0, line.find("  "))] = soft + " " + hard;
  }
  EXPECT_EQ(limits["Max data size"], "134217728 134217728");
  EXPECT_EQ(limits["Max cpu time"], "7200 7200");
  EXPECT_EQ(limits["Max core file size"], "0 0");
}

/// Installs below a folder instead of /: sshd accepts the configuration, and uninstalling leaves no file.
TEST_F(DoorTest, InstallWritesASafeConfigAndUninstallRemovesIt) {
  const std::string place = m_home / "root";
  door({"install", "--root", place});
  std::stringstream text;
  text << std::ifstream(place + "/etc/naiad/door/sshd_config").rdbuf();
  for (const char* line : {"\nAllowUsers play\n", "\nDisableForwarding yes\n", "\nPermitEmptyPasswords no\n",
                           "\nPermitUserRC no\n", "\nPermitUserEnvironment no\n", "\nMaxSessions 1\n",
                           "\nForceCommand exec /usr/lib/naiad-door/dfdoor "})
    EXPECT_TRUE(has(text.str(), line)) << line;
  EXPECT_FALSE(has(text.str(), "AcceptEnv"));
  door({"uninstall", "--root", place});
  for (const auto& entry : fs::recursive_directory_iterator(place))
    EXPECT_TRUE(entry.is_directory()) << entry.path();
}

}  // namespace
}  // namespace naiad::test
