#include <box2d/b2_dynamic_tree.h>

#include "PeerWorld.h"
#include "Peers.h"

namespace bench {

namespace {

// Boxes get the room that the tree gives by itself, a tenth of a cell. Telling MoveProxy where they are
// heading would save some reinsertions, but makes the queries slower: tried with 1/4, 1/2 and the whole of
// the velocity, it was never clearly faster, and twice as slow at worst.
class Box2dTree {
 public:
  using Real = float;
  using Object = PeerBody<Real>;

  explicit Box2dTree(const Scene& /*scene*/) {}

  void add(Object& object) { object.handle = m_tree.CreateProxy(boxAt(object, object.x, object.y), &object); }

  void touching(const Object& mover, Real x, Real y, std::vector<Object*>& out) {
    Query query{m_tree, mover, x, y, out};
    m_tree.Query(&query, boxAt(mover, x, y));
  }

  void moved(Object& object) {
    m_tree.MoveProxy(object.handle, boxAt(object, object.x, object.y), b2Vec2_zero);
  }

 private:
  struct Query {
    const b2DynamicTree& tree;
    const Object& mover;
    Real x;
    Real y;
    std::vector<Object*>& out;

    bool QueryCallback(std::int32_t handle) {
      auto* other = static_cast<Object*>(tree.GetUserData(handle));
      if (other != &mover && mover.touches(*other, x, y)) out.push_back(other);
      return true;
    }
  };

  static b2AABB boxAt(const Object& object, Real x, Real y) {
    const b2Vec2 half(object.half_width, object.half_height);
    b2AABB box;
    box.lowerBound = b2Vec2(x, y) - half;
    box.upperBound = b2Vec2(x, y) + half;
    return box;
  }

  b2DynamicTree m_tree;
};

}  // namespace

EnginePtr makeBox2dTree(const Scene& scene) {
  return std::make_unique<PeerWorld<Box2dTree>>(scene, scene.count());
}

}  // namespace bench
