// What the next frame shows, and whether it differs from the last one.
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
#include "client/ui/SoundNotes.h"

namespace naiad {

/// When the status is shown over the game, on a terminal that has no room beside it: for a moment after
/// joining, and when the line has become bad.
class StatusTimer {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kShown{4000};
  /// A round trip that players feel; it is good again only well below.
  static constexpr std::chrono::milliseconds kBad{250};
  static constexpr std::chrono::milliseconds kGood{150};

  /// For a moment from now on.
  void show(Time now) { m_until = now + kShown; }
  /// The line of a player of this id is so long.
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

/// Ask to go on in the room of that line of the list that the session has (ClientControls::roomChoice()).
void enterChosenRoom(ClientSession* p_session, int choice);

class FrameComposer {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// All must outlive it.
  FrameComposer(Connection& connection, const ClientControls& controls, const SoundNotes& sounds)
      : m_connection(connection), m_controls(controls), m_sounds(sounds) {}

  /// Would a frame composed now differ from the last one? Changes of the controls are not considered.
  bool isStale(Time now) { return !(currentState(now) == m_composed); }
  ScreenModel composeFrame(Time now);
  /// Show a line of the client itself among those of the chat, as long as these.
  void addNotice(std::string text, Time now) { m_notice = {"", df::COLOR_DEFAULT, std::move(text), now}; }
  /// Does the terminal report when a key goes up? The help says so.
  void noteKeyReleases(bool reported) { m_key_releases = reported; }
  /// A page of a browser shows it: it has buttons for the client's commands.
  void noteBrowser() { m_browser = true; }
  /// The terminal has another size: show the status for a moment.
  void noteResize(Time now) { m_status.show(now); }

 private:
  /// What a frame depends on.
  struct FrameState {
    std::uint64_t connection = 0;
    std::uint64_t session = 0;
    std::uint32_t tick = 0;
    std::uint32_t predicted = 0;
    std::int64_t silence = 0;  ///< in tenths of a second, once it is shown
    std::size_t chat_lines = 0;
    std::string note;
    bool status = false;   ///< over the game
    bool pointer = false;  ///< at the player's own object
    friend bool operator==(const FrameState&, const FrameState&) = default;
  };

  FrameState currentState(Time now);
  std::vector<ChatEntry> recentChat(Time now) const;
  std::string banner(Time now) const;
  void noteOwnObject(const ClientSession& session, Time now);

  Connection& m_connection;
  const ClientControls& m_controls;
  const SoundNotes& m_sounds;
  FrameState m_composed;
  ChatEntry m_notice;
  StatusTimer m_status;
  std::optional<std::uint32_t> m_joined_as;
  bool m_pointed = false;
  Time m_point_until{};  ///< at the player's own object
  bool m_browser = false;
  bool m_key_releases = false;
};

}  // namespace naiad
