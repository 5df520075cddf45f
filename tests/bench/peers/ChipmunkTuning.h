// At which cell and table size Chipmunk's spatial hash is fastest, found by trial for each kind of scene.
#pragma once

#include "Scene.h"

namespace bench {

struct ChipmunkTuning {
  double cell = 0;           ///< size of the hash's cells, in cells of the world
  int table = 0;             ///< length of the hash table
  int table_per_object = 0;  ///< the same, per object
};

/// The best for scenes like this one. Tried with at most 100,000 objects, a few ticks each.
ChipmunkTuning tuneChipmunk(const Scene& scene);

}  // namespace bench
