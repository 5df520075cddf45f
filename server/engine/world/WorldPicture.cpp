// The part of World that shows: views for hosts, characters for players.

#include "engine/world/Capture.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

void World::setWatched(bool watched) {
  m_p_store->setWatched(watched);
}

bool World::isWatched() const {
  return m_p_store->isWatched();
}

const WorldView& World::view() const {
  return m_capture->view();
}

int World::drawCh(Vector world_pos, char32_t ch, Color color) {
  const auto position = toFixed(world_pos);
  if (!position || color < BLACK || color > WHITE) {
    refuse("DisplayManager", "drawCh");
    return -1;
  }
  m_capture->add(*position, ch, color);
  return 0;
}

void World::forgetLook(std::uint32_t slot) {
  m_capture->forgetLook(slot);
}

void World::drawFrame(std::uint32_t slot) {
  m_capture->addFrame(slot);
}

Canvas World::renderView(FixedVector corner) const {
  return m_capture->render(corner);
}

Canvas World::renderPlayer(std::uint32_t player) const {
  const Player* p_player = getPlayer(player);
  Canvas canvas = renderView(m_views->cornerOf(p_player));
  if (p_player == nullptr) return canvas;
  for (const PlayerText& text : p_player->facts().texts) {
    int x = text.x;
    for (const char32_t ch : decodeUtf8(text.text)) canvas.put(x++, text.y, {ch, text.color});
  }
  return canvas;
}

}  // namespace df
