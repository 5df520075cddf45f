// Three peers: Box2D's tree alone, its world as an index of boxes, and its world's Step().
#include <box2d/b2_dynamic_tree.h>
#include <box2d/box2d.h>

#include <vector>

#include "PeerWorld.h"
#include "Peers.h"

namespace bench {
namespace {

using Object = PeerBody<float>;

b2AABB boxAt(const Object& object, float x, float y) {
  const b2Vec2 half(object.half_width, object.half_height);
  b2AABB box;
  box.lowerBound = b2Vec2(x, y) - half;
  box.upperBound = b2Vec2(x, y) + half;
  return box;
}

// Boxes have the tree's default margin of a tenth of a cell. Passing a predicted displacement to MoveProxy
// would save some reinsertions, but make queries slower: with 1/4, 1/2 and the whole velocity, ticks were
// never clearly faster, and up to twice as slow.
class Box2dTree {
 public:
  using Real = float;

  explicit Box2dTree(const Scene& /*scene*/) {}

  void add(Object& object) { object.handle = m_tree.CreateProxy(boxAt(object, object.x, object.y), &object); }

  void touching(const Object& mover, Real x, Real y, std::vector<Object*>& out) {
    Query query{{mover, x, y, out}, m_tree};
    m_tree.Query(&query, boxAt(mover, x, y));
  }

  void moved(Object& object) {
    m_tree.MoveProxy(object.handle, boxAt(object, object.x, object.y), b2Vec2_zero);
  }

 private:
  struct Query : PeerQuery<Real> {
    const b2DynamicTree& tree;
    bool QueryCallback(std::int32_t handle) { return visit(static_cast<Object*>(tree.GetUserData(handle))); }
  };

  b2DynamicTree m_tree;
};

// Static bodies with a box each. Step() is never called, so Box2D never searches for contacts.
class Box2dWorld {
 public:
  using Real = float;

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
    Query query({mover, x, y, out});
    m_world.QueryAABB(&query, boxAt(mover, x, y));
  }

  void moved(Object& object) { static_cast<b2Body*>(object.shape)->SetTransform({object.x, object.y}, 0); }

 private:
  // The world finds boxes by enlarged copies of them, so the query compares the exact boxes.
  class Query final : public b2QueryCallback {
   public:
    explicit Query(const PeerQuery<Real>& query) : m_query(query) {}
    bool ReportFixture(b2Fixture* fixture) override {
      return m_query.visit(reinterpret_cast<Object*>(fixture->GetUserData().pointer));
    }

   private:
    const PeerQuery<Real> m_query;
  };

  b2World m_world;
};

constexpr float kTickLength = 1;  // velocities are per tick
constexpr int kVelocityIterations = 8;
constexpr int kPositionIterations = 3;

// Kinematic bodies, which move by their velocities and are not pushed, like the Objects of these scenes.
class Box2dMotion : public Engine {
 public:
  explicit Box2dMotion(const Scene& scene) : m_world(b2Vec2_zero), m_side(static_cast<float>(scene.side)) {
    m_world.SetAllowSleeping(false);
    m_bodies.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies) {
      b2BodyDef definition;
      definition.type = b2_kinematicBody;
      definition.position.Set(static_cast<float>(body.x), static_cast<float>(body.y));
      definition.linearVelocity.Set(static_cast<float>(body.vx), static_cast<float>(body.vy));
      definition.allowSleep = false;
      m_bodies.push_back(m_world.CreateBody(&definition));
    }
  }

  void tick() override {
    ++m_tally.tick;
    m_world.Step(kTickLength, kVelocityIterations, kPositionIterations);
    for (b2Body* body : m_bodies) {
      const b2Vec2& p = body->GetPosition();
      const bool left_x = !(p.x >= 0 && p.x < m_side);
      const bool left_y = !(p.y >= 0 && p.y < m_side);
      if (left_x || left_y) turnBack(*body, left_x, left_y);
    }
  }

  const Tally& tally() const override { return m_tally; }

  std::uint64_t stateHash() const override {
    StateHash hash;
    for (const b2Body* body : m_bodies) {
      hash.add(body->GetPosition().x);
      hash.add(body->GetPosition().y);
      hash.add(body->GetLinearVelocity().x);
      hash.add(body->GetLinearVelocity().y);
    }
    return hash.value();
  }

 private:
  static void turnBack(b2Body& body, bool left_x, bool left_y) {
    const b2Vec2 v = body.GetLinearVelocity();
    body.SetTransform(body.GetPosition() - v, 0);
    body.SetLinearVelocity({left_x ? -v.x : v.x, left_y ? -v.y : v.y});
  }

  b2World m_world;
  Tally m_tally;
  std::vector<b2Body*> m_bodies;  // owned by the world, by id
  float m_side;
};

}  // namespace

EnginePtr makeBox2dTree(const Scene& scene) {
  return std::make_unique<PeerWorld<Box2dTree>>(scene, scene.count());
}

EnginePtr makeBox2dWorld(const Scene& scene, int turns) {
  return std::make_unique<PeerWorld<Box2dWorld>>(scene, turns);
}

EnginePtr makeBox2dMotion(const Scene& scene) {
  return std::make_unique<Box2dMotion>(scene);
}

}  // namespace bench
