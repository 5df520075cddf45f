// The world that the snapshots describe, the acknowledgements, and the prediction of the player's own object.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "client/session/InputOutbox.h"
#include "client/session/ServerMessages.h"
#include "client/world/DisplayClock.h"
#include "client/world/EpochReplicas.h"
#include "client/world/InputTickEstimator.h"
#include "client/world/Prediction.h"
#include "shared/replica/Acks.h"

namespace naiad {

class ReceivedWorld {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Result = EpochReplicas::Result;

  static constexpr std::chrono::seconds kChecksumInterval{1};

  /// Call after the welcome. Snapshot numbers continue from `from`.
  void start(const WelcomeMessage& welcome, const ResumeState& from);
  /// Call when the session was resumed at about tick `tick_now`, because the last snapshot may be much older.
  void resume(std::uint32_t tick_now) { m_worlds.advanceTick(tick_now); }

  /// Call when the player moves to another world. Its snapshots have this epoch; its tick is near `tick_now`.
  void enter(std::uint8_t epoch, std::uint32_t tick_now, Time now);
  /// Reads and applies a snapshot; `before` is called just before. Removes acknowledged inputs from `inputs`.
  Result applySnapshot(std::string_view bytes, Time now, InputOutbox& inputs,
                       const std::function<void(std::uint32_t tick)>& before);
  /// Header of the snapshot that was applied last.
  const SnapshotHeader& header() const { return m_header; }
  /// True if the snapshot before the newest one is missing.
  bool hasGap() const { return (m_acks.mask & 1) == 0; }

  const EpochReplicas& worlds() const { return m_worlds; }
  const Replica& replica() const { return m_worlds.shown(); }
  const AckWindow& acks() const { return m_acks; }
  /// Returns the replica's checksum for the server, if one is due.
  std::optional<std::uint64_t> pollChecksum(Time now);

  DisplayClock& clock() { return m_clock; }
  const DisplayClock& clock() const { return m_clock; }
  void addRttSample(InputTickEstimator::Millis sample);
  const InputTickEstimator& inputTicks() const { return m_input_ticks; }

  /// Adds a key that was just sent to the prediction.
  void predictInput(const Input& input) { m_prediction.addInput(input); }
  /// Predicts the player's object up to predictedTick(), in which the server will apply a key pressed now.
  const Prediction& predict(Time now);
  std::uint32_t predictedTick(Time now) const;
  bool isPredicting() const { return m_prediction.isActive(); }

 private:
  void applyControls();
  DisplayClock::Duration oneWayDelay() const;
  void updateClock(Result result, Time now);

  EpochReplicas m_worlds;
  SnapshotHeader m_header;
  AckWindow m_acks;
  Time m_next_checksum{};
  std::chrono::microseconds m_tick{33333};
  DisplayClock m_clock{m_tick};
  bool m_changes_world = false;  ///< another room's world is awaited; its ticks may be lower
  InputTickEstimator m_input_ticks;
  Prediction m_prediction;
  std::uint32_t m_table_known = 0;    ///< snapshot that carried the newest control table applied
  std::uint32_t m_control_known = 0;  ///< snapshot that carried the newest control state applied
};

}  // namespace naiad
