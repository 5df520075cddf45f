// The worlds of the network measurements: `busy1000`, and two in which nothing changes that must be sent.
//
// 1000 single characters on 320 by 96 cells. 80 % walk at up to ±0.5 cells per tick across and ±0.25 down, 10
// % stand, 10 % run at ±1 across; they bounce at the edges. In each tick 1 % turn, 2 % change their
// character, 0.2 % die while another is born elsewhere. All of this uses df::Object and is seeded.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Object.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace bench {

inline constexpr int kBusyWidth = 320;
inline constexpr int kBusyHeight = 96;

enum class BusyKind {
  kBusy,
  kStraight,  ///< no turns, changes or deaths, and no walker at an edge for two minutes
  kStill,     ///< no changes at all
};

inline constexpr int kWalkers = 1000;
inline constexpr int kFine = 1'000'000;
inline constexpr int kTwoMinutes = 120 * 30;  // in ticks

/// Returns a uniform number in -most … most.
inline double within(double most) {
  return most * (2.0 * WM.randomInt(kFine) / kFine - 1.0);
}

class BusyWalker : public df::Object {
 public:
  explicit BusyWalker(BusyKind kind) : m_kind(kind) {
    setType("Walker");
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(1.0 * kBusyWidth * WM.randomInt(kFine) / kFine,
                           1.0 * kBusyHeight * WM.randomInt(kFine) / kFine));
    m_gait = WM.randomInt(10);
    turn();
    restyle();
    m_color = static_cast<df::Color>(1 + WM.randomInt(df::kColorCount - 1));
    if (kind == BusyKind::kBusy) registerInterest(df::STEP_EVENT);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::STEP_EVENT) return 0;
    if (WM.randomInt(1000) < 2) {
      WM.markForDelete(this);
      new BusyWalker(m_kind);
      return 1;
    }
    if (WM.randomInt(100) < 1) turn();
    if (WM.randomInt(100) < 2) restyle();
    bounce();
    return 1;
  }

  int draw() override { return DM.drawCh(getPosition(), m_ch, m_color); }

 private:
  void turn() {
    if (m_kind == BusyKind::kStill || m_gait == 0) return;
    if (m_gait == 1 && m_kind == BusyKind::kBusy) {
      setVelocity(df::Vector(WM.randomInt(2) == 0 ? 1 : -1, 0));
    } else {
      const double x = within(0.5);
      setVelocity(df::Vector(x, within(0.25)));
    }
    if (m_kind == BusyKind::kStraight) stayForTwoMinutes();
  }
  // Walks towards the farther side so slowly that it does not arrive in two minutes, because leaving the map
  // would be a change.
  void stayForTwoMinutes() {
    const df::Vector p = getPosition();
    const df::Vector v = getVelocity();
    const double x = std::abs(v.getX()) * kBusyWidth / 2 / 0.5 / kTwoMinutes;
    const double y = std::abs(v.getY()) * kBusyHeight / 2 / 0.25 / kTwoMinutes;
    setVelocity(df::Vector(p.getX() < kBusyWidth / 2 ? x : -x, p.getY() < kBusyHeight / 2 ? y : -y));
  }
  void restyle() { m_ch = static_cast<char>('A' + WM.randomInt(26)); }
  void bounce() {
    df::Vector v = getVelocity();
    const df::Vector next = getPosition() + v;
    const bool across = next.getX() < 0 || next.getX() > kBusyWidth - 1;
    const bool down = next.getY() < 0 || next.getY() > kBusyHeight - 1;
    if (!across && !down) return;
    setVelocity(df::Vector(across ? -v.getX() : v.getX(), down ? -v.getY() : v.getY()));
  }

  BusyKind m_kind;
  int m_gait = 0;
  char m_ch = '?';
  df::Color m_color = df::WHITE;
};

/// Gives each player an invisible Object in the middle of a part of the world, which is the centre of the
/// view.
class Usher : public df::Object {
 public:
  Usher() {
    setType("Usher");
    setSolidness(df::SPECTRAL);
    setVisible(false);
    registerInterest(df::JOIN_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    const auto* p_join = dynamic_cast<const df::EventJoin*>(p_e);
    if (p_join == nullptr) return 0;
    const int width = static_cast<int>(WM.getView().getHorizontal());
    const int height = static_cast<int>(WM.getView().getVertical());
    const int columns = std::max(1, kBusyWidth / width);
    const int rows = std::max(1, kBusyHeight / height);
    const int part = m_count++ % (columns * rows);
    auto* p_eye = new df::Object;
    p_eye->setSolidness(df::SPECTRAL);
    p_eye->setVisible(false);
    p_eye->setPosition(
        df::Vector(width / 2 + width * (part % columns), height / 2 + height * (part / columns)));
    WM.getPlayer(p_join->getPlayer())->setObject(p_eye);
    return 1;
  }

 private:
  int m_count = 0;
};

/// Fills the current world: its boundary, and 1000 walkers.
inline void populateBusy(BusyKind kind) {
  WM.setBoundary(df::Box(df::Vector(0, 0), kBusyWidth, kBusyHeight));
  for (int i = 0; i < kWalkers; ++i) new BusyWalker(kind);
}

class BusyScene {
 public:
  using Kind = BusyKind;

  /// Each player's view is `width` by `height` cells. The views are spread over the parts of the world in
  /// turn.
  BusyScene(Kind kind, int width, int height, int players) {
    const df::World::Scope scope(m_world);
    m_world.setSeed(1);
    m_world.store().setWatched(true);
    m_world.views().setWindow(width, height);
    new Usher;
    populateBusy(kind);
    for (int i = 0; i < players; ++i) m_world.input().join("bot" + std::to_string(i), df::WHITE);
  }
  ~BusyScene() {
    const df::World::Scope scope(m_world);
    m_world.shutDown();
  }

  void tick() {
    const df::World::Scope scope(m_world);
    m_world.tick();
  }
  const df::World& world() const { return m_world; }
  /// Returns the player's picture by the engine's own draw().
  df::Canvas truth(std::uint32_t player) const { return m_world.picture().renderPlayer(player); }

 private:
  df::World m_world;
};

}  // namespace bench
