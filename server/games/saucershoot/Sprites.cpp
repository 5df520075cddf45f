#include "Sprites.h"

#include "ResourceManager.h"

namespace {

int load(const std::string& name, const std::string& label) {
  return RM.loadSprite("sprites/" + name + "-spr.txt", label);
}

}  // namespace

int loadSprites() {
  for (const char* name : {"drone", "weaver", "raider", "explosion", "gamestart", "gameover"}) {
    if (load(name, name) != 0) return -1;
  }
  for (const char* name : {"ship", "bullet"}) {
    for (int color = df::RED; color <= df::WHITE; ++color) {
      const std::string label = inColor(name, static_cast<df::Color>(color));
      if (load(name, label) != 0) return -1;
      RM.getSprite(label)->setColor(static_cast<df::Color>(color));
    }
  }
  return 0;
}
