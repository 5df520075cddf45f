// Which bit of World::isStarted belongs to which manager.
#pragma once

namespace df {

enum Started : unsigned {
  kGameStarted = 1,
  kWorldStarted = 2,
  kLogStarted = 4,
  kDisplayStarted = 8,
  kInputStarted = 16,
  kResourcesStarted = 32,
  kGameHasRun = 64,  ///< GM.run() has been there since
};

}  // namespace df
