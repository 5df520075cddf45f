#include "Explosion.h"

#include "DisplayManager.h"
#include "EventStep.h"
#include "WorldManager.h"

namespace {

struct Frame {
  char ch;
  df::Color color;
};
constexpr Frame kFrames[] = {{'*', df::WHITE}, {'#', df::YELLOW}, {'x', df::RED}, {':', df::RED}};
constexpr int kFrameCount = sizeof kFrames / sizeof kFrames[0];
constexpr int kTicksPerFrame = 3;

}  // namespace

Explosion::Explosion(df::Vector position, df::Vector velocity) {
  setType("Explosion");
  setSolidness(df::SPECTRAL);
  setAltitude(1);  // above the stars, below everything one has to see to survive
  setPosition(position);
  setVelocity(velocity);
  registerInterest(df::STEP_EVENT);
}

int Explosion::eventHandler(const df::Event* p_e) {
  if (p_e->getType() != df::STEP_EVENT) return 0;
  if (++m_age >= kFrameCount * kTicksPerFrame) WM.markForDelete(this);
  return 1;
}

int Explosion::draw() {
  // It is drawn once more in the tick in which it ends.
  if (m_age >= kFrameCount * kTicksPerFrame) return 0;
  const Frame& frame = kFrames[m_age / kTicksPerFrame];
  return DM.drawCh(getPosition(), frame.ch, frame.color);
}

void explodeShip(df::Vector position) {
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) new Explosion(position, df::Vector(0.4 * x, 0.2 * y));
  }
}
