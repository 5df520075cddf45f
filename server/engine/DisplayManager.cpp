#include "DisplayManager.h"

#include "Canvas.h"
#include "Started.h"
#include "World.h"

namespace df {

DisplayManager& DisplayManager::getInstance() {
  static DisplayManager* p_instance = new DisplayManager;
  return *p_instance;
}

int DisplayManager::startUp() {
  World::current().setStarted(kDisplayStarted, true);
  return 0;
}

void DisplayManager::shutDown() {
  World::current().setStarted(kDisplayStarted, false);
}

bool DisplayManager::isStarted() const {
  return World::current().isStarted(kDisplayStarted);
}

// A char beyond ASCII is a piece of some encoding, not a character.
int DisplayManager::drawCh(Vector world_pos, char ch, Color color) const {
  const auto code = static_cast<unsigned char>(ch);
  return drawCh(world_pos, code < 0x80 ? char32_t{code} : U'?', color);
}

int DisplayManager::drawCh(Vector world_pos, char32_t ch, Color color) const {
  return World::current().drawCh(world_pos, ch, color);
}

int DisplayManager::drawString(Vector world_pos, const std::string& str, Justification just,
                               Color color) const {
  const std::u32string characters = decodeUtf8(str);
  const auto length = static_cast<double>(characters.size());
  double x = world_pos.x();
  if (just == CENTER_JUSTIFIED) x -= std::floor(length / 2);
  if (just == RIGHT_JUSTIFIED) x -= length;
  // Both ends in range, or nothing is drawn.
  World& world = World::current();
  if (!toFixed(Vector(x, world_pos.y())) || !toFixed(x + length) || color < BLACK || color > WHITE) {
    world.refuse("DisplayManager", "drawString");
    return -1;
  }
  for (const char32_t ch : characters) world.drawCh(Vector(x++, world_pos.y()), ch, color);
  return 0;
}

int DisplayManager::setSize(int horizontal, int vertical) {
  World& world = World::current();
  if (world.setWindow(horizontal, vertical) == 0) return 0;
  world.refuse("DisplayManager", "setSize");
  return -1;
}

int DisplayManager::getHorizontal() const {
  return World::current().getWindowWidth();
}

int DisplayManager::getVertical() const {
  return World::current().getWindowHeight();
}

}  // namespace df
