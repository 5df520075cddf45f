// Two peers: Chipmunk's spatial hash alone, and its space as an index of boxes.
#include <chipmunk/chipmunk.h>

#include "PeerWorld.h"
#include "Peers.h"

namespace bench {
namespace {

using Object = PeerBody<cpFloat>;
using Query = PeerQuery<cpFloat>;

class ChipmunkHash {
 public:
  using Real = cpFloat;

  ChipmunkHash(const Scene& /*scene*/, double cell, int table)
      : m_index(cpSpaceHashNew(cell, table, &boxOf, nullptr)) {}
  ChipmunkHash(const ChipmunkHash&) = delete;
  ChipmunkHash& operator=(const ChipmunkHash&) = delete;
  ~ChipmunkHash() { cpSpatialIndexFree(m_index); }

  void add(Object& object) { cpSpatialIndexInsert(m_index, &object, object.id); }

  void touching(Object& mover, Real x, Real y, std::vector<Object*>& out) {
    const cpBB box = cpBBNewForExtents(cpv(x, y), mover.half_width, mover.half_height);
    Query query{mover, x, y, out};
    cpSpatialIndexQuery(m_index, &mover, box, &found, &query);
  }

  void moved(Object& object) { cpSpatialIndexReindexObject(m_index, &object, object.id); }

 private:
  static cpBB boxOf(void* p) {
    const auto* object = static_cast<const Object*>(p);
    return cpBBNewForExtents(cpv(object->x, object->y), object->half_width, object->half_height);
  }

  // The hash reports all objects in the cells of the box, except the mover itself.
  static cpCollisionID found(void* /*p_mover*/, void* p_other, cpCollisionID id, void* p_query) {
    auto* query = static_cast<Query*>(p_query);
    auto* other = static_cast<Object*>(p_other);
    if (query->mover.touches(*other, query->x, query->y)) query->out.push_back(other);
    return id;
  }

  cpSpatialIndex* m_index;
};

// Uses static bodies: they have positions and boxes, but the space never moves or pairs them, so it has the
// least work. (With kinematic bodies the tree takes 1.3 times as long, because it maintains their pairs.)
class ChipmunkSpace {
 public:
  using Real = cpFloat;

  /// `table` is the length of the hash table; 0 selects the trees instead.
  ChipmunkSpace(const Scene& /*scene*/, double cell, int table) : m_space(cpSpaceNew()) {
    if (table > 0) cpSpaceUseSpatialHash(m_space, cell, table);
  }
  ChipmunkSpace(const ChipmunkSpace&) = delete;
  ChipmunkSpace& operator=(const ChipmunkSpace&) = delete;
  ~ChipmunkSpace() {
    std::vector<cpShape*> shapes;
    cpSpaceEachShape(
        m_space,
        [](cpShape* shape, void* list) { static_cast<std::vector<cpShape*>*>(list)->push_back(shape); },
        &shapes);
    cpSpaceFree(m_space);
    for (cpShape* shape : shapes) {
      cpBodyFree(cpShapeGetBody(shape));
      cpShapeFree(shape);
    }
  }

  void add(Object& object) {
    cpBody* body = cpBodyNewStatic();
    cpBodySetPosition(body, cpv(object.x, object.y));
    cpShape* shape = cpBoxShapeNew(body, 2 * object.half_width, 2 * object.half_height, 0);
    cpShapeSetUserData(shape, &object);
    object.shape = cpSpaceAddShape(m_space, shape);
  }

  void touching(Object& mover, Real x, Real y, std::vector<Object*>& out) {
    const cpBB box = cpBBNewForExtents(cpv(x, y), mover.half_width, mover.half_height);
    Query query{mover, x, y, out};
    cpSpaceBBQuery(m_space, box, CP_SHAPE_FILTER_ALL, &found, &query);
  }

  void moved(Object& object) {
    auto* shape = static_cast<cpShape*>(object.shape);
    cpBodySetPosition(cpShapeGetBody(shape), cpv(object.x, object.y));
    cpSpaceReindexShape(m_space, shape);
  }

 private:
  // No further test is needed: the space has compared the boxes, including edges, and doubles are exact here.
  static void found(cpShape* shape, void* p_query) {
    auto* query = static_cast<Query*>(p_query);
    auto* other = static_cast<Object*>(cpShapeGetUserData(shape));
    if (other != &query->mover) query->out.push_back(other);
  }

  cpSpace* m_space;
};

}  // namespace

EnginePtr makeChipmunkHash(const Scene& scene, double cell, int table) {
  return std::make_unique<PeerWorld<ChipmunkHash>>(scene, scene.count(), cell, table);
}

EnginePtr makeChipmunkSpace(const Scene& scene, double cell, int table) {
  return std::make_unique<PeerWorld<ChipmunkSpace>>(scene, scene.count(), cell, table);
}

EnginePtr makeChipmunkTree(const Scene& scene) {
  return std::make_unique<PeerWorld<ChipmunkSpace>>(scene, scene.count(), 0.0, 0);
}

}  // namespace bench
