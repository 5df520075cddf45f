// Chipmunk 7.0.3 as built by Debian. `substeps` are whole steps of tick / substeps with its 10 iterations.
// Its collision slop is set to Box2D's, because the default would be a tenth of a body in these scenes. Other
// settings are the defaults, with which nothing sleeps.
#include <chipmunk/chipmunk.h>

#include <cmath>
#include <vector>

#include "Method.h"

namespace lab {
namespace {

constexpr double kSlop = 0.005;

cpVect vect(Vec v) {
  return cpv(v.x, v.y);
}

cpBool countContact(cpArbiter*, cpSpace*, cpDataPointer count) {
  ++*static_cast<long*>(count);
  return cpTrue;
}

class Chipmunk : public Simulation {
 public:
  explicit Chipmunk(const Scene& scene)
      : m_space(cpSpaceNew()), m_field(scene.field), m_origin(scene.origin), m_collides(scene.collides) {
    cpSpaceSetGravity(m_space, vect(scene.gravity));
    cpSpaceSetCollisionSlop(m_space, kSlop);
    cpCollisionHandler* handler = cpSpaceAddDefaultCollisionHandler(m_space);
    handler->beginFunc = countContact;
    handler->userData = &m_contacts;
    m_bodies.reserve(scene.bodies.size());
    for (const Body& body : scene.bodies) add(body);
    for (const Joint& joint : scene.joints) add(joint);
  }
  ~Chipmunk() override {
    for (cpConstraint* constraint : m_constraints) {
      cpSpaceRemoveConstraint(m_space, constraint);
      cpConstraintFree(constraint);
    }
    for (cpShape* shape : m_shapes) {
      cpSpaceRemoveShape(m_space, shape);
      cpShapeFree(shape);
    }
    for (cpBody* body : m_bodies) {
      cpSpaceRemoveBody(m_space, body);
      cpBodyFree(body);
    }
    cpSpaceFree(m_space);
  }
  Chipmunk(const Chipmunk&) = delete;
  Chipmunk& operator=(const Chipmunk&) = delete;

  void step(double tick, int substeps) override {
    const double h = tick / substeps;
    for (int i = 0; i < substeps; ++i) {
      if (m_field) push();
      cpSpaceStep(m_space, h);
      m_time += h;
    }
  }

  BodyState body(int index) const override { return stateOf(m_bodies[static_cast<std::size_t>(index)]); }
  long contacts() const override { return m_contacts; }

 private:
  BodyState stateOf(const cpBody* body) const {
    const cpVect p = cpBodyGetPosition(body);
    const cpVect v = cpBodyGetVelocity(body);
    return {{p.x - m_origin.x, p.y - m_origin.y},
            {v.x, v.y},
            cpBodyGetAngle(body),
            cpBodyGetAngularVelocity(body)};
  }

  void add(const Body& body) {
    const double inertia =
        body.rotates && !body.shapes.empty() ? body.mass * inertiaOf(body.shapes.front()) : INFINITY;
    cpBody* made = body.motion == Motion::DYNAMIC     ? cpBodyNew(body.mass, inertia)
                   : body.motion == Motion::KINEMATIC ? cpBodyNewKinematic()
                                                      : cpBodyNewStatic();
    cpSpaceAddBody(m_space, made);
    cpBodySetPosition(made, vect(m_origin + body.position));
    cpBodySetAngle(made, body.angle);
    if (body.motion != Motion::FIXED) {
      cpBodySetVelocity(made, vect(body.velocity));
      cpBodySetAngularVelocity(made, body.spin);
    }
    // Drag is a property of the space: the part of a velocity that is left after a second.
    if (body.linear_drag > 0) cpSpaceSetDamping(m_space, std::exp(-body.linear_drag / body.mass));
    for (const Shape& shape : body.shapes) addShape(made, body, shape);
    m_bodies.push_back(made);
  }

  // Chipmunk uses the product of a pair's two coefficients.
  void addShape(cpBody* made, const Body& body, const Shape& shape) {
    cpShape* its_shape =
        shape.kind == Shape::Kind::CIRCLE
            ? cpCircleShapeNew(made, shape.radius, vect(shape.centre))
            : cpBoxShapeNew2(made, cpBBNewForExtents(vect(shape.centre), shape.half.x, shape.half.y), 0);
    cpShapeSetFriction(its_shape, std::sqrt(body.friction));
    cpShapeSetElasticity(its_shape, std::sqrt(body.restitution));
    if (!m_collides) cpShapeSetFilter(its_shape, CP_SHAPE_FILTER_NONE);
    cpSpaceAddShape(m_space, its_shape);
    m_shapes.push_back(its_shape);
  }

  void add(const Joint& joint) {
    cpBody* a = joint.a < 0 ? cpSpaceGetStaticBody(m_space) : m_bodies[static_cast<std::size_t>(joint.a)];
    cpBody* b = joint.b < 0 ? cpSpaceGetStaticBody(m_space) : m_bodies[static_cast<std::size_t>(joint.b)];
    const cpVect anchor_a = cpBodyWorldToLocal(a, vect(m_origin + joint.anchor_a));
    const cpVect anchor_b = cpBodyWorldToLocal(b, vect(m_origin + joint.anchor_b));
    cpConstraint* constraint =
        joint.kind == Joint::Kind::ROD ? cpPinJointNew(a, b, anchor_a, anchor_b)
        : joint.kind == Joint::Kind::HINGE
            ? cpPivotJointNew2(a, b, anchor_a, anchor_b)
            : cpDampedSpringNew(a, b, anchor_a, anchor_b, joint.rest_length, joint.stiffness, joint.damping);
    cpSpaceAddConstraint(m_space, constraint);
    m_constraints.push_back(constraint);
  }

  void push() {
    for (cpBody* body : m_bodies) {
      if (cpBodyGetType(body) != CP_BODY_TYPE_DYNAMIC) continue;
      cpBodySetForce(body, vect(cpBodyGetMass(body) * m_field(m_time, stateOf(body))));
    }
  }

  cpSpace* m_space;
  Field m_field;
  Vec m_origin;
  bool m_collides;
  double m_time = 0;
  long m_contacts = 0;
  std::vector<cpBody*> m_bodies;  // indexed by scene body
  std::vector<cpShape*> m_shapes;
  std::vector<cpConstraint*> m_constraints;
};

const RegisteredMethod method({"chipmunk", "Chipmunk 7", "7.0.3", Method::Kind::PEER,
                               [](const Scene& scene) -> SimulationPtr {
                                 return scene.rigid() ? std::make_unique<Chipmunk>(scene) : nullptr;
                               }});

}  // namespace
}  // namespace lab
