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

ResourceManager& ResourceManager::getInstance() {
  static ResourceManager* p_instance = new ResourceManager;
  return *p_instance;
}

int ResourceManager::startUp() {
  World::current().setStarted(kResourcesStarted, true);
  return 0;
}

void ResourceManager::shutDown() {
  World::current().setStarted(kResourcesStarted, false);
}

bool ResourceManager::isStarted() const {
  return World::current().isStarted(kResourcesStarted);
}

int ResourceManager::loadSprite(const std::string& filename, const std::string& label) {
  return resources().loadSprite(filename, label);
}

int ResourceManager::unloadSprite(const std::string& label) {
  return resources().unloadSprite(label);
}

Sprite* ResourceManager::getSprite(const std::string& label) const {
  return resources().spriteOrStandIn(label);
}

int ResourceManager::loadSound(const std::string& filename, const std::string& label) {
  return resources().loadSound(filename, label);
}

int ResourceManager::unloadSound(const std::string& label) {
  return resources().unloadSound(label);
}

Sound* ResourceManager::getSound(const std::string& label) {
  return resources().soundOrStandIn(label);
}

int ResourceManager::loadMusic(const std::string& filename, const std::string& label) {
  return resources().loadMusic(filename, label);
}

int ResourceManager::unloadMusic(const std::string& label) {
  return resources().unloadMusic(label);
}

Music* ResourceManager::getMusic(const std::string& label) {
  return resources().musicOrStandIn(label);
}

}  // namespace df
