// The world of this process, on this thread.
#pragma once

#include <optional>

#include "host/snapshot/LagCompensator.h"
#include "host/world/WorldPort.h"

namespace df {
class World;
}

namespace naiad {

class WorldInProcess : public WorldPort {
 public:
  /// `world` must live until this is gone.
  explicit WorldInProcess(df::World& world) : m_world(world) {}
  ~WorldInProcess() override;
  WorldInProcess(const WorldInProcess&) = delete;
  WorldInProcess& operator=(const WorldInProcess&) = delete;

  std::uint32_t addInput(df::InputQueue::Input input) override;
  void setHeard(std::uint32_t player) override;
  void endGame() override;
  bool isReady() const override { return true; }
  void setChecked(bool state) override { m_checked = state; }
  std::optional<std::uint64_t> stateHash() const override { return m_state_hash; }
  void tick(bool watched, bool truth) override;
  std::uint32_t nextTick() const override;
  const df::WorldView& view() const override;
  void notePublished(const Publisher& publisher) override;
  std::vector<std::uint32_t> takeLeavers() override;
  std::vector<df::AddedScore> takeScores() override;
  bool isGameOver() const override;
  df::Canvas renderPlayer(std::uint32_t player) const override;

 private:
  df::World& m_world;
  bool m_checked = false;
  std::optional<std::uint64_t> m_state_hash;
  std::optional<LagCompensator> m_lag_compensator;  ///< while the game wants it
};

}  // namespace naiad
