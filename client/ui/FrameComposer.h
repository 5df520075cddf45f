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
#include "client/ui/StatusTimer.h"

namespace naiad {

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
