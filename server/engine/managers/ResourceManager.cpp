#include "engine/managers/ResourceManager.h"

#include "engine/world/Started.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

namespace {

Resources& resources() {
  return World::current().extras().resources;
}

}  // namespace

ResourceManager::ResourceManager() : Manager("ResourceManager", kResourcesStarted) {}

ResourceManager& ResourceManager::getInstance() {
  static ResourceManager* p_instance = new ResourceManager;
  return *p_instance;
}

int ResourceManager::loadSprite(const std::string& filename, const std::string& label) {
  return resources().loadSprite(filename, label);
}

int ResourceManager::unloadSprite(const std::string& label) {
  return resources().unloadSprite(label);
}

Sprite* ResourceManager::getSprite(const std::string& label) const {
  return resources().spriteOrPlaceholder(label);
}

int ResourceManager::loadSound(const std::string& filename, const std::string& label) {
  return resources().sounds().load(filename, label);
}

int ResourceManager::unloadSound(const std::string& label) {
  return resources().sounds().unload(label);
}

Sound* ResourceManager::getSound(const std::string& label) {
  return resources().sounds().findOrPlaceholder(label);
}

int ResourceManager::loadMusic(const std::string& filename, const std::string& label) {
  return resources().musics().load(filename, label);
}

int ResourceManager::unloadMusic(const std::string& label) {
  return resources().musics().unload(label);
}

Music* ResourceManager::getMusic(const std::string& label) {
  return resources().musics().findOrPlaceholder(label);
}

}  // namespace df
