#include <box2d/box2d.h>

#include "PeerWorld.h"
#include "Peers.h"

namespace bench {

namespace {

// Static bodies with a box each. Step() is never called, so no contacts are ever looked for.
class Box2dWorld {
 public:
  using Real = float;
  using Object = PeerBody<Real>;

  explicit Box2dWorld(const Scene& /*scene*/) : m_world(b2Vec2_zero) {}

  void add(Object& object) {
    b2BodyDef definition;
    definition.position.Set(object.x, object.y);
    b2Body* body = m_world.CreateBody(&definition);
    b2PolygonShape shape;
    shape.SetAsBox(object.half_width, object.half_height);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.userData.pointer = reinterpret_cast<uintptr_t>(&object);
    body->CreateFixture(&fixture);
    object.shape = body;
  }

  void touching(const Object& mover, Real x, Real y, std::vector<Object*>& out) {
    const b2Vec2 half(mover.half_width, mover.half_height);
    b2AABB box;
    box.lowerBound = b2Vec2(x, y) - half;
    box.upperBound = b2Vec2(x, y) + half;
    Query query(mover, x, y, out);
    m_world.QueryAABB(&query, box);
  }

  void moved(Object& object) { static_cast<b2Body*>(object.shape)->SetTransform({object.x, object.y}, 0); }

 private:
  // The world compares boxes that are a little too large; this compares the boxes themselves.
  class Query final : public b2QueryCallback {
   public:
    Query(const Object& mover, Real x, Real y, std::vector<Object*>& out)
        : m_mover(mover), m_x(x), m_y(y), m_out(out) {}
    bool ReportFixture(b2Fixture* fixture) override {
      auto* other = reinterpret_cast<Object*>(fixture->GetUserData().pointer);
      if (other != &m_mover && m_mover.touches(*other, m_x, m_y)) m_out.push_back(other);
      return true;
    }

   private:
    const Object& m_mover;
    Real m_x;
    Real m_y;
    std::vector<Object*>& m_out;
  };

  b2World m_world;
};

}  // namespace

EnginePtr makeBox2dWorld(const Scene& scene, int turns) {
  return std::make_unique<PeerWorld<Box2dWorld>>(scene, turns);
}

}  // namespace bench
