// The world of this process, on this thread.
#pragma once

#include <optional>

#include "host/snapshot/LagCompensator.h"
#include "host/world/WorldPort.h"

namespace df {
class World;
}

namespace naiad {

/// Let the world have what is in the turn.
void applyTurn(const WorldTurn& turn, df::World& world);
/// What came of it in the tick that followed.
WorldAnswer takeAnswer(const WorldTurn& turn, df::World& world);

class WorldInProcess : public WorldPort {
 public:
  /// `world` must live until this is gone.
  explicit WorldInProcess(df::World& world) : m_world(world) {}
  ~WorldInProcess() override;
  WorldInProcess(const WorldInProcess&) = delete;
  WorldInProcess& operator=(const WorldInProcess&) = delete;

  bool isReady() const override { return true; }
  void tick(const SentTurn& turn) override;
  std::uint32_t nextTick() const override;
  std::uint32_t ticksBefore() const override { return 0; }
  const df::WorldView& view() const override;
  void notePublished(const Publisher& publisher) override;
  void close(const WorldTurn& rest) override;

 private:
  df::World& m_world;
  std::optional<LagCompensator> m_lag_compensator;  ///< while the game wants it
};

}  // namespace naiad
