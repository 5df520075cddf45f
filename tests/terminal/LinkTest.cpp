// The real programs: the link printed by dfserver opens its game, and with any other link the client sends
// nothing to any server.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <memory>

#include "HomeFixture.h"

namespace naiad::test {
namespace {

class LinkTest : public HomeFixture {
 protected:
  std::unique_ptr<PtyTerminal> client(const std::string& link, const std::vector<std::string>& more = {},
                                      const std::string& ambient = "") {
    PtyTerminal::Options options =
        inHome({programPath("dfclient"), link, "--name", "ann", "--known-servers", m_home / "known"}, more);
    options.environment["NAIAD_PASSWORD"] = ambient;
    return std::make_unique<PtyTerminal>(options);
  }
};

TEST_F(LinkTest, PrintedLinkJoinsTheGame) {
  serve("hello");
  ASSERT_TRUE(m_link.starts_with("naiad://127.0.0.1:")) << m_server->output();
  expectPlays(*client(m_link));
  EXPECT_TRUE(std::filesystem::exists(m_home / "known"));
}

TEST_F(LinkTest, LinkWithAnotherKeyIsRefusedBeforeTheHello) {
  serve("hello");
  char& first = m_link[m_link.find('#') + 1];
  first = first == 'a' ? 'b' : 'a';
  expectEnd(*client(m_link), 3, "does not have the key in the link");
  m_server->signal(SIGTERM);
  m_server->waitForExit();
  EXPECT_FALSE(has(m_server->output(), "\"ann\""));
}

TEST_F(LinkTest, MalformedLinkIsAUsageError) {
  expectEnd(*client("naiad://127.0.0.1#tooshort"), 2, "the key after the #");
}

TEST_F(LinkTest, PasswordIsPromptedAndEnvironmentPasswordNotSent) {
  serve("hello", {}, "xyzzy");
  const auto eve = client(m_link, {}, "xyzzy");
  ASSERT_TRUE(eve->waitFor("Password of 127.0.0.1:")) << eve->output();
  eve->type("\003");
  expectEnd(*eve, 3, "--ask-password");
  const auto ann = client(m_link, {"--ask-password"});
  ASSERT_TRUE(ann->waitFor("Password of 127.0.0.1:")) << ann->output();
  ann->type("xyzzy\r");
  expectPlays(*ann);
  EXPECT_FALSE(has(ann->output(), "xyzzy")) << "echoed";
}

TEST_F(LinkTest, WrongPasswordIsPromptedAgainWithoutEcho) {
  serve("hello", {}, "xyzzy");
  const auto ann = client(m_link);
  ASSERT_TRUE(ann->waitFor("Password of 127.0.0.1:")) << ann->output();
  EXPECT_EQ(ann->currentModes().c_lflag & ECHO, 0u);
  ann->forget();
  ann->type("plugh\r");
  ASSERT_TRUE(ann->waitFor("Wrong password, try again.")) << ann->output();
  ASSERT_TRUE(ann->waitFor("Password of 127.0.0.1:")) << ann->output();
  ann->type("xyzzy\r");
  expectPlays(*ann);
  for (const char* p_typed : {"plugh", "xyzzy"}) EXPECT_FALSE(has(ann->output(), p_typed)) << "echoed";
}

TEST_F(LinkTest, ControlCAtThePasswordRestoresTheTerminal) {
  const auto ann = client("127.0.0.1", {"--ask-password"});
  ASSERT_TRUE(ann->waitFor("Password of ")) << ann->output();
  ann->type("xy\003");
  expectEnd(*ann, 5, "no password was typed");
  EXPECT_TRUE(sameModes(ann->originalModes(), ann->currentModes()));
}

TEST_F(LinkTest, ConfiguredSshAndWebAddressesArePrinted) {
  serve("hello", {"--ssh-door", "play@game.example:2222", "--web-address", "https://game.example/", "--qr"});
  EXPECT_TRUE(m_server->waitFor(" -p 2222 play@game.example")) << m_server->output();
  EXPECT_TRUE(m_server->waitFor("In a browser: https://game.example/"));
  EXPECT_TRUE(m_server->waitUntil([&] {
    return has(m_server->output(), "\u2588") || has(m_server->output(), "libqrencode");
  })) << m_server->output();
}

}  // namespace
}  // namespace naiad::test
