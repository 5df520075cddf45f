// Main loop of dfclient: connects a player's terminal with a server.
//
// run() waits for bytes from the player, frames from the server, signals, or the next deadline, and handles
// them. It draws at most once in 16 ms, and only when something changed.
#pragma once

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/posix/stream_descriptor.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/session/Connection.h"
#include "client/session/TrustOptions.h"
#include "client/terminal/InputDecoder.h"
#include "client/terminal/TerminalType.h"
#include "client/ui/ClientControls.h"
#include "client/ui/FrameComposer.h"
#include "client/ui/PlayerInput.h"
#include "client/ui/SoundIndicator.h"

namespace naiad {

class Screen;
class TerminalGuard;

class ClientApp {
 public:
  struct Options {
    ServerAddress address;
    SessionOptions session;  ///< ClientApp itself sets the terminal's size in it
    ServerTrust trust;
    TokenStore* p_tokens = nullptr;  ///< store of the session's token; null: no resuming
    TerminalType terminal;
    bool ascii = false;
    bool mouse = true;
    bool colors = true;
    char menu_letter = 'G';  ///< ClientControls::menuLetter()
    SoundMode sound = SoundMode::kNote;
    std::chrono::seconds idle_limit{0};  ///< leave after this time without input; 0: never
  };
  struct Outcome {
    ExitCode code = kExitLeft;
    std::string message;  ///< message for stderr after the terminal is restored; may be empty
    int signal = 0;       ///< the signal that ended the client, to be raised again; 0: none
    /// Set if the server with this key refused because the password was missing or wrong.
    std::optional<Fingerprint> password_required_by;
  };

  explicit ClientApp(Options options);
  ~ClientApp();

  /// Joins, plays and restores the terminal. Throws std::runtime_error if there is no terminal to draw on.
  Outcome run();

 private:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  void join();
  void acquireTerminal();
  Outcome releaseTerminal();
  void leaveAndFlush();
  Outcome outcome() const;
  void waitForInput();
  void waitForSignal();
  void readInput();
  void handleSignals();
  void handleEvents(const std::vector<TerminalEvent>& events, Time now);
  void handleKey(const KeyEvent& event, Time now);
  /// Call when the terminal reports key releases. Returns false and ignores them while a chat line is open.
  bool acceptKeyReleases(Time now);
  void handleSounds(Time now);
  void suspend();
  bool isIdle(Time now) const;
  void onHangUp();
  void resume();
  void drawFrame(Time now);
  Time nextDeadline(Time now);

  Options m_options;
  asio::io_context m_context{1};
  asio::executor_work_guard<asio::io_context::executor_type> m_work{m_context.get_executor()};
  Connection m_connection;
  std::unique_ptr<TerminalGuard> m_guard;
  std::unique_ptr<Screen> m_screen;
  asio::posix::stream_descriptor m_input{m_context};
  asio::posix::stream_descriptor m_signals{m_context};
  InputDecoder m_decoder;
  ClientControls m_controls;
  ViewPlacement m_placement;
  SoundIndicator m_sounds;
  PlayerInput m_player;
  FrameComposer m_composer;

  Time m_next_frame{};  ///< earliest time of the next frame
  bool m_dirty = true;
  Time m_last_input{};  ///< time of the player's last input
  bool m_leaving = false;
  bool m_hung_up = false;  ///< a visitor's terminal is gone; their session is kept
  bool m_was_idle = false;
  int m_signal = 0;
};

}  // namespace naiad
