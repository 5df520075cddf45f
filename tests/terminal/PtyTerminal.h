// A scripted terminal: runs a real program on a pseudo-terminal, types into it and reads what it draws.
//
// It can answer the query of the kitty keyboard protocol, unlike common terminal multiplexers.
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
    std::map<std::string, std::string> environment;  ///< added to the test's own; an empty value unsets one
    int columns = 100;
    int rows = 30;
    bool answer_kitty = false;  ///< answers the query of the kitty keyboard protocol
    bool leads = false;         ///< the program is the session leader, like a login shell
  };

  /// Starts the program. TERM is xterm-256color and the locale C.UTF-8 unless `environment` says otherwise.
  explicit PtyTerminal(const Options& options);
  /// Kills the program if it still runs.
  ~PtyTerminal();
  PtyTerminal(const PtyTerminal&) = delete;
  PtyTerminal& operator=(const PtyTerminal&) = delete;

  /// Types these bytes.
  void type(const std::string& bytes);
  void resize(int columns, int rows);
  /// Sends the program a signal.
  void signal(int number);

  /// Reads until the output contains `text`; false after a minute or when the program has ended.
  bool waitFor(const std::string& text);
  /// Reads until `done` returns true; false after a minute.
  bool waitUntil(const std::function<bool()>& done);
  /// Makes waitFor() look only at output after this call.
  void forget() { m_mark = m_output.size(); }
  /// Reads for this time, whatever comes.
  void read(std::chrono::milliseconds time);
  /// Reads until the program has ended. Returns its wait status; -1 after a minute.
  int waitForExit();

  /// Returns the output since the start, and since the last forget().
  const std::string& output() const { return m_output; }
  std::string newOutput() const { return m_output.substr(m_mark); }
  /// Return the terminal's modes before the program's start, and now.
  const termios& originalModes() const { return m_original; }
  termios currentModes() const;
  pid_t pid() const { return m_pid; }
  /// True once the program has ended.
  bool hasExited();

 private:
  bool hasWritten(const std::string& text) const { return m_output.find(text, m_mark) != std::string::npos; }
  bool readOnce(std::chrono::milliseconds timeout);

  int m_master = -1;
  int m_slave = -1;     ///< kept open so that modes and late output survive the program
  pid_t m_leader = -1;  ///< session leader of the program
  pid_t m_pid = -1;
  int m_report = -1;  ///< the leader reports the program's id and status here
  bool m_answer_kitty;
  bool m_exited = false;
  int m_status = 0;
  termios m_original{};
  std::string m_output;
  std::size_t m_mark = 0;
  std::size_t m_answered = 0;  ///< output already searched for queries
};

/// True if both sets of modes make a terminal behave alike.
bool sameModes(const termios& a, const termios& b);

/// Returns the link for this machine that a dfserver printed.
std::string linkIn(const std::string& output);

/// Returns the path of a built program, or the value of the environment variable with its upper-case name.
std::string programPath(const std::string& name);

}  // namespace naiad::test
