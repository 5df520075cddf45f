#include "engine/world/Drawing.h"

#include "engine/sprites/Frame.h"
#include "engine/world/World.h"

namespace df {

int drawCharacter(Vector world_pos, char ch, Color color) {
  const auto code = static_cast<unsigned char>(ch);
  return World::current().drawCh(world_pos, code < 0x80 ? char32_t{code} : U'?',
                                 color == CUSTOM ? COLOR_DEFAULT : color);
}

int Frame::draw(Vector position, Color color, char transparency) const {
  if (m_width < 1 || m_height < 1) return -1;
  const Vector corner = position - Vector((m_width - 1) / 2.0, (m_height - 1) / 2.0);
  int result = 0;
  for (int y = 0; y < m_height; ++y) {
    for (int x = 0; x < m_width; ++x) {
      const char ch = at(x, y);
      if (transparency != 0 && ch == transparency) continue;
      if (drawCharacter(corner + Vector(x, y), ch, color) != 0) result = -1;
    }
  }
  return result;
}

}  // namespace df
