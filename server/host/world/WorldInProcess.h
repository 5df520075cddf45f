// A world that runs in this process, on this thread.
#pragma once

#include <optional>

#include "host/snapshot/LagCompensator.h"
#include "host/world/WorldPort.h"

namespace df {
class World;
}

namespace naiad {

/// Passes the inputs and flags of a turn to the world, before its tick.
void applyTurn(const WorldTurn& turn, df::World& world);
/// Returns the results of the turn's tick. Removes leavers, scores and moves to other rooms from the world.
WorldAnswer popAnswer(const WorldTurn& turn, df::World& world);

class WorldInProcess : public WorldPort {
 public:
  /// `world` must outlive this.
  explicit WorldInProcess(df::World& world) : m_world(world) {}
  ~WorldInProcess() override;
  WorldInProcess(const WorldInProcess&) = delete;
  WorldInProcess& operator=(const WorldInProcess&) = delete;

  bool isReady() const override { return true; }
  void tick(const SentTurn& turn) override;
  std::uint32_t nextTick() const override;
  std::uint32_t ticksBefore() const override { return 0; }
  const df::WorldView& view() const override;
  void onPublished(const Publisher& publisher) override;
  void close(const WorldTurn& rest) override;

 private:
  df::World& m_world;
  std::optional<LagCompensator> m_lag_compensator;  ///< nullopt unless the game uses lag compensation
};

}  // namespace naiad
