// Contacts of bodies with blocks (BodyObstacles.h). A solver sees a block as one obstacle, but each of its
// Objects begins and ends its own contacts as the body slides over it.
#pragma once

#include <span>
#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyObstacles.h"
#include "physics/geometry/ConvexShape.h"

namespace naiad::physics {

class BlockContacts {
 public:
  struct Pose {
    Place place;
    Rotation rotation;
  };
  /// One of the bodies of a platform (BodyPlatforms.h).
  struct Member {
    ObjectKey key;
    std::uint64_t order = 0;
    BoxArea area;  ///< relative to the platform's base
    double friction = 0;
    friend bool operator==(const Member& a, const Member& b) = default;
  };
  /// A block of Objects, or one of a platform's bodies.
  struct View {
    const BoxUnion::Block* p_shape = nullptr;  ///< null: there is no such block any more
    std::span<const Member> members;           ///< none: Objects of the store
    Place base;                                ///< a platform's place at the end of the tick
    Vec2 velocity;
  };
  /// A body and its motion in this tick.
  struct Mover {
    ObjectKey key;  ///< generation 0: the solver does not move it any more
    std::span<const ConvexShape> shapes;
    Pose start, end;
    Vec2 velocity;  ///< velocity at the start
  };

  bool isEmpty() const { return m_touches.empty(); }
  /// Adds the start or end of the contact of a body with a block. `contact.second` is not used; `body` and
  /// `block` are ids in the solver. Call in order of time.
  void add(const BodyContact& contact, int body, int block);
  /// Finds the Objects that each body touches at the end of the tick or has touched in it, and adds the
  /// contacts that began or ended. moverOf(body) and viewOf(block) return the body and the block with an id.
  template <class MoverOf, class ViewOf>
  void settle(const WorldStore& store, const Metric& metric, BodyContacts& contacts, MoverOf moverOf,
              ViewOf viewOf) {
    for (Touch& touch : m_touches) settle(store, metric, viewOf(touch.block), moverOf(touch.body), touch);
    publish(contacts);
  }

 private:
  struct Part {  // an Object or a body of a platform that a body touches
    ObjectKey key;
    std::uint64_t order;
    bool is_body;
  };
  struct Stretch {  // part of a face, in metric cells along it from the body's place at the end of the tick
    double low = 0, high = 0;
  };
  struct Found {
    Part part;
    Stretch stretch;
  };
  struct Touch {
    BodyContact contact;  // how it began; `second` is not used
    int body, block;
    double begin = 0, end = 2;  // in this tick; an end above 1: the contact lasts
    bool is_new = true;
    int orphaned = 0;  // ticks since the block was replaced by another one
    int side = -1;     // face on which the body lies
    Stretch stretch;   // part of the face that it touches
    Pose pose;         // pose at the end of the last tick
    std::vector<Part> parts;
  };

  void settle(const WorldStore& store, const Metric& metric, const View& view, const Mover& mover,
              Touch& touch);
  void findParts(const WorldStore& store, const Metric& metric, const View& view, int side,
                 const Place& origin, Stretch stretch);
  void change(const Touch& touch, const Part& part, double time, double impulse, bool is_begin);
  bool isHeld(ObjectKey body, ObjectKey part, double time) const;
  void publish(BodyContacts& contacts);

  std::vector<Touch> m_touches;
  std::vector<BodyContact> m_changes;
  std::vector<Found> m_found;
  std::vector<ObjectKey> m_keys;
};

}  // namespace naiad::physics
