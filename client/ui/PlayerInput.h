// What the player does with keyboard and mouse, sent to the session that is shown.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "client/session/Connection.h"
#include "client/terminal/HeldKeys.h"
#include "client/terminal/InputDecoder.h"
#include "client/ui/ViewPlacement.h"

namespace naiad {

class PlayerInput {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Between two reported moves of the mouse: more would only fill the server's queue.
  static constexpr std::chrono::milliseconds kMoveInterval{16};

  /// `connection` must outlive it.
  explicit PlayerInput(Connection& connection) : m_connection(connection) {}

  void pressKey(const KeyEvent& event, Time now) { sendKeys(m_held.takeKey(event, now), now); }
  void moveMouse(const MouseEvent& event, const ViewPlacement& placement, Time now);
  /// Release all keys: the game gets no more of them for now.
  void releaseKeys(Time now) { sendKeys(m_held.releaseAll(), now); }
  /// The terminal reports releases from now on, or does not.
  void setRealReleases(bool real, Time now) { sendKeys(m_held.setRealReleases(real), now); }
  /// Send what is due: guessed releases, held keys and buttons once a tick, the newest position of the mouse.
  void update(Time now);
  /// When update() has something to do.
  Time deadline() const;

 private:
  void sendKeys(const std::vector<KeyAction>& actions, Time now);
  void sendHeld(Time now);
  void sendMove(Time now);

  Connection& m_connection;
  HeldKeys m_held;
  df::Mouse::Button m_button = df::Mouse::UNDEFINED_MOUSE_BUTTON;  ///< held down
  CellPosition m_pointer;                                          ///< the mouse, in view cells
  std::optional<CellPosition> m_move;                              ///< not sent yet
  Time m_last_move{};
  Time m_next_key_tick{};
};

}  // namespace naiad
