#include "engine/managers/DisplayManager.h"

#include <algorithm>
#include <cmath>

#include "engine/world/ColorMix.h"
#include "engine/world/Drawing.h"
#include "engine/world/Started.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "shared/values/Canvas.h"

namespace df {

DisplayManager::DisplayManager() : Manager("DisplayManager", kDisplayStarted) {}

DisplayManager& DisplayManager::getInstance() {
  static DisplayManager* p_instance = new DisplayManager;
  return *p_instance;
}

int DisplayManager::drawCh(Vector world_pos, char ch, Color color) const {
  return drawCharacter(world_pos, ch, color);
}

int DisplayManager::drawCh(Vector world_pos, int ch, Color color) const {
  return drawCh(world_pos, ch > 0 && ch < 0x80 ? static_cast<char32_t>(ch) : U'?', color);
}

int DisplayManager::drawCh(Vector world_pos, char ch, Color color, float /*rotation*/) const {
  return drawCh(world_pos, ch, color);
}

int DisplayManager::drawCh(Vector world_pos, char ch, unsigned char r, unsigned char g, unsigned char b,
                           float /*rotation*/) const {
  return drawCh(world_pos, ch, nearestColor(r, g, b));
}

int DisplayManager::drawCh(Vector world_pos, char32_t ch, Color color) const {
  return World::current().drawCh(world_pos, ch, color == CUSTOM ? COLOR_DEFAULT : color);
}

int DisplayManager::drawString(Vector world_pos, const std::string& str, Justification just,
                               Color color) const {
  if (color == CUSTOM) color = COLOR_DEFAULT;
  const std::u32string characters = decodeUtf8(str);
  const auto length = static_cast<double>(characters.size());
  double x = world_pos.x();
  if (just == CENTER_JUSTIFIED) x -= std::floor(length / 2);
  if (just == RIGHT_JUSTIFIED) x -= length;
  // If one end is out of range, nothing is drawn.
  World& world = World::current();
  if (!toFixed(Vector(x, world_pos.y())) || !toFixed(x + length) || color < BLACK || color > WHITE) {
    return world.log().refuse("DisplayManager", "drawString");
  }
  for (const char32_t ch : characters) world.drawCh(Vector(x++, world_pos.y()), ch, color);
  return 0;
}

int DisplayManager::setSize(int horizontal, int vertical) {
  World& world = World::current();
  return world.views().setWindow(horizontal, vertical) == 0 ? 0
                                                            : world.log().refuse("DisplayManager", "setSize");
}

int DisplayManager::getHorizontal() const {
  return World::current().views().width();
}

int DisplayManager::getVertical() const {
  return World::current().views().height();
}

int DisplayManager::getHorizontalPixels() const {
  return Config::getInstance().getWindowHorizontalPixels();
}

int DisplayManager::getVerticalPixels() const {
  return Config::getInstance().getWindowVerticalPixels();
}

bool DisplayManager::setBackgroundColor(Color new_color) {
  if (new_color < BLACK || new_color > WHITE) return false;
  World::current().extras().background = new_color;
  return true;
}

void DisplayManager::shake(int scale_x, int scale_y, int duration, bool delta) {
  static constexpr int kMaxShake = 20;
  const auto cells = [](int pixels, float pixels_per_cell) {
    return std::clamp(static_cast<int>(std::lrint(static_cast<float>(pixels) / pixels_per_cell)), 0,
                      kMaxShake);
  };
  ScreenShake& shake = World::current().extras().shake;
  const ScreenShake before = delta ? shake : ScreenShake{};
  // A shake of less than a cell would not show, so the least is one cell.
  const int x = scale_x > 0 ? std::max(1, cells(scale_x, charWidth())) : 0;
  const int y = scale_y > 0 ? std::max(1, cells(scale_y, charHeight())) : 0;
  shake.scale_x = std::min(before.scale_x + x, kMaxShake);
  shake.scale_y = std::min(before.scale_y + y, kMaxShake);
  shake.ticks = std::clamp(duration, 0, 9000) + before.ticks;
}

sf::RenderWindow* DisplayManager::getWindow() const {
  static auto* p_window = new sf::RenderWindow;
  return p_window;
}

float charHeight() {
  return static_cast<float>(DM.getVerticalPixels()) / static_cast<float>(DM.getVertical());
}

float charWidth() {
  return static_cast<float>(DM.getHorizontalPixels()) / static_cast<float>(DM.getHorizontal());
}

Vector spacesToPixels(Vector spaces) {
  return {spaces.x() * charWidth(), spaces.y() * charHeight()};
}

Vector pixelsToSpaces(Vector pixels) {
  return {pixels.x() / charWidth(), pixels.y() / charHeight()};
}

}  // namespace df
