// The world as the snapshots describe it, what they acknowledge, and the player's own object ahead of them.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "client/session/InputOutbox.h"
#include "client/session/ServerMessages.h"
#include "client/world/DisplayClock.h"
#include "client/world/InputTickEstimator.h"
#include "client/world/Prediction.h"
#include "client/world/WorldFeed.h"
#include "shared/replica/Acks.h"

namespace naiad {

class ReceivedWorld {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Result = WorldFeed::Result;

  static constexpr std::chrono::seconds kChecksumEvery{1};

  /// The welcome came; snapshots count on from `from`.
  void start(const WelcomeMessage& welcome, const Continuation& from);
  /// The session was resumed in tick `tick_now`: this process may have stood still since the last snapshot.
  void resume(std::uint32_t tick_now) { m_feed.noteTick(tick_now); }

  /// The player goes to another world, whose snapshots have this epoch; its tick is about `tick_now`.
  void enter(std::uint8_t epoch, std::uint32_t tick_now, Time now);
  /// Read and apply a snapshot; `before` is called just before. Its inputs leave `inputs`.
  Result applySnapshot(std::string_view bytes, Time now, InputOutbox& inputs,
                       const std::function<void(std::uint32_t tick)>& before);
  /// Of the snapshot that was applied last.
  const SnapshotHeader& header() const { return m_header; }
  /// Is the snapshot before the newest one missing?
  bool hasGap() const { return (m_acks.mask & 1) == 0; }

  const WorldFeed& feed() const { return m_feed; }
  const Replica& replica() const { return m_feed.shown(); }
  const AckWindow& acks() const { return m_acks; }
  /// The checksum to report now, if one is due.
  std::optional<std::uint64_t> takeChecksum(Time now);

  DisplayClock& clock() { return m_clock; }
  const DisplayClock& clock() const { return m_clock; }
  void noteRoundTrip(InputTickEstimator::Millis sample);
  const InputTickEstimator& inputTicks() const { return m_input_ticks; }

  /// A key that was just sent is part of the prediction from now on.
  void predictInput(const Input& input) { m_prediction.addInput(input); }
  /// Predict up to the tick in which the server will apply a key pressed now.
  const Prediction& predict(Time now);
  std::uint32_t predictedTick(Time now) const;
  bool isPredicting() const { return m_prediction.isActive(); }

 private:
  void applyControls();
  DisplayClock::Duration oneWayDelay() const;
  void noteClock(Result result, Time now);

  WorldFeed m_feed;
  SnapshotHeader m_header;
  AckWindow m_acks;
  Time m_next_checksum{};
  std::chrono::microseconds m_tick{33333};
  DisplayClock m_clock{m_tick};
  bool m_moving = false;  ///< another room's world is expected, whose ticks may be before those of this one
  InputTickEstimator m_input_ticks;
  Prediction m_prediction;
  std::uint32_t m_table_known = 0;    ///< snapshot that carried the newest control table applied
  std::uint32_t m_control_known = 0;  ///< … and control state
};

}  // namespace naiad
