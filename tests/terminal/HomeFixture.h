// Fixture that keeps the files of the real programs in a temporary folder: a dfserver and its clients.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "ProgramEnd.h"
#include "PtyTerminal.h"
#include "tests/support/TempFolder.h"

namespace naiad::test {

class HomeFixture : public testing::Test {
 protected:
  /// Returns options for a program whose configuration, data and state are in the folder.
  PtyTerminal::Options inHome(std::vector<std::string> command,
                              const std::vector<std::string>& more = {}) const {
    PtyTerminal::Options options;
    for (const char* kind : {"CONFIG", "DATA", "STATE"})
      options.environment["XDG_" + std::string(kind) + "_HOME"] = m_home / kind;
    options.command = std::move(command);
    options.command.insert(options.command.end(), more.begin(), more.end());
    options.columns = 200;
    return options;
  }
  /// Starts a server for this machine only. Sets `m_link` to the link that it prints.
  void serve(const std::string& game, const std::vector<std::string>& more = {},
             const std::string& password = "") {
    PtyTerminal::Options options =
        inHome({programPath("dfserver"), "--game", game, "--address", "127.0.0.1", "--port", "0"}, more);
    options.environment["NAIAD_PASSWORD"] = password;
    m_server = std::make_unique<PtyTerminal>(options);
    ASSERT_TRUE(m_server->waitFor("Only this machine can join")) << m_server->output();
    m_link = linkIn(m_server->output());
  }
  /// Checks that ann joins, plays and leaves.
  void expectPlays(PtyTerminal& ann) {
    ASSERT_TRUE(m_server->waitFor("\"ann\" joined")) << m_server->output() << ann.output();
    ASSERT_TRUE(ann.waitFor(" player")) << ann.output();
    ann.type("\003");
    expectEnd(ann, 0, "");
  }
  static void expectEnd(PtyTerminal& program, int code, const std::string& sentence) {
    EXPECT_TRUE(exits(program, code));
    EXPECT_TRUE(has(program.output(), sentence));
  }

  TempFolder m_home;
  std::string m_link;
  std::unique_ptr<PtyTerminal> m_server;
};

}  // namespace naiad::test
