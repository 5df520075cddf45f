#include "engine/managers/GameManager.h"

#include <utility>

#include "engine/managers/DisplayManager.h"
#include "engine/managers/InputManager.h"
#include "engine/managers/LogManager.h"
#include "engine/managers/ResourceManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Runner.h"
#include "engine/world/Started.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

GameManager::GameManager() : Manager("GameManager", kGameStarted) {}

GameManager& GameManager::getInstance() {
  static GameManager* p_instance = new GameManager;
  return *p_instance;
}

int GameManager::startUp() {
  LM.startUp();
  DM.startUp();
  IM.startUp();
  WM.startUp();
  RM.startUp();
  World& world = World::current();
  world.setCompat(running::beginCompat(world.compat(), world.program() != nullptr));
  Config::getInstance().loadConfig();
  world.setCompat(running::endCompat(world.compat()));
  world.setGameOver(false);
  world.setStarted(kGameStarted, true);
  if (running::Program* p_program = world.program()) p_program->startUp(world);
  return 0;
}

void GameManager::shutDown() {
  World::current().shutDown();
}

void GameManager::run() {
  Config::reportUnknownKeys();  // only now, because the game may have looked up keys of its own
  World::current().run();
}

int GameManager::getFrameTime() const {
  const WorldExtras* p_extras = World::current().findExtras();
  return p_extras != nullptr ? p_extras->settings.frame_time : FRAME_TIME_DEFAULT;
}

void GameManager::tick() {
  World::current().tick();
}

void GameManager::setGameOver(bool new_game_over) {
  World::current().setGameOver(new_game_over);
}

bool GameManager::getGameOver() const {
  return World::current().isGameOver();
}

int GameManager::getStepCount() const {
  return World::current().getStepCount();
}

void GameManager::setRunner(Runner* p_runner) {
  World::current().setRunner(p_runner);
}

void GameManager::setSeed(std::uint64_t seed) {
  World::current().setSeed(seed);
}

void GameManager::setHelp(std::vector<std::string> lines) {
  World::current().setHelp(std::move(lines));
}

const std::vector<std::string>& GameManager::getHelp() const {
  return World::current().getHelp();
}

}  // namespace df
