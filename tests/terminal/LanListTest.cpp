// The real programs: without a server argument, dfclient lists the servers on loopback and joins one.
#include <gtest/gtest.h>
#include <signal.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>

#include "HomeFixture.h"
#include "client/lan/LanBrowser.h"
#include "shared/net/base/Limits.h"
#include "shared/net/lan/LanSocket.h"
#include "tests/support/net/LanLock.h"

namespace naiad::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDown = "\033[B";
constexpr const char* kHome = "\033[H";

class LanListTest : public HomeFixture {
 protected:
  ~LanListTest() override { m_server.reset(); }

  void serve(const std::string& lan = "on", const std::string& password = "") {
    HomeFixture::serve("hello", {"--server-name", m_name, "--lan", lan}, password);
  }
  std::string key() const { return m_link.substr(m_link.find('#') + 1); }
  std::string address() const { return m_link.substr(8, m_link.find('#') - 8); }

  std::unique_ptr<PtyTerminal> client(const std::vector<std::string>& more = {},
                                      const std::map<std::string, std::string>& environment = {}) {
    PtyTerminal::Options options =
        inHome({programPath("dfclient"), "--name", "ann", "--known-servers", m_home / "known"}, more);
    options.environment.insert(environment.begin(), environment.end());
    options.environment.emplace("NAIAD_SERVER", "");
    options.columns = 160;
    return std::make_unique<PtyTerminal>(options);
  }
  /// Moves down the list until our server is selected. Each resize redraws the whole list, not only changes.
  bool choose(PtyTerminal& ann) {
    for (int i = 0; i < 300; ++i) {
      ann.forget();
      ann.resize(160, 30 + i % 2);
      ann.read(std::chrono::milliseconds(100));
      if (ann.newOutput().find(key()) != std::string::npos) return true;
      ann.type(i % 20 == 0 ? kHome : kDown);
    }
    return false;
  }
  std::string listOnce(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"--list"};
    words.insert(words.end(), more.begin(), more.end());
    const auto program = client(words);
    EXPECT_EQ(program->waitForExit(), 0) << program->output();
    return program->output();
  }
  /// Runs --list until it shows our server, for at most a minute because queries may be lost.
  std::string listUntilFound(const std::vector<std::string>& more = {}) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    std::string text = listOnce(more);
    while (text.find(m_name) == std::string::npos && std::chrono::steady_clock::now() < end)
      text = listOnce(more);
    return text;
  }

  LanLock m_lock;
  /// The server's name, "test-…": unique, because other tests may list their servers, too.
  const std::string m_name = m_home.path().filename().string().substr(6);
};

TEST_F(LanListTest, EnterJoinsTheChosenServerAndPinsItsKey) {
  serve();
  const auto ann = client();
  ASSERT_TRUE(choose(*ann)) << ann->output();
  ann->type("\r");
  expectPlays(*ann);
  EXPECT_TRUE(sameModes(ann->originalModes(), ann->currentModes()));
  EXPECT_TRUE(fs::exists(m_home / "known"));
}

TEST_F(LanListTest, LeavingTheListRestoresTheTerminal) {
  for (const char* p_key : {"q", "\033", "\003"}) {
    const auto ann = client();
    ASSERT_TRUE(ann->waitFor("Servers in this network")) << ann->output();
    ann->type("r");
    ann->type(p_key);
    expectEnd(*ann, 0, "");
    EXPECT_TRUE(sameModes(ann->originalModes(), ann->currentModes()));
  }
}

TEST_F(LanListTest, PinnedKeyOverridesTheListedKey) {
  serve();
  std::ofstream(m_home / "known") << address() << " " << std::string(64, '0') << "\n";
  const auto ann = client();
  ASSERT_TRUE(choose(*ann)) << ann->output();
  ann->type("\r");
  expectEnd(*ann, 3, "HAS CHANGED");
  m_server->signal(SIGTERM);
  m_server->waitForExit();
  EXPECT_FALSE(has(m_server->output(), "\"ann\""));
}

TEST_F(LanListTest, TextAndJsonNameTheLink) {
  serve();
  EXPECT_TRUE(has(listUntilFound(), m_link));
  const std::string json = listUntilFound({"--json"});
  EXPECT_TRUE(has(json, R"("name": ")" + m_name + R"(", "game": "hello", "players": 0, "max_players": 64)"))
      << json;
  EXPECT_TRUE(has(json, R"("link": ")" + m_link + "\"")) << json;
}

TEST_F(LanListTest, NaiadServerVariableJoinsWithoutListing) {
  serve();
  const auto ann = client({}, {{"NAIAD_SERVER", m_link}});
  expectPlays(*ann);
  EXPECT_FALSE(has(ann->output(), "Servers in this network"));
}

