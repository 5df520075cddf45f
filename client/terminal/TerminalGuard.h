// Takes the terminal for the client and restores it on every exit but SIGKILL.
//
// Taking: raw mode (termios), mouse reports, bracketed paste and Windows Terminal's key records (escape
// sequences written by hand), the kitty keyboard protocol once the terminal has said that it supports it.
// Screen, made after the guard and destroyed before, owns the alternate screen; for crashes the guard can
// leave that too.
//
// Restoring: restore() in order, also called by the destructor and at exit(). SIGSEGV, SIGBUS, SIGABRT,
// SIGFPE and SIGILL write a prebuilt byte string and call tcsetattr, both async-signal-safe, then die of
// the signal. All other signals come out of signalFd() as bytes for the event loop; a second SIGTERM,
// SIGHUP or SIGINT, before the loop acted on the first, restores and kills immediately. One that the loop has
// not read when the guard is destroyed ends the process then.
//
// One guard at a time: signal handlers need a static place for what they restore. Signals may come to any
// thread; the one that made the guard, and draws, handles them.
#pragma once

#include <functional>

namespace naiad {

class TerminalGuard {
 public:
  struct Options {
    bool mouse = true;
  };

  /// Takes the terminal on fds 0 and 1. Throws std::runtime_error if they are none.
  explicit TerminalGuard(Options options);
  ~TerminalGuard();
  TerminalGuard(const TerminalGuard&) = delete;
  TerminalGuard& operator=(const TerminalGuard&) = delete;

  /// Are both standard input and output a terminal?
  static bool isTerminal();

  /// Install the signal handlers again, after a library may have put in its own.
  void installHandlers();
  /// Write the sequences that switch reports on and ask for the kitty protocol. Call when the alternate
  /// screen is on, which has its own keyboard modes.
  void enterModes();
  /// Switch all reports off again, the alternate screen still on.
  void leaveModes();
  /// Raw mode on; original mode on.
  void setRaw();
  void setOriginal();

  /// Have keys reported with their releases (kitty flags 1+2+4+8+16), or as text again.
  void pushKitty();
  void popKitty();
  /// Ask again whether the terminal supports the protocol.
  void queryKitty();
  bool kittyPushed() const;

  /// Stops this process like Ctrl-Z, and returns true when it is in the foreground again. Restore the
  /// terminal first. Returns false if the process must end, because a signal asks it to or its shell has
  /// ended; the terminal may then belong to another program.
  [[nodiscard]] bool stopProcess();
  /// Readable when a signal came: one byte per signal, its number.
  int signalFd() const;
  /// What a normal restore() does between leaving the modes and restoring termios: end the screen.
  void onRestore(std::function<void()> end_screen) { m_end_screen = std::move(end_screen); }
  /// Restore the terminal; does nothing the second time.
  void restore();

  /// Write all of `size` bytes to the terminal. Gives up when it is gone.
  static void write(const char* bytes, unsigned long size);

 private:
  Options m_options;
  std::function<void()> m_end_screen;
};

}  // namespace naiad
