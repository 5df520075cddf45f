// The libraries that the engine is compared with, as built by Debian: Chipmunk 7.0.3 and Box2D 2.4.1.
#pragma once

#include "Engine.h"
#include "Scene.h"

namespace bench {

/// A Chipmunk spatial hash alone: cpSpatialIndexQuery, then cpSpatialIndexReindexObject. `cell` is the size
/// of its cells, `table` the length of its hash table; tuneChipmunk() finds the best values.
EnginePtr makeChipmunkHash(const Scene& scene, double cell, int table);
/// A Chipmunk space that uses a spatial hash: cpSpaceBBQuery, then cpSpaceReindexShape.
EnginePtr makeChipmunkSpace(const Scene& scene, double cell, int table);
/// A Chipmunk space with its default bounding box trees.
EnginePtr makeChipmunkTree(const Scene& scene);

/// A Box2D world: b2World::QueryAABB, then b2Body::SetTransform. `turns` is the number of objects that move
/// in each tick(); if less than all, they are evenly spaced among all.
EnginePtr makeBox2dWorld(const Scene& scene, int turns);
/// A Box2D tree alone: b2DynamicTree::Query, then MoveProxy.
EnginePtr makeBox2dTree(const Scene& scene);
/// Bodies without shapes in a Box2D world, moved by b2World::Step, for scenes without collisions. (Three
/// quarters of its time are clock readings for Step's profile, which are made for each body here.)
EnginePtr makeBox2dMotion(const Scene& scene);

/// Cell and table size at which Chipmunk's spatial hash is fastest.
struct ChipmunkTuning {
  double cell = 0;           ///< size of the hash's cells, in cells of the world
  int table = 0;             ///< length of the hash table
  int table_per_object = 0;  ///< table length per object
};

/// Returns the best sizes for scenes like this one, from trials of a few ticks with at most 100,000 objects.
ChipmunkTuning tuneChipmunk(const Scene& scene);

}  // namespace bench
