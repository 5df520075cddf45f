#include "engine/published/PathManager.h"

namespace df {

PathManager& PathManager::getInstance() {
  static PathManager* p_instance = new PathManager;
  return *p_instance;
}

int PathManager::startUp() {
  return Manager::startUp();
}

}  // namespace df
