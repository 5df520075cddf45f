// Redirected clients: they join the other server, but a malicious server cannot make them reveal or lose
// anything.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "client/session/TcpStreamOpener.h"
#include "client/trust/KnownServers.h"
#include "host/auth/PasswordHash.h"
#include "host/auth/ServerIdentity.h"
#include "naiad.pb.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/lan/LanNetworks.h"
#include "shared/net/stream/TcpListener.h"
#include "tests/loopback/GameProgram.h"
#include "tests/loopback/LoopbackFixture.h"
#include "tests/loopback/RecordingServer.h"

namespace naiad::test {
namespace {

using State = Connection::State;

/// A server with its own key that answers each hello with a refusal that the test chooses. Runs in the test's
/// event loop.
class LyingServer {
 public:
  LyingServer(asio::io_context& context, const std::filesystem::path& identity,
              const std::string& address = "127.0.0.1")
      : m_identity(ServerIdentity::loadOrMake(identity, std::chrono::system_clock::now())),
        m_listener(context, address, 0,
                   [this](std::unique_ptr<ReliableChannel> channel) { meet(std::move(channel)); }, {},
                   {.context = m_identity.tls()}) {}

  void answer(wire::Refused_Reason reason, const std::string& sentence, const std::string& redirect,
              const std::string& room = "") {
    m_answer.mutable_refused()->set_reason(reason);
    m_answer.mutable_refused()->set_message(sentence);
    m_answer.mutable_refused()->set_redirect(redirect);
    m_answer.mutable_refused()->set_redirect_room(room);
  }
  /// Redirects players to this port of 127.0.0.1, and claims that the server there has this key.
  void sendTo(std::uint16_t port, const Fingerprint& key, const std::string& room = "") {
    answer(wire::Refused::REDIRECT, "Go on.", linkTo("127.0.0.1", port, key), room);
  }
  static std::string linkTo(const std::string& host, std::uint16_t port, const Fingerprint& key) {
    return "naiad://" + host + ":" + std::to_string(port) + "#" + ShortKey::of(key).text();
  }

  std::uint16_t port() const { return m_listener.port(); }
  const Fingerprint& key() const { return m_identity.fingerprint(); }
  std::size_t hellos() const { return m_hellos.size(); }
  const wire::Hello& hello() const { return m_hellos.back(); }

 private:
  void meet(std::unique_ptr<ReliableChannel> channel) {
    ReliableChannel& one = *channel;
    m_channels.push_back(std::move(channel));
    one.start({[this, &one](std::string_view frame) {
                 wire::ClientMessage message;
                 if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) return;
                 m_hellos.push_back(message.hello());
                 one.send(m_answer.SerializeAsString());
                 one.close();
               },
               [](CloseReason) {}});
  }

