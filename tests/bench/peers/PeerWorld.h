// The workload's tick with a peer's spatial index. Objects move in the order of WM.update(). Work that a
// careful programmer would avoid is left out: objects at rest are skipped, the list of hits is reused, and
// objects that would leave the world are not moved out and back.
//
// An Index has a number type `Real`, a constructor from Scene&, and
//   void add(PeerBody<Real>&)            a solid body enters;
//   void touching(const PeerBody<Real>& mover, Real x, Real y, std::vector<PeerBody<Real>*>& out)
//                                        all solid bodies but the mover that touch it at (x, y), in any
//                                        order;
//   void moved(PeerBody<Real>&)          its x and y have changed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "Engine.h"
#include "Scene.h"

namespace bench {

/// An object in a game that uses a peer: position and velocity in the library's number type, and a virtual
/// handler for collisions, like an Object's eventHandler.
template <class Real>
struct PeerBody {
  struct Collision {
    PeerBody* mover;
    PeerBody* other;
    Real x;  ///< x of the mover's target
    Real y;
  };

  PeerBody(const Body& body, std::uint32_t its_id, Tally& its_tally)
      : x(static_cast<Real>(body.x)),
        y(static_cast<Real>(body.y)),
        vx(static_cast<Real>(body.vx)),
        vy(static_cast<Real>(body.vy)),
        half_width(static_cast<Real>(body.width) / 2),
        half_height(static_cast<Real>(body.height) / 2),
        id(its_id),
        solidness(body.solidness),
        tally(its_tally) {}
  virtual ~PeerBody() = default;

  virtual void onCollision(const Collision& collision) {
    tally.event(id);
    if (collision.mover != this || !blocks(*collision.other) || turned == tally.tick) return;
    turned = tally.tick;
    ++tally.blocked;
    vx = -vx;
    vy = -vy;
  }

  bool isSolid() const { return solidness != df::SPECTRAL; }
  bool blocks(const PeerBody& other) const { return solidness == df::HARD && other.solidness == df::HARD; }
  /// True if the two boxes would touch if this one was at (at_x, at_y).
  bool touches(const PeerBody& other, Real at_x, Real at_y) const {
    return std::abs(other.x - at_x) <= half_width + other.half_width &&
           std::abs(other.y - at_y) <= half_height + other.half_height;
  }

  Real x;
  Real y;
  Real vx;
  Real vy;
  Real half_width;
  Real half_height;
  std::uint32_t id;
  std::int32_t handle = 0;  ///< this object in a library with numeric handles
  void* shape = nullptr;    ///< this object in a library with pointers
  df::Solidness solidness;
  std::uint64_t turned = 0;  ///< last tick in which this object was blocked
  Tally& tally;
};

/// A question of an Index to its library: which bodies would touch the mover at (x, y)?
template <class Real>
struct PeerQuery {
  const PeerBody<Real>& mover;
  Real x;
  Real y;
  std::vector<PeerBody<Real>*>& out;

  bool visit(PeerBody<Real>* other) const {
    if (other != &mover && mover.touches(*other, x, y)) out.push_back(other);
    return true;
  }
};

template <class Index>
class PeerWorld : public Engine {
 public:
  using Real = typename Index::Real;
  using Object = PeerBody<Real>;

  /// `turns` is the number of objects that move in each tick(). If that is less than all, they are evenly
  /// spaced among all.
  template <class... Arguments>
  explicit PeerWorld(const Scene& scene, int turns, Arguments... arguments)
      : m_index(scene, arguments...),
        m_side(static_cast<Real>(scene.side)),
        m_turns(static_cast<std::size_t>(turns)) {
    m_objects.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies) {
      const auto id = static_cast<std::uint32_t>(m_objects.size());
      Object& object = *m_objects.emplace_back(std::make_unique<Object>(body, id, m_tally));
      if (object.isSolid()) m_index.add(object);
      if (body.moves()) m_movers.push_back(&object);
    }
  }

  void tick() override {
    ++m_tally.tick;
    if (m_turns >= m_movers.size()) {
      for (Object* object : m_movers) turn(*object);
      return;
    }
    const std::size_t distance = m_movers.size() / m_turns;
    const std::size_t first = m_tally.tick % distance;
    for (std::size_t i = 0; i < m_turns; ++i) turn(*m_movers[first + i * distance]);
  }

  const Tally& tally() const override { return m_tally; }
  double partOfTick() const override {
    return m_turns >= m_movers.size() ? 1
                                      : static_cast<double>(m_turns) / static_cast<double>(m_movers.size());
  }

  std::uint64_t stateHash() const override {
    StateHash hash;
    for (const auto& object : m_objects) {
      for (const Real number : {object->x, object->y, object->vx, object->vy}) hash.add(number);
    }
    return hash.value();
  }

 private:
  void turn(Object& mover) {
    const Real x = mover.x + mover.vx;
    const Real y = mover.y + mover.vy;
    if (mover.isSolid()) {
      m_hits.clear();
      m_index.touching(mover, x, y, m_hits);
      if (!m_hits.empty() && !collide(mover, x, y)) return;
    }
    const bool leaves_x = !(x >= 0 && x < m_side);
    const bool leaves_y = !(y >= 0 && y < m_side);
    if (leaves_x || leaves_y) {
      if (leaves_x) mover.vx = -mover.vx;
      if (leaves_y) mover.vy = -mover.vy;
      return;
    }
    mover.x = x;
    mover.y = y;
    if (mover.isSolid()) m_index.moved(mover);
  }

  // Returns true if the mover may move.
  bool collide(Object& mover, Real x, Real y) {
    if (m_hits.size() > 1) {
      std::sort(m_hits.begin(), m_hits.end(), [](const Object* a, const Object* b) { return a->id < b->id; });
    }
    bool free = true;
    for (Object* other : m_hits) {
      const typename Object::Collision collision{&mover, other, x, y};
      mover.onCollision(collision);
      other->onCollision(collision);
      if (mover.blocks(*other)) free = false;
    }
    return free;
  }

  Tally m_tally;
  std::vector<std::unique_ptr<Object>> m_objects;  // by id; outlives the index, which points to them
  std::vector<Object*> m_movers;
  std::vector<Object*> m_hits;
  Index m_index;
  Real m_side;
  std::size_t m_turns;
};

}  // namespace bench
