// The real dfclient on a scripted terminal sets terminal modes and restores them.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include "FakeServer.h"
#include "shared/values/Keyboard.h"

namespace naiad::test {
namespace {

class TerminalRestoreTest : public FakeServerFixture {
 protected:
  /// Joins, and waits until the picture is on the screen and the modes are set.
  static void join(PtyTerminal& terminal) {
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
    ASSERT_TRUE(terminal.waitFor("\033[?u")) << terminal.output();
    EXPECT_TRUE(has(terminal.output(), "\033[?1049h"));
    EXPECT_TRUE(has(terminal.output(), "\033[?1003h"));
    EXPECT_FALSE(sameModes(terminal.originalModes(), terminal.currentModes())) << "raw mode is on";
    terminal.forget();
  }

  static void expectRestored(PtyTerminal& terminal) {
    const std::string after = terminal.newOutput();
    // Modes of the alternate screen, mouse reports, bracketed paste, focus reports and key records.
    for (const char* mode : {"1049", "1003", "1006", "2004", "1004", "9001"})
      EXPECT_TRUE(has(after, "\033[?" + std::string(mode) + "l")) << mode;
    EXPECT_TRUE(sameModes(terminal.originalModes(), terminal.currentModes())) << "termios is as before";
  }
};

TEST_F(TerminalRestoreTest, LeavingRestoresTheTerminal) {
  PtyTerminal terminal(options());
  join(terminal);
  terminal.type("\x1d");
  ASSERT_TRUE(terminal.waitFor("q leave"));
  terminal.type("q");
  EXPECT_TRUE(exits(terminal, 0));
  EXPECT_TRUE(server.hasReceived([](const wire::ClientMessage& m) { return m.has_leave(); }));
  expectRestored(terminal);
}

TEST_F(TerminalRestoreTest, ControlCAtAPasswordPromptRestoresTheEcho) {
  PtyTerminal::Options options;
  options.command = {programPath("dfctl"), "password"};
  PtyTerminal terminal(options);
  ASSERT_TRUE(terminal.waitFor("assword")) << terminal.output();
  EXPECT_FALSE(sameModes(terminal.originalModes(), terminal.currentModes()));
  terminal.type("\x03");
  EXPECT_TRUE(WIFEXITED(terminal.waitForExit()));
  EXPECT_TRUE(sameModes(terminal.originalModes(), terminal.currentModes()));
}

TEST_F(TerminalRestoreTest, SignalsAndCrashesRestoreTheTerminal) {
  for (const int number : {SIGTERM, SIGHUP, SIGSEGV, SIGABRT, SIGBUS, SIGQUIT}) {
    PtyTerminal::Options with = options();
    with.answer_kitty = true;
    // Without these options, the sanitizer's own handler would run first.
    with.environment["ASAN_OPTIONS"] = "handle_segv=0:handle_abort=0:handle_sigbus=0";
    PtyTerminal terminal(with);
    join(terminal);
    ASSERT_TRUE(terminal.waitUntil([&] { return terminal.output().find("\033[>31u") != std::string::npos; }))
        << "the keyboard mode is set";
    terminal.signal(number);
    EXPECT_TRUE(diesOf(terminal, number)) << "the parent sees the signal";
    expectRestored(terminal);
    const std::string after = terminal.newOutput();
    EXPECT_LT(after.find("\033[<u"), after.find("\033[?1049l"))
        << "the keyboard mode of the alternate screen";
  }
}

TEST_F(TerminalRestoreTest, GoodbyeRestoresTheTerminal) {
  PtyTerminal terminal(options());
  join(terminal);
  wire::ServerMessage goodbye;
  goodbye.mutable_goodbye()->set_message("Closing time.");
  server.send(goodbye);
  EXPECT_TRUE(exits(terminal, 4));
  expectRestored(terminal);
  const std::string after = terminal.newOutput();
  EXPECT_LT(after.rfind("\033[?1049l"), after.find("Closing time.")) << "said on the normal screen";
}

TEST_F(TerminalRestoreTest, KittyKeysHaveRealReleases) {
  PtyTerminal::Options with = options();
  with.answer_kitty = true;
  PtyTerminal terminal(with);
  ASSERT_TRUE(terminal.waitFor("\033[>31u")) << "pushed after the reply";
  terminal.type("\033[97u");
  EXPECT_TRUE(server.heardKey(df::Keyboard::A, df::KEY_PRESSED));
  EXPECT_TRUE(server.heardKey(df::Keyboard::A, df::KEY_DOWN));
  terminal.type("\033[97;1:3u");
  EXPECT_TRUE(server.heardKey(df::Keyboard::A, df::KEY_RELEASED));
  terminal.type("\033[100u");
  EXPECT_TRUE(server.heardKey(df::Keyboard::D, df::KEY_DOWN));
  terminal.type("\033[O");  // the terminal loses the focus, and does not report the release
  EXPECT_TRUE(server.heardKey(df::Keyboard::D, df::KEY_RELEASED));
  terminal.type("\033[93;5u\033[93;5:3u\033[104u");  // Ctrl-] h
  EXPECT_TRUE(terminal.waitFor("this terminal reports key releases"));
  terminal.type("\033[27u");

  terminal.forget();
  terminal.type("\033[93;5u\033[93;5:3u\033[116u");  // Ctrl-] t
  ASSERT_TRUE(terminal.waitFor("\033[<u")) << "text needs the terminal's own keyboard layout";
  terminal.type("hi\r");
  EXPECT_TRUE(server.hasReceived(
      [](const wire::ClientMessage& m) { return m.has_chat() && m.chat().text() == "hi"; }));
  EXPECT_TRUE(terminal.waitFor("\033[>31u"));
  terminal.type("\033[99;5u");
  EXPECT_TRUE(exits(terminal, 0));
}

TEST_F(TerminalRestoreTest, PlayerChoosesTheMenuKey) {
  PtyTerminal::Options with = options();
  with.environment["NAIAD_MENU_KEY"] = "x";
  PtyTerminal terminal(with);
  join(terminal);
  EXPECT_TRUE(has(terminal.output(), "Ctrl-X help"));
  terminal.type("\x07");
  EXPECT_TRUE(server.heardKey(df::Keyboard::G, df::KEY_PRESSED)) << "Ctrl-G is the game's";
  terminal.type("\x18");
  ASSERT_TRUE(terminal.waitFor("q leave"));
  terminal.type("q");
  EXPECT_TRUE(exits(terminal, 0));
  with.environment["NAIAD_MENU_KEY"] = "c";
  PtyTerminal refused(with);
  EXPECT_EQ(WEXITSTATUS(refused.waitForExit()), 2) << refused.output();
}

// Windows Terminal reports keys as text and in sequences of its own.
TEST_F(TerminalRestoreTest, KeyRecordsHaveRealReleases) {
  PtyTerminal terminal(options());
  ASSERT_TRUE(terminal.waitFor("\033[?9001h"));
  terminal.type("\033[65;30;97;1;0;1_");
  EXPECT_TRUE(server.heardKey(df::Keyboard::A, df::KEY_PRESSED));
  EXPECT_TRUE(server.heardKey(df::Keyboard::A, df::KEY_DOWN));
  terminal.type("\033[65;30;97;0;0;1_");
  EXPECT_TRUE(server.heardKey(df::Keyboard::A, df::KEY_RELEASED));
  terminal.type("\033[221;27;29;1;8;1_\033[221;27;29;0;8;1_\033[72;35;104;1;0;1_");  // Ctrl-] h
  EXPECT_TRUE(terminal.waitFor("this terminal reports key releases"));
  terminal.type("\033[27;1;27;1;0;1_");

  terminal.type(
      "\033[221;27;29;1;8;1_\033[221;27;29;0;8;1_\033[84;20;116;1;0;1_\033[84;20;116;0;0;1_");  // Ctrl-] t
  terminal.type("\033[72;35;104;1;0;1_\033[73;23;105;1;0;1_\033[13;28;13;1;0;1_");
  EXPECT_TRUE(server.hasReceived(
      [](const wire::ClientMessage& m) { return m.has_chat() && m.chat().text() == "hi"; }));
  terminal.type("\033[67;46;3;1;8;1_");  // Ctrl-C
  EXPECT_TRUE(exits(terminal, 0));
  expectRestored(terminal);
}

TEST_F(TerminalRestoreTest, PlainKeysMouseAndResizeReachTheServer) {
  PtyTerminal terminal(options());
  join(terminal);
  terminal.type("\033[C");
  EXPECT_TRUE(server.heardKey(df::Keyboard::RIGHTARROW, df::KEY_PRESSED));
  EXPECT_TRUE(server.heardKey(df::Keyboard::RIGHTARROW, df::KEY_RELEASED));
  // The view begins at (10, 2) in a terminal of 100 x 30 cells; terminals count from 1.
  terminal.type("\033[<0;13;6M\033[<0;13;6m");
  EXPECT_TRUE(server.heardInput([](const Input& input) {
    return input.is_mouse && input.action == df::CLICKED && input.button == 1 && input.x == 2 && input.y == 3;
  }));
  terminal.resize(15, 5);
  EXPECT_TRUE(terminal.waitFor("too small"));
  EXPECT_TRUE(server.hasReceived(
      [](const wire::ClientMessage& m) { return m.has_resize() && m.resize().columns() == 15; }));
  terminal.forget();
  terminal.resize(90, 28);
  EXPECT_TRUE(terminal.waitFor("NAIAD-HERE"));
}

TEST_F(TerminalRestoreTest, ReconnectsToALostServer) {
  PtyTerminal terminal(options());
  join(terminal);
  server.drop();
  EXPECT_TRUE(terminal.waitFor("reconnecting"));
  EXPECT_TRUE(server.hasReceived(
      [hellos = 0](const wire::ClientMessage& m) mutable { return m.has_hello() && ++hellos == 2; }));
  terminal.type("\x03");
  EXPECT_TRUE(exits(terminal, 0));
  expectRestored(terminal);
}

TEST_F(TerminalRestoreTest, UnreachableServerLeavesTheTerminalUntouched) {
  PtyTerminal::Options with = options();
  with.command[1] = "127.0.0.1:1";
  PtyTerminal terminal(with);
  EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 1);
  EXPECT_FALSE(has(terminal.output(), "\033")) << "the terminal was not touched";
}

}  // namespace
}  // namespace naiad::test
