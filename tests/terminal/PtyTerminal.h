// A scripted terminal: runs a real program on a pseudo-terminal, types into it and reads what it draws.
//
// It can answer the kitty keyboard protocol's query, which the usual terminal multiplexers do not.
#pragma once

#include <sys/types.h>
#include <termios.h>

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/support/Text.h"

namespace naiad::test {

class PtyTerminal {
 public:
  struct Options {
    std::vector<std::string> command;                ///< program and arguments
    std::map<std::string, std::string> environment;  ///< set over the test's own; an empty value unsets
    int columns = 100;
    int rows = 30;
    bool answer_kitty = false;  ///< speak the kitty keyboard protocol
    bool leads = false;         ///< the program is the session leader, like a login shell
  };

  /// Starts the program. TERM is xterm-256color and the locale C.UTF-8 unless `environment` says otherwise.
  explicit PtyTerminal(const Options& options);
  /// Kills the program if it still runs.
  ~PtyTerminal();
  PtyTerminal(const PtyTerminal&) = delete;
  PtyTerminal& operator=(const PtyTerminal&) = delete;

  /// Bytes as if typed.
  void type(const std::string& bytes);
  void resize(int columns, int rows);
  /// Send the program a signal.
  void signal(int number);

  /// Read until everything read so far contains `text`; false after a minute or when the program is gone.
  bool waitFor(const std::string& text);
  /// The same, but goes on when the program is gone: another one that it started writes the text.
  bool waitForLater(const std::string& text);
  /// Read until the modes are those before the program began; false after a minute.
  bool waitForOriginalModes();
  /// Read until `done`; false after a minute.
  bool waitUntil(const std::function<bool()>& done);
  /// From now on waitFor() and waitForLater() look at later output only.
  void forget() { m_mark = m_output.size(); }
  /// Read for a while, whatever comes.
  void read(std::chrono::milliseconds time);
  /// Read until the program has ended; its wait status. -1 if it has not within a minute.
  int waitForExit();

  /// Everything the program wrote since the start, and since the last forget().
  const std::string& output() const { return m_output; }
  std::string newOutput() const { return m_output.substr(m_mark); }
  /// The terminal's modes before the program began and now.
  const termios& originalModes() const { return m_original; }
  termios currentModes() const;
  pid_t pid() const { return m_pid; }
  /// Returns true once the program has ended.
  bool hasExited();

 private:
  bool hasWritten(const std::string& text) const { return m_output.find(text, m_mark) != std::string::npos; }
  bool readOnce(std::chrono::milliseconds timeout);

  int m_master = -1;
  int m_slave = -1;     ///< kept open, so that modes and late output survive the program
  pid_t m_leader = -1;  ///< of the program's session
  pid_t m_pid = -1;
  int m_report = -1;  ///< of the leader: the program's wait status
  bool m_answer_kitty;
  bool m_exited = false;
  int m_status = 0;
  termios m_original{};
  std::string m_output;
  std::size_t m_mark = 0;
  std::size_t m_answered = 0;  ///< output searched for queries
};

/// Do two sets of modes make a terminal behave alike?
bool sameModes(const termios& a, const termios& b);

/// The link for this machine in what a dfserver prints.
std::string linkIn(const std::string& output);

/// Path of a built program: the environment variable named like the program in upper case, else the build.
std::string programPath(const std::string& name);

}  // namespace naiad::test
