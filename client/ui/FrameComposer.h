// Collects the contents of the next frame, and checks whether it differs from the last one.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/session/Connection.h"
#include "client/ui/ClientControls.h"
#include "client/ui/ScreenLayout.h"
#include "client/ui/SoundIndicator.h"

namespace naiad {

/// Decides when the status is shown over the game, on a terminal without space outside the game: for a moment
/// after joining, after a change of the terminal's size, and when the connection has become bad.
class StatusTimer {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kShown{4000};
  /// A round trip from kBad on, which players feel, counts as bad until it is below kGood.
  static constexpr std::chrono::milliseconds kBad{250};
  static constexpr std::chrono::milliseconds kGood{150};

  void show(Time now) { m_until = now + kShown; }
  /// Shows the status for a new player, or when the round trip becomes bad.
  void update(std::uint32_t player, std::chrono::milliseconds round_trip, Time now) {
    if (m_player != player) show(now);
    m_player = player;
    if (!m_bad && round_trip >= kBad) show(now);
    m_bad = round_trip >= (m_bad ? kGood : kBad);
  }
  bool isShown(Time now) const { return now < m_until; }

 private:
  std::optional<std::uint32_t> m_player;
  bool m_bad = false;
  Time m_until{};
};

/// Asks the server to move the player to line `choice` of the room list. Does nothing without a session.
void enterChosenRoom(ClientSession* p_session, int choice);

class FrameComposer {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The arguments must outlive this.
  FrameComposer(Connection& connection, const ClientControls& controls, const SoundIndicator& sounds)
      : m_connection(connection), m_controls(controls), m_sounds(sounds) {}

  /// True if a frame composed now would differ from the last. Does not notice all changes of the controls.
  bool isStale(Time now) { return !(currentState(now) == m_composed); }
  ScreenModel composeFrame(Time now);
  /// Shows a line of the client itself among the chat lines, for as long as a chat line.
  void addNotice(std::string text, Time now) { m_notice = {"", df::COLOR_DEFAULT, std::move(text), now}; }
  /// Sets the line about key releases in the help. `reported`: the terminal reports them.
  void acceptKeyReleases(bool reported) { m_key_releases = reported; }
  /// Call if a browser page shows the frames: it has buttons for the client's commands.
  void setBrowser() { m_browser = true; }
  /// Call when the terminal's size has changed: shows the status for a moment.
  void onResize(Time now) { m_status.show(now); }

 private:
  /// State on which a frame depends.
  struct FrameState {
    std::uint64_t connection = 0;
    std::uint64_t session = 0;
    std::uint32_t tick = 0;
    std::uint32_t predicted = 0;
    std::int64_t silence = 0;  ///< tenths of a second while a banner shows it, else 0
    std::size_t chat_lines = 0;
    std::string note;
    bool status = false;   ///< the status is shown over the game
    bool pointer = false;  ///< a pointer marks the player's own object
    friend bool operator==(const FrameState&, const FrameState&) = default;
  };

  FrameState currentState(Time now);
  std::vector<ChatEntry> recentChat(Time now) const;
  std::string banner(Time now) const;
  void updatePointer(const ClientSession& session, Time now);

  Connection& m_connection;
  const ClientControls& m_controls;
  const SoundIndicator& m_sounds;
  FrameState m_composed;
  ChatEntry m_notice;
  StatusTimer m_status;
  std::optional<std::uint32_t> m_joined_as;
  bool m_pointed = false;
  Time m_point_until{};  ///< time until which the player's own object is pointed at
  bool m_browser = false;
  bool m_key_releases = false;
};

}  // namespace naiad
