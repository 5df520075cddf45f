#include "physics/kits/Obstacle.h"

#include "engine/managers/DisplayManager.h"

namespace df {

Obstacle::Obstacle(Vector corner, int width, int height, char ch, Color color) : m_ch(ch), m_color(color) {
  setType("Obstacle");
  setStaticLook();
  setPosition(corner);
  setBox(Box(Vector(-0.5, -0.5), width, height));
}

int Obstacle::draw() {
  const Box box = getBox();
  for (int y = 0; y < box.getVertical(); ++y) {
    for (int x = 0; x < box.getHorizontal(); ++x) DM.drawCh(getPosition() + Vector(x, y), m_ch, m_color);
  }
  return 0;
}

}  // namespace df
