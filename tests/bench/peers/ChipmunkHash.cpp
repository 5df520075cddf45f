#include <chipmunk/chipmunk.h>

#include "PeerWorld.h"
#include "Peers.h"

namespace bench {

namespace {

class ChipmunkHash {
 public:
  using Real = cpFloat;
  using Object = PeerBody<Real>;

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
  struct Query {
    const Object& mover;
    Real x;
    Real y;
    std::vector<Object*>& out;
  };

  static cpBB boxOf(void* p) {
    const auto* object = static_cast<const Object*>(p);
    return cpBBNewForExtents(cpv(object->x, object->y), object->half_width, object->half_height);
  }

  // The hash names everybody in the cells of the box, but not the mover itself.
  static cpCollisionID found(void* /*p_mover*/, void* p_other, cpCollisionID id, void* p_query) {
    auto* query = static_cast<Query*>(p_query);
    auto* other = static_cast<Object*>(p_other);
    if (query->mover.touches(*other, query->x, query->y)) query->out.push_back(other);
    return id;
  }

  cpSpatialIndex* m_index;
};

}  // namespace

EnginePtr makeChipmunkHash(const Scene& scene, double cell, int table) {
  return std::make_unique<PeerWorld<ChipmunkHash>>(scene, scene.count(), cell, table);
}

}  // namespace bench
