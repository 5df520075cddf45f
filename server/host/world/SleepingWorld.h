// The world of a room in which none is: it takes input and does nothing, until another one replaces it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "host/world/WorldPort.h"

namespace naiad {

class SleepingWorld : public WorldPort {
 public:
  std::uint32_t addInput(df::InputQueue::Input input) override { return input.player; }
  void setHeard(std::uint32_t /*player*/) override {}
  void endGame() override {}
  bool isReady() const override { return false; }
  void tick(bool /*watched*/, bool /*truth*/) override {}
  std::uint32_t nextTick() const override { return m_next_tick; }
  const df::WorldView& view() const override { return m_view; }
  void notePublished(const Publisher& /*publisher*/) override {}
  std::vector<std::uint32_t> takeLeavers() override { return {}; }
  std::vector<df::AddedScore> takeScores() override { return {}; }
  bool isGameOver() const override { return false; }
  df::Canvas renderPlayer(std::uint32_t /*player*/) const override { return {}; }
  void checkProcess(std::uint32_t tick) override { m_next_tick = std::max(tick, 1u); }

 private:
  std::uint32_t m_next_tick = 1;
  df::WorldView m_view;
};

}  // namespace naiad
