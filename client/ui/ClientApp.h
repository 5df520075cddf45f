// dfclient: a player's terminal joined to a server.
//
// run() is the client's frame loop: wait for bytes from the player, frames from the server, or the next
// deadline; take them in; draw at most 60 times a second, and only when something changed.
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
#include "client/ui/SoundNotes.h"

namespace naiad {

class Screen;
class TerminalGuard;

class ClientApp {
 public:
  struct Options {
    ServerAddress address;
    SessionOptions session;  ///< the terminal's size is filled in here
    ServerTrust trust;
    TokenStore* p_tokens = nullptr;  ///< for a later client to resume from; null: none
    TerminalType terminal;
    bool ascii = false;
    bool mouse = true;
    bool colors = true;
    SoundMode sound = SoundMode::kNote;
    std::chrono::seconds idle_limit{0};  ///< leave after so long without a key or the mouse; 0: never
  };
  /// How it ended.
  struct Outcome {
    ExitCode code = kExitLeft;
    std::string sentence;  ///< for stderr, once the terminal is restored; may be empty
    int signal = 0;        ///< the signal that ended it, to be raised again; 0: none
    /// The server with this key refused the password, or that there was none.
    std::optional<Fingerprint> wants_password;
  };

  explicit ClientApp(Options options);
  ~ClientApp();

  /// Join, play, restore the terminal. Throws std::runtime_error if there is no terminal to draw on.
  Outcome run();

 private:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;

  void join();
  void takeTerminal();
  Outcome leaveTerminal();
  void sayFarewell();
  Outcome outcome() const;
  void waitForInput();
  void waitForSignal();
  void readInput();
  void takeSignals();
  void takeEvents(const std::vector<TerminalEvent>& events, Time now);
  void takeKey(const KeyEvent& event, Time now);
  /// The terminal reports when a key goes up. Returns false while a text line is open, which needs none of
  /// it.
  bool noteKeyReleases(Time now);
  void noticeSounds(Time now);
  void suspend();
  bool isIdle(Time now) const;
  void noteHangUp();
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
  SoundNotes m_sounds;
  PlayerInput m_player;
  FrameComposer m_composer;

  Time m_next_frame{};  ///< not before
  bool m_dirty = true;
  Time m_heard{};  ///< when the player did something last
  bool m_leaving = false;
  bool m_hung_up = false;  ///< a visitor's line is gone: the session waits for their return
  bool m_was_idle = false;
  int m_signal = 0;
};

}  // namespace naiad
