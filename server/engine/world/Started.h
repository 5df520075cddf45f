// Bits for World::isStarted(), one for each manager.
#pragma once

namespace df {

enum Started : unsigned {
  kGameStarted = 1,
  kWorldStarted = 2,
  kLogStarted = 4,
  kDisplayStarted = 8,
  kInputStarted = 16,
  kResourcesStarted = 32,
  kGameHasRun = 64,  ///< GM.run() was called after GM.startUp()
};

}  // namespace df
