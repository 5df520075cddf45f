// Sends the player's keyboard and mouse input to the session that is shown.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "client/session/Connection.h"
#include "client/terminal/InputDecoder.h"
#include "client/terminal/KeyHoldTracker.h"
#include "client/ui/ViewPlacement.h"

namespace naiad {

class PlayerInput {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Minimum interval between reported mouse moves, because more would only fill the server's queue.
  static constexpr std::chrono::milliseconds kMoveInterval{16};

  /// `connection` must outlive this.
  explicit PlayerInput(Connection& connection) : m_connection(connection) {}

  void pressKey(const KeyEvent& event, Time now) { sendKeys(m_held.handleKey(event, now), now); }
  void moveMouse(const MouseEvent& event, const ViewPlacement& placement, Time now);
  /// Releases all keys, e.g. before a chat line gets the keys.
  void releaseKeys(Time now) { sendKeys(m_held.releaseAll(), now); }
  /// Call when the terminal starts or stops reporting key releases.
  void setRealReleases(bool real, Time now) { sendKeys(m_held.setRealReleases(real), now); }
  /// Sends due inputs: guessed releases, held keys and buttons once a tick, the newest position of the mouse.
  void update(Time now);
  /// Returns when update() will next have something to do.
  Time deadline() const;

 private:
  void sendKeys(const std::vector<KeyAction>& actions, Time now);
  void sendHeld(Time now);
  void sendMove(Time now);

  Connection& m_connection;
  KeyHoldTracker m_held;
  df::Mouse::Button m_button = df::Mouse::UNDEFINED_MOUSE_BUTTON;  ///< the button held down
  CellPosition m_pointer;                                          ///< the mouse, in view cells
  std::optional<CellPosition> m_move;                              ///< newest position, if not sent yet
  Time m_last_move{};
  Time m_next_key_tick{};
};

}  // namespace naiad
