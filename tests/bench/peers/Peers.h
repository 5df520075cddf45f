// The libraries that the engine is compared with, as Debian builds them: Chipmunk 7.0.3 and Box2D 2.4.1.
#pragma once

#include "Engine.h"
#include "Scene.h"

namespace bench {

/// A Chipmunk spatial hash by itself: cpSpatialIndexQuery, then cpSpatialIndexReindexObject. `cell` is the
/// size of its cells, `table` the length of its hash table; tuneChipmunk() finds the best.
EnginePtr makeChipmunkHash(const Scene& scene, double cell, int table);
/// A Chipmunk space that uses a spatial hash: cpSpaceBBQuery, then cpSpaceReindexShape.
EnginePtr makeChipmunkSpace(const Scene& scene, double cell, int table);
/// The same with the bounding box trees that are its default.
EnginePtr makeChipmunkTree(const Scene& scene);

/// A Box2D world: b2World::QueryAABB, then b2Body::SetTransform. `turns`: how many objects, at equal
/// distances, take a turn per tick(), if that is less than all.
EnginePtr makeBox2dWorld(const Scene& scene, int turns);
/// A Box2D tree by itself: b2DynamicTree::Query, then MoveProxy.
EnginePtr makeBox2dTree(const Scene& scene);
/// Bodies without shapes in a Box2D world, moved by b2World::Step: for scenes in which nobody meets anybody.
/// (Three quarters of its time are the clock readings that Step makes for its profile, one set per body
/// here.)
EnginePtr makeBox2dMotion(const Scene& scene);

/// At which cell and table size Chipmunk's spatial hash is fastest.
struct ChipmunkTuning {
  double cell = 0;           ///< size of the hash's cells, in cells of the world
  int table = 0;             ///< length of the hash table
  int table_per_object = 0;  ///< the same, per object
};

/// The best for scenes like this one. Tried with at most 100,000 objects, a few ticks each.
ChipmunkTuning tuneChipmunk(const Scene& scene);

}  // namespace bench
