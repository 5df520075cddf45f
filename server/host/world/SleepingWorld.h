// The world of a room in which none is: it takes no turn, until another one replaces it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "host/world/WorldPort.h"

namespace naiad {

class SleepingWorld : public WorldPort {
 public:
  bool isReady() const override { return false; }
  void tick(const SentTurn& /*turn*/) override {}
  std::uint32_t nextTick() const override { return m_next_tick; }
  const df::WorldView& view() const override { return m_view; }
  void checkProcess(std::uint32_t tick) override { m_next_tick = std::max(tick, 1u); }

 private:
  std::uint32_t m_next_tick = 1;
  df::WorldView m_view;
};

}  // namespace naiad