  ServerIdentity m_identity;
  wire::ServerMessage m_answer;
  std::vector<wire::Hello> m_hellos;
  std::vector<std::unique_ptr<ReliableChannel>> m_channels;
  TcpListener m_listener;
};

class RedirectTest : public LoopbackFixture {
 protected:
  using LoopbackFixture::refusal;
  std::string refusal(const ClientSetup& setup) {
    TestClient client(context, liar.port(), setup);
    return refusal(client);
  }
  std::string pins() const { return readSmallFile(home.knownServers(), 10'000).value_or(""); }
  void pin(std::uint16_t port, const Fingerprint& key) const {
    const PeerIdentity facts{.key = key, .chain_verifies = false, .chain_problem = {}};
    KnownServers(home.knownServers()).admit("127.0.0.1", port, facts, key);
  }

  LyingServer liar{context, home.identity("liar")};
};

TEST_F(RedirectTest, RedirectedClientJoinsTheOtherServer) {
  TestServer server(busyWorld(5), home.server());
  liar.sendTo(server.port(), *server.fingerprint());
  TestClient client(context, liar.port(), home.player("ann"));
  EXPECT_EQ(refusal(client), "");
  EXPECT_TRUE(client.connection().isRedirected());
  EXPECT_EQ(client.connection().address().port, server.port());
  EXPECT_EQ(client.session().welcome().name, "ann");
  EXPECT_TRUE(serve(client, [&] { return client.session().hasDatagrams(std::chrono::steady_clock::now()); }))
      << "datagrams, too";
}

TEST_F(RedirectTest, RedirectDelaysTheJoinByUpToASecond) {
  EXPECT_EQ(ServerTrust().max_redirect_wait, std::chrono::seconds(1));
  ClientSetup setup = home.player("ann");
  setup.trust.max_redirect_wait = std::chrono::hours(1);
  liar.sendTo(liar.port(), liar.key());
  TestClient client(context, liar.port(), setup);
  ASSERT_TRUE(serve(client, [&] { return client.connection().isRedirected(); }));
  EXPECT_EQ(client.connection().state(), State::kJoining);
  EXPECT_EQ(liar.hellos(), 1u) << "it waits";
}

TEST_F(RedirectTest, RedirectReplacesTheRequestedRoom) {
  LyingServer second(context, home.identity("second"));
  second.answer(wire::Refused::GAME, "No.", "");
  ClientSetup setup = home.player("ann");
  setup.options.room = "cellar";
  liar.sendTo(second.port(), second.key(), "duel");
  EXPECT_EQ(refusal(setup), "No.");
  EXPECT_EQ(liar.hello().room(), "cellar");
  EXPECT_EQ(second.hello().room(), "duel");
  for (const std::string& none : {std::string(), std::string("a/b"), std::string("-x"), std::string(33, 'a'),
                                  std::string("a b"), std::string("\033[2J")}) {
    liar.sendTo(second.port(), second.key(), none);
    EXPECT_EQ(refusal(setup), "No.");
    EXPECT_EQ(second.hello().room(), "") << none;
  }
}

TEST_F(RedirectTest, RedirectTargetGetsNeitherPasswordNorResumeToken) {
  RecordingServer thief(home.identity("thief"));
  liar.sendTo(thief.port(), thief.fingerprint());
  ClientSetup setup = home.player("ann");
  setup.options.password = "xyzzy-secret";
  setup.options.resume_token = "a-token-of-old";
  setup.sessions = home.sessions();
  TestClient client(context, liar.port(), setup);
  ASSERT_TRUE(serve(client, [&] { return !thief.heard().empty(); }));
  EXPECT_EQ(liar.hello().password(), "xyzzy-secret") << "it was meant for this one";
  const std::string heard = thief.heard();
  EXPECT_NE(heard.find("ann"), std::string::npos);
  EXPECT_EQ(heard.find("xyzzy"), std::string::npos);
  EXPECT_EQ(heard.find("token"), std::string::npos);
}

TEST_F(RedirectTest, SavedTokenOfTheRedirectTargetIsNotSent) {
  TestServer server(busyWorld(5), home.server());
  ClientSetup setup = home.player("ann");
  setup.sessions = home.sessions();
  {
    TestClient before(context, server.port(), setup);
    ASSERT_EQ(refusal(before), "");
  }
  liar.sendTo(server.port(), *server.fingerprint());
  TestClient client(context, liar.port(), setup);
  ASSERT_EQ(refusal(client), "");
  EXPECT_EQ(client.session().welcome().name, "ann2") << "another player than the one who was killed";
  EXPECT_EQ(server.counters().resumed, 0u);
}

TEST_F(RedirectTest, RedirectTargetWithAWrongKeyReceivesNothing) {
  RecordingServer other(home.identity("other"));
  liar.sendTo(other.port(), liar.key());
  TestClient client(context, liar.port(), home.player("ann"));
  EXPECT_NE(refusal(client).find("link"), std::string::npos) << client.connection().message();
  EXPECT_EQ(client.connection().state(), State::kRefused);
  EXPECT_EQ(other.heard(), "");
}

TEST_F(RedirectTest, APinnedKeyIsNotReplaced) {
  RecordingServer impostor(home.identity("impostor"));
  pin(impostor.port(), liar.key());
  const std::string before = pins();
  liar.sendTo(impostor.port(), impostor.fingerprint());
  TestClient client(context, liar.port(), home.player("ann"));
  EXPECT_NE(refusal(client), "");
  EXPECT_EQ(impostor.heard(), "");
  EXPECT_NE(before.find(std::to_string(impostor.port())), std::string::npos);
  EXPECT_NE(pins().find(before.substr(0, before.find('\n'))), std::string::npos);
  EXPECT_EQ(pins().find(impostor.fingerprint().text()), std::string::npos);
}

TEST_F(RedirectTest, RedirectTargetIsNotPinned) {
  TestServer server(busyWorld(5), home.server());
  liar.sendTo(server.port(), *server.fingerprint());
  ASSERT_EQ(refusal(home.player("ann")), "");
  EXPECT_EQ(pins().find(server.fingerprint()->text()), std::string::npos) << "a stranger has named the key";
  EXPECT_NE(pins().find(liar.key().text()), std::string::npos);
}

TEST_F(RedirectTest, ClientRetriesTheOriginalServerIfTargetIsFull) {
  LyingServer full(context, home.identity("full"));
  full.answer(wire::Refused::FULL, "Full.", "");
  TestServer server(busyWorld(5), home.server());
  liar.sendTo(full.port(), full.key());
  ClientSetup setup = home.player("ann");
  setup.options.password = "xyzzy-secret";
  TestClient client(context, liar.port(), setup);
  ASSERT_TRUE(serve(client, [&] { return full.hellos() == 1; }));
  liar.sendTo(server.port(), *server.fingerprint());
  EXPECT_EQ(refusal(client), "");
  EXPECT_EQ(liar.hellos(), 2u);
  EXPECT_EQ(liar.hello().password(), "xyzzy-secret") << "as of any join there";
  EXPECT_EQ(full.hello().password(), "");
  EXPECT_TRUE(client.connection().isRedirected());
  EXPECT_EQ(client.connection().address().port, server.port());
}

TEST_F(RedirectTest, OriginalServerIsRetriedOnlyOnce) {
  LyingServer full(context, home.identity("full"));
  RecordingServer third(home.identity("third"));
  full.answer(wire::Refused::FULL, "Full.",
              LyingServer::linkTo("127.0.0.1", third.port(), third.fingerprint()));
  liar.sendTo(full.port(), full.key());
  EXPECT_EQ(refusal(home.player("ann")), "Full.");
  EXPECT_EQ(liar.hellos(), 2u);
  EXPECT_EQ(full.hellos(), 2u);
  EXPECT_EQ(third.heard(), "") << "that a server names to which the client was sent";
}

TEST_F(RedirectTest, ClientRetriesTheOriginalServerAfterTargetIsKilled) {
  GameProgram killed("dfserver", {{"NAIAD_GAME", "hello"}, {"NAIAD_IDENTITY", home.identity("killed")}});
  ASSERT_NE(killed.port(), 0) << killed.log();
  const auto key =
      ServerIdentity::loadOrMake(home.identity("killed"), std::chrono::system_clock::now()).fingerprint();
  TestServer server(busyWorld(5), home.server());
  liar.sendTo(killed.port(), key);
  TestClient client(context, liar.port(), home.player("ann"));
  client.connection().setOriginalRetryDelay(std::chrono::milliseconds(100));
  ASSERT_EQ(refusal(client), "");
  const std::uint16_t before = client.connection().address().port;
  liar.sendTo(server.port(), *server.fingerprint());
  killed.end(SIGKILL);
  EXPECT_TRUE(serve(client, [&] {
    return client.joined() && client.connection().address().port == server.port();
  })) << client.connection().message();
  EXPECT_EQ(before, killed.port());
  EXPECT_EQ(client.session().welcome().name, "ann");
}

TEST_F(RedirectTest, SecondRedirectIsNotFollowed) {
  LyingServer second(context, home.identity("second"));
  RecordingServer third(home.identity("third"));
  liar.sendTo(second.port(), second.key());
  second.sendTo(third.port(), third.fingerprint());
  TestClient client(context, liar.port(), home.player("ann"));
  EXPECT_EQ(refusal(client), "Go on.");
  EXPECT_EQ(second.hellos(), 1u);
  EXPECT_EQ(third.heard(), "");
}

TEST_F(RedirectTest, SelfRedirectIsFollowedOnce) {
  liar.sendTo(liar.port(), liar.key());
  EXPECT_EQ(refusal(home.player("ann")), "Go on.");
  EXPECT_EQ(liar.hellos(), 2u);
}

TEST_F(RedirectTest, NoRedirectOptionAndDoorsIgnoreRedirects) {
  RecordingServer other(home.identity("other"));
  liar.sendTo(other.port(), other.fingerprint());
  ClientSetup stays = home.player("ann");
  stays.trust.ignore_redirects = true;
  EXPECT_EQ(refusal(stays), "Go on.");
  TcpStreamOpener visitor(context, ServerAddress{"127.0.0.1", liar.port()}, {}, ProxyOptions{"socket", {}});
  const std::string link = LyingServer::linkTo("127.0.0.1", other.port(), other.fingerprint());
  EXPECT_EQ(visitor.follow(link).opener, nullptr) << "through a door";
  EXPECT_EQ(other.heard(), "");
}

TEST_F(RedirectTest, InvalidRedirectLinksAreNotFollowed) {
  RecordingServer other(home.identity("other"));
  const std::string key = ShortKey::of(other.fingerprint()).text();
  const std::string port = std::to_string(other.port());
  const std::string cases[] = {"naiad://127.0.0.1:80#" + key,
                               "naiad://127.0.0.1:" + port,
                               "naiad://127.0.0.1:" + port + "#" + key.substr(1),
                               "naiad://127.0.0.1:" + port + "/room#" + key,
                               "naiad://ann@127.0.0.1:" + port + "#" + key,
                               "naiad://-oProxyCommand=x:" + port + "#" + key,
                               "http://127.0.0.1:" + port + "#" + key,
                               std::string(10'000, 'x')};
  for (const std::string& link : cases) {
    liar.answer(wire::Refused::REDIRECT, "Go on.", link);
    EXPECT_EQ(refusal(home.player("ann")), "Go on.") << link;
  }
  EXPECT_EQ(other.heard(), "");
}

TEST_F(RedirectTest, RefusalsForOtherReasonsDoNotRedirect) {
  RecordingServer other(home.identity("other"));
  const std::string link = LyingServer::linkTo("127.0.0.1", other.port(), other.fingerprint());
  for (const auto reason : {wire::Refused::PASSWORD, wire::Refused::VERSION, wire::Refused::GAME}) {
    liar.answer(reason, "No.", link);
    EXPECT_EQ(refusal(home.player("ann")), "No.");
  }
  EXPECT_EQ(other.heard(), "");
}

TEST_F(RedirectTest, ClientDoesNotAskForTheTargetsPassword) {
  HostOptions options = home.server();
  options.password = PasswordHash::of("xyzzy", {.memory_kib = 64, .passes = 1}).text();
  TestServer server(busyWorld(5), options);
  liar.sendTo(server.port(), *server.fingerprint());
  TestClient client(context, liar.port(), home.player("ann"));
  EXPECT_EQ(refusal(client), "This server requires a password.");
  EXPECT_FALSE(client.connection().isPasswordRefused()) << "it would be typed for the server that was named";
}

TEST_F(RedirectTest, LanServerCannotRedirectToTheClientsLoopback) {
  std::string address;
  for (const LanNetwork& network : lanNetworks()) {
    if (!network.is_loopback && network.address.is_v4()) address = network.address.to_string();
  }
  if (address.empty()) GTEST_SKIP() << "this machine is in no network";
  RecordingServer local(home.identity("local"));
  LyingServer neighbour(context, home.identity("neighbour"), address);
  neighbour.sendTo(local.port(), local.fingerprint());
  const ClientSetup setup = home.player("ann");
  Connection client(context, ServerAddress{address, neighbour.port()}, setup.options, true, setup.trust);
  client.setOriginalRetryDelay(std::chrono::milliseconds(100));
  client.start();
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!client.isOver() && std::chrono::steady_clock::now() < end) {
    context.restart();
    context.run_one_for(std::chrono::milliseconds(5));
    client.update(std::chrono::steady_clock::now());
  }
  EXPECT_EQ(neighbour.hellos(), 2u) << "asked for another once";
  EXPECT_NE(client.message().find("more private network"), std::string::npos) << client.message();
  EXPECT_EQ(local.heard(), "");
}

}  // namespace
}  // namespace naiad::test
