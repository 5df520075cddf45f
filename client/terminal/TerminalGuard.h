// Sets the terminal's modes for the client, and restores the terminal on every exit but _exit() and those by
// signals that are not listed here, such as SIGKILL.
//
// It sets raw mode (termios), mouse and focus reports, bracketed paste and Windows Terminal's key records
// (hand-written escape sequences), and the kitty keyboard protocol once the terminal reports its support.
// Screen, made after the guard and destroyed before it, owns the alternate screen; at a crash the guard
// leaves it, too.
//
// restore() restores all this; the destructor calls it. exit() and the handlers of SIGSEGV, SIGBUS, SIGABRT,
// SIGFPE, SIGILL and SIGQUIT write prebuilt byte strings and call tcsetattr, both async-signal-safe; the
// process then dies of the signal. SIGTERM, SIGHUP, SIGINT, SIGWINCH, SIGTSTP and SIGCONT become bytes from
// signalFd() for the event loop. A second one of the first three restores the terminal and kills the process.
// If the event loop has not read one of these when the guard is destroyed, the process ends by it.
//
// Only one guard may exist at a time, because signal handlers need static data. Signals may arrive in any
// thread; the thread that made the guard, and draws, handles them.
#pragma once

#include <functional>

namespace naiad {

class TerminalGuard {
 public:
  struct Options {
    bool mouse = true;
  };

  /// Sets raw mode for the terminal on fds 0 and 1, and installs the signal handlers. Throws
  /// std::runtime_error if fd 0 is not a terminal, or no pipe for the signals can be created.
  explicit TerminalGuard(Options options);
  ~TerminalGuard();
  TerminalGuard(const TerminalGuard&) = delete;
  TerminalGuard& operator=(const TerminalGuard&) = delete;

  /// True if both standard input and output are a terminal.
  static bool isTerminal();

  /// Installs the signal handlers again, because a library may have installed its own.
  void installHandlers();
  /// Switches reports on and asks whether the terminal supports the kitty protocol. Call when the alternate
  /// screen is on, because it has keyboard modes of its own.
  void enterModes();
  /// Switches all reports off again. Call while the alternate screen is on.
  void leaveModes();
  void setRawMode();
  void setOriginalMode();

  /// Switches key reports with releases (kitty flags 1+2+4+8+16) on or off.
  void pushKitty();
  void popKitty();
  /// Asks again whether the terminal supports the kitty protocol.
  void queryKitty();

  /// Stops this process like Ctrl-Z, and returns true when it is in the foreground again. Restore the
  /// terminal first. Returns false if the process must end, because a signal asks it to or its shell has
  /// ended; the terminal may then belong to another program.
  [[nodiscard]] bool stopProcess();
  /// Returns a descriptor from which one byte can be read for each signal that arrived: the signal's number.
  int signalFd() const;
  /// Sets the function that ends the screen; restore() calls it between leaveModes() and setOriginalMode().
  void onRestore(std::function<void()> end_screen) { m_end_screen = std::move(end_screen); }
  /// Restores the terminal; does nothing the second time.
  void restore();

  /// Writes to the terminal. Gives up if it is gone or, if fd 1 does not block, accepts no byte for a second.
  static void write(const char* bytes, unsigned long size);

 private:
  Options m_options;
  std::function<void()> m_end_screen;
};

}  // namespace naiad
