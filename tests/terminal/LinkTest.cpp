// The real programs: the link that dfserver prints opens its game, and no other link says anything to
// anybody.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <filesystem>
#include <memory>

#include "PtyTerminal.h"

namespace naiad::test {
namespace {

namespace fs = std::filesystem;

class LinkTest : public testing::Test {
 protected:
  LinkTest() {
    std::string name = fs::temp_directory_path() / "naiad-link-XXXXXX";
    m_home = mkdtemp(name.data());
  }
  ~LinkTest() override {
    m_server.reset();
    fs::remove_all(m_home);
  }

  /// Start a server; return the link that it prints for this machine.
  std::string serve(const std::vector<std::string>& more = {}, const std::string& password = "") {
    PtyTerminal::Options options;
    options.command = {
        programPath("dfserver"), "--game", "hello", "--address", "127.0.0.1", "--port", "0", "--identity",
        m_home / "identity"};
    options.command.insert(options.command.end(), more.begin(), more.end());
    options.environment["NAIAD_PASSWORD"] = password;
    options.columns = 200;
    m_server = std::make_unique<PtyTerminal>(options);
    EXPECT_TRUE(m_server->waitFor("From elsewhere")) << m_server->output();
    const std::string& output = m_server->output();
    const std::string before = "Join from this machine with: dfclient ";
    const std::size_t begin = output.find(before) + before.size();
    return output.substr(begin, output.find_first_of("\r\n", begin) - begin);
  }
  std::unique_ptr<PtyTerminal> client(const std::string& link, const std::vector<std::string>& more = {},
                                      const std::string& ambient = "") {
    PtyTerminal::Options options;
    options.command = {programPath("dfclient"), link, "--name", "ann", "--known-servers", m_home / "known"};
    options.command.insert(options.command.end(), more.begin(), more.end());
    options.environment["XDG_STATE_HOME"] = m_home / "state";
    options.environment["NAIAD_PASSWORD"] = ambient;
    options.columns = 200;
    return std::make_unique<PtyTerminal>(options);
  }
  static void expectEnd(PtyTerminal& program, int code, const std::string& sentence) {
    const int status = program.waitForExit();
    EXPECT_TRUE(WIFEXITED(status)) << program.output();
    EXPECT_EQ(WEXITSTATUS(status), code) << program.output();
    EXPECT_NE(program.output().find(sentence), std::string::npos) << program.output();
  }

  fs::path m_home;
  std::unique_ptr<PtyTerminal> m_server;
};

TEST_F(LinkTest, TheOneThatIsPrintedJoins) {
  const std::string link = serve();
  ASSERT_TRUE(link.starts_with("naiad://127.0.0.1:")) << m_server->output();
  const auto ann = client(link);
  ASSERT_TRUE(m_server->waitFor("\"ann\" joined")) << m_server->output() << ann->output();
  EXPECT_TRUE(fs::exists(m_home / "known"));
  ASSERT_TRUE(ann->waitFor(" player")) << ann->output();
  ann->type("\003");
  expectEnd(*ann, 0, "");
}

TEST_F(LinkTest, AnotherKeyIsRefusedAndTheServerHearsNoName) {
  std::string link = serve();
  char& first = link[link.find('#') + 1];
  first = first == 'a' ? 'b' : 'a';
  const auto ann = client(link);
  expectEnd(*ann, 3, "does not have the key of the link");
  m_server->signal(SIGTERM);
  m_server->waitForExit();
  EXPECT_EQ(m_server->output().find("\"ann\""), std::string::npos) << m_server->output();
}

TEST_F(LinkTest, AMalformedOneIsAUsageError) {
  expectEnd(*client("naiad://127.0.0.1#tooshort"), 2, "the key behind its #");
}

TEST_F(LinkTest, ThePasswordIsAskedForAndTheOneInTheEnvironmentIsNotSent) {
  const std::string link = serve({}, "xyzzy");
  const auto eve = client(link, {}, "xyzzy");
  ASSERT_TRUE(eve->waitFor("Password of 127.0.0.1:")) << eve->output();
  eve->type("\003");
  expectEnd(*eve, 3, "--ask-password");
  const auto ann = client(link, {"--ask-password"});
  ASSERT_TRUE(ann->waitFor("Password of 127.0.0.1:")) << ann->output();
  ann->type("xyzzy\r");
  ASSERT_TRUE(m_server->waitFor("\"ann\" joined")) << m_server->output() << ann->output();
  EXPECT_EQ(ann->output().find("xyzzy"), std::string::npos) << "echoed";
  ASSERT_TRUE(ann->waitFor(" player")) << ann->output();
  ann->type("\003");
  expectEnd(*ann, 0, "");
}

TEST_F(LinkTest, AServerThatWantsAPasswordIsAnsweredAsInSsh) {
  const std::string link = serve({}, "xyzzy");
  const auto ann = client(link);
  ASSERT_TRUE(ann->waitFor("Password of 127.0.0.1:")) << ann->output();
  EXPECT_EQ(ann->currentModes().c_lflag & ECHO, 0u);
  ann->forget();
  ann->type("plugh\r");
  ASSERT_TRUE(ann->waitFor("Wrong password, try again.")) << ann->output();
  ASSERT_TRUE(ann->waitFor("Password of 127.0.0.1:")) << ann->output();
  ann->type("xyzzy\r");
  ASSERT_TRUE(m_server->waitFor("\"ann\" joined")) << m_server->output() << ann->output();
  for (const char* p_typed : {"plugh", "xyzzy"})
    EXPECT_EQ(ann->output().find(p_typed), std::string::npos) << "echoed";
  ASSERT_TRUE(ann->waitFor(" player")) << ann->output();
  ann->type("\003");
  expectEnd(*ann, 0, "");
}

TEST_F(LinkTest, ControlCAtThePasswordRestoresTheTerminal) {
  const auto ann = client("127.0.0.1", {"--ask-password"});
  ASSERT_TRUE(ann->waitFor("Password of ")) << ann->output();
  ann->type("xy\003");
  expectEnd(*ann, 5, "no password was typed");
  EXPECT_TRUE(sameModes(ann->originalModes(), ann->currentModes()));
}

TEST_F(LinkTest, OtherDoorsArePrintedWhereTheyAreNamed) {
  serve({"--ssh-door", "play@game.example:2222", "--web-address", "https://game.example/", "--qr"});
  EXPECT_TRUE(m_server->waitFor("With ssh alone: ssh -p 2222 play@game.example")) << m_server->output();
  EXPECT_TRUE(m_server->waitFor("In a browser: https://game.example/"));
  EXPECT_TRUE(m_server->waitUntil([&] {
    return m_server->output().find("\u2588") != std::string::npos ||
           m_server->output().find("libqrencode") != std::string::npos;
  })) << m_server->output();
}

}  // namespace
}  // namespace naiad::test