TEST_F(LanListTest, WithoutATerminalAServerIsRequired) {
  PtyTerminal::Options options;
  options.command = {"/bin/sh", "-c", programPath("dfclient") + " </dev/null"};
  options.environment["NAIAD_SERVER"] = "";
  PtyTerminal shell(options);
  expectEnd(shell, 2, "server is required");
}

TEST_F(LanListTest, ContradictoryOptionsAreUsageErrors) {
  expectEnd(*client({"--json"}), 2, "--json requires --list");
  expectEnd(*client({"--list", "127.0.0.1"}), 2, "cannot be used with SERVER");
  expectEnd(*client({"--password", "xyzzy"}), 2, "--ask-password");
  expectEnd(*client({"--insecure"}), 2, "--insecure requires SERVER");
}

/// Answers queries on loopback with arbitrary bytes, as if servers were there.
class FakeLanServer {
 public:
  FakeLanServer() : m_socket(LanSocket::forServer(LanSocket::Family::kIPv4)) {
    for (const LanNetwork& network : lanNetworks()) {
      if (network.is_loopback && network.address.is_v4()) m_network = network;
    }
    m_socket.joinGroup(m_network.interface);
  }
  /// Answers a waiting query. False if no query waits.
  template <class Answers>
  bool answer(Answers answers) {
    const auto packet = m_socket.receivePacket();
    const auto nonce = packet ? readLanQuery(packet->bytes) : std::nullopt;
    if (!nonce) return false;
    for (const std::string& bytes : answers(*nonce)) m_socket.sendAnswer(m_network, packet->source, bytes);
    return true;
  }

 private:
  LanSocket m_socket;
  LanNetwork m_network;
};

LanAnswer fakeAnswer(const LanNonce& nonce, unsigned number, const std::string& name) {
  LanAnswer answer;
  answer.protocol = kProtocolVersion;
  answer.nonce = nonce;
  answer.port = 9;
  answer.max_players = 16;
  ShortKey::Bytes key{};
  key[0] = static_cast<std::uint8_t>(number);
  key[1] = static_cast<std::uint8_t>(number >> 8);
  answer.key = ShortKey::ofBytes(key);
  answer.name = name;
  answer.game = "hello";
  return answer;
}

/// Writes an answer whose name breaks the rules.
std::string rawAnswer(const LanNonce& nonce, unsigned number, const std::string& name) {
  const std::string bytes = writeLanAnswer(fakeAnswer(nonce, number, ""));
  return bytes.substr(0, 48) + static_cast<char>(name.size()) + name + bytes.substr(49);
}

TEST_F(LanListTest, HostileAnswersAreHarmless) {
  FakeLanServer fake;
  const auto ann = client();
  ASSERT_TRUE(ann->waitUntil([&] {
    fake.answer([](const LanNonce& nonce) {
      LanNonce wrong = nonce;
      wrong[15] ^= 1;
      return std::array{writeLanAnswer(fakeAnswer(wrong, 4, "forged")),
                        rawAnswer(nonce, 1, "\033[2Jevil\033]0;OWNED\007"),
                        rawAnswer(nonce, 2,
                                  "\xC2\x9B"
                                  "31m\xff"),
                        writeLanAnswer(fakeAnswer(nonce, 3, "marker"))};
    });
    return has(ann->output(), "marker") && has(ann->output(), "evil");
  })) << ann->output();
  for (const char* hostile : {"\033]0;OWNED", "\033[2Jevil", "\xC2\x9B", "\xff", "forged"})
    EXPECT_FALSE(has(ann->output(), hostile)) << hostile;
  ann->type("q");
  expectEnd(*ann, 0, "");
}

TEST_F(LanListTest, ServerAnnouncingNoPasswordGetsNoEnvironmentPassword) {
  serve("off", "xyzzy");
  FakeLanServer fake;
  const auto ann = client({}, {{"NAIAD_PASSWORD", "xyzzy"}});
  ASSERT_TRUE(ann->waitUntil([&] {
    fake.answer([this](const LanNonce& nonce) {
      LanAnswer answer = fakeAnswer(nonce, 0, m_name);
      answer.key = *ShortKey::parse(key());
      answer.port = static_cast<std::uint16_t>(std::stoi(address().substr(address().find(':') + 1)));
      return std::array{writeLanAnswer(answer)};
    });
    return has(ann->output(), m_name);
  })) << ann->output();
  ASSERT_TRUE(choose(*ann)) << ann->output();
  ann->type("\r");
  ASSERT_TRUE(ann->waitFor("Password of ")) << ann->output();
  ann->type("xyzzy\r");
  expectPlays(*ann);
}

}  // namespace
}  // namespace naiad::test
