// What the next frame shows, and whether it differs from the last one.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "client/session/Connection.h"
#include "client/ui/ClientControls.h"
#include "client/ui/ScreenLayout.h"
#include "client/ui/SoundNotes.h"

namespace naiad {

class FrameComposer {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// All must outlive it.
  FrameComposer(Connection& connection, const ClientControls& controls, const SoundNotes& sounds)
      : m_connection(connection), m_controls(controls), m_sounds(sounds) {}

  /// Would a frame composed now differ from the last one? Changes of the controls are not considered.
  bool isStale(Time now) { return !(currentState(now) == m_composed); }
  ScreenModel composeFrame(Time now);

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
    friend bool operator==(const FrameState&, const FrameState&) = default;
  };

  FrameState currentState(Time now);
  std::vector<ChatEntry> recentChat(Time now) const;
  std::string banner(Time now) const;

  Connection& m_connection;
  const ClientControls& m_controls;
  const SoundNotes& m_sounds;
  FrameState m_composed;
};

}  // namespace naiad
