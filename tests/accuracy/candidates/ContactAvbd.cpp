// Augmented vertex block descent: minimizes, body by body, the energy of inertia and of stiff springs with
// multipliers (Giles, Diaz, Yuksel 2025, with the parameters of the authors' plane demonstration; ten
// iterations per step). A sub-step is a step of the method, with contacts found again.
#include <algorithm>
#include <array>
#include <cmath>

#include "ContactScene.h"
#include "physics/geometry/Index.h"

namespace lab {
namespace {

constexpr int kIterations = 10;
constexpr double kRamp = 1e5;    // β: growth of penalties with the remaining error
constexpr double kKept = 0.99;   // α: part of an initial error that is not corrected in this step
constexpr double kDecay = 0.99;  // γ: decay of multipliers and penalties from step to step
constexpr double kMinPenalty = 1e3;
constexpr double kMaxPenalty = 1e9;
constexpr double kMargin = 5e-4;    // overlap of resting contacts, in metres
constexpr double kSticking = 0.01;  // m; a contact with less slip sticks

using naiad::physics::at;
using Row = std::array<double, 3>;  // components x, y, angle

double along(const Row& row, const Row& way) {
  return row[0] * way[0] + row[1] * way[1] + row[2] * way[2];
}

// One direction of a contact point.
struct Constraint {
  Row by_a, by_b;
  double start = 0;  // value at the start of the step
  double penalty = 0, force = 0;
  double value = 0;
};

struct Contact {
  int a = 0, b = 0;
  double friction = 0;
  Constraint normal, tangent;
  ContactPoint* p_point = nullptr;
};

struct Moving {
  std::vector<int> contacts;
  Vec2 start, aim;  // position at the start of the step, and at its end without contacts
  double start_angle = 0, aim_angle = 0;
  Vec2 last_velocity;
};

class Avbd : public ContactSolver {
 public:
  void step(ContactScene& scene, double tick, int substeps) override {
    m_bodies.resize(scene.bodies.size());
    for (int i = 0; i < substeps; ++i) substep(scene, tick / substeps);
  }

 private:
  void substep(ContactScene& scene, double h) {
    scene.find(0, 0);
    collect(scene);
    begin(scene, h);
    for (int i = 0; i < kIterations; ++i) {
      for (std::size_t body = 0; body < m_bodies.size(); ++body) {
        if (scene.bodies[body].isPushed()) descend(scene, static_cast<int>(body), h);
      }
      for (Contact& contact : m_contacts) ascend(scene, contact);
    }
    for (std::size_t i = 0; i < m_bodies.size(); ++i) {
      ContactBody& body = scene.bodies[i];
      m_bodies[i].last_velocity = body.velocity;
      if (!body.isPushed()) continue;
      body.velocity = (body.position - m_bodies[i].start) / h;
      body.spin = (body.angle - m_bodies[i].start_angle) / h;
    }
    for (const Contact& contact : m_contacts) {
      ContactPoint& point = *contact.p_point;
      point.normal_impulse = contact.normal.force;
      point.tangent_impulse = contact.tangent.force;
      point.normal_penalty = contact.normal.penalty;
      point.tangent_penalty = contact.tangent.penalty;
      point.sticks = std::abs(contact.tangent.force) < contact.friction * -contact.normal.force &&
                     std::abs(contact.tangent.start) < kSticking;
    }
  }

  void collect(ContactScene& scene) {
    m_contacts.clear();
    for (Moving& body : m_bodies) body.contacts.clear();
    for (ContactPair& pair : scene.pairs) {
      const Vec2 tangent = naiad::physics::perpendicular(pair.normal);
      for (ContactPoint& point : pair.used()) {
        const ContactArms arms = armsOf(scene, pair, point);
        const Vec2 between =
            (scene.bodies[at(pair.b)].position + arms.b) - (scene.bodies[at(pair.a)].position + arms.a);
        Contact contact;
        contact.a = pair.a;
        contact.b = pair.b;
        contact.friction = pair.friction;
        contact.p_point = &point;
        // The anchors of a sticking contact may have moved along the normal, but the gap found now counts.
        contact.normal = {rowOf(-pair.normal, arms.a),
                          rowOf(pair.normal, arms.b),
                          point.gap + kMargin,
                          std::clamp(point.normal_penalty * kDecay, kMinPenalty, kMaxPenalty),
                          point.normal_impulse * kKept * kDecay,
                          0};
        contact.tangent = {rowOf(-tangent, arms.a),
                           rowOf(tangent, arms.b),
                           dot(between, tangent),
                           std::clamp(point.tangent_penalty * kDecay, kMinPenalty, kMaxPenalty),
                           point.tangent_impulse * kKept * kDecay,
                           0};
        m_bodies[at(pair.a)].contacts.push_back(static_cast<int>(m_contacts.size()));
        m_bodies[at(pair.b)].contacts.push_back(static_cast<int>(m_contacts.size()));
        m_contacts.push_back(contact);
      }
    }
  }

  static Row rowOf(Vec2 direction, Vec2 arm) { return {direction.x, direction.y, cross(arm, direction)}; }

  // Places the bodies where the last step's acceleration would move them, limited to at most gravity.
  void begin(ContactScene& scene, double h) {
    for (std::size_t i = 0; i < m_bodies.size(); ++i) {
      ContactBody& body = scene.bodies[i];
      Moving& moving = m_bodies[i];
      moving.start = body.position;
      moving.start_angle = body.angle;
      const Vec2 velocity = body.velocity / (1 + h * body.drag);
      moving.aim = body.position + h * velocity + h * h * body.gravity;
      moving.aim_angle = body.angle + h * body.spin;
      double part = 0;
      if (body.isPushed() && scene.gravity > 0) {
        const Vec2 acceleration = (body.velocity - moving.last_velocity) / h;
        part = std::clamp(dot(acceleration, body.gravity) / (scene.gravity * scene.gravity), 0.0, 1.0);
      }
      body.position += h * velocity + part * h * h * body.gravity;
      body.turnBy(h * body.spin);
    }
  }

  Row wayOf(const ContactScene& scene, int body) const {
    const ContactBody& now = scene.bodies[at(body)];
    const Moving& moving = m_bodies[at(body)];
    return {now.position.x - moving.start.x, now.position.y - moving.start.y, now.angle - moving.start_angle};
  }

  void evaluate(const ContactScene& scene, Contact& contact) const {
    const Row way_a = wayOf(scene, contact.a), way_b = wayOf(scene, contact.b);
    for (Constraint* p : {&contact.normal, &contact.tangent}) {
      p->value = p->start * (1 - kKept) + along(p->by_a, way_a) + along(p->by_b, way_b);
    }
  }

  // Returns the normal force. A push is negative, because opening the gap lowers the energy.
  static double pushOf(const Contact& contact) {
    return std::min(contact.normal.penalty * contact.normal.value + contact.normal.force, 0.0);
  }
  static double gripOf(const Contact& contact) {
    const double most = contact.friction * std::abs(contact.normal.force);
    return std::clamp(contact.tangent.penalty * contact.tangent.value + contact.tangent.force, -most, most);
  }

  void descend(ContactScene& scene, int index, double h) {
    ContactBody& body = scene.bodies[at(index)];
    const Moving& moving = m_bodies[at(index)];
    const double mass = 1 / (body.inverse_mass * h * h);
    const bool turns = body.inverse_inertia > 0;
    const double inertia = turns ? 1 / (body.inverse_inertia * h * h) : 1;
    double matrix[3][3] = {{mass, 0, 0}, {0, mass, 0}, {0, 0, inertia}};
    double side[3] = {mass * (body.position.x - moving.aim.x), mass * (body.position.y - moving.aim.y),
                      turns ? inertia * (body.angle - moving.aim_angle) : 0};
    for (const int i : moving.contacts) {
      Contact& contact = m_contacts[at(i)];
      evaluate(scene, contact);
      const bool is_a = contact.a == index;
      add(matrix, side, is_a ? contact.normal.by_a : contact.normal.by_b, pushOf(contact),
          contact.normal.penalty, turns);
      add(matrix, side, is_a ? contact.tangent.by_a : contact.tangent.by_b, gripOf(contact),
          contact.tangent.penalty, turns);
    }
    const Row change = solve(matrix, side);
    body.position -= Vec2{change[0], change[1]};
    body.turnBy(-change[2]);
  }

  static void add(double (&matrix)[3][3], double (&side)[3], Row row, double force, double penalty,
                  bool turns) {
    if (!turns) row[2] = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      side[i] += row[i] * force;
      for (std::size_t k = 0; k < 3; ++k) matrix[i][k] += penalty * row[i] * row[k];
    }
  }

  // Solves a symmetric, positive definite system.
  static Row solve(const double (&m)[3][3], const double (&b)[3]) {
    const double d0 = m[0][0], l10 = m[1][0] / d0, l20 = m[2][0] / d0;
    const double d1 = m[1][1] - l10 * m[1][0], l21 = (m[2][1] - l20 * m[1][0]) / d1;
    const double d2 = m[2][2] - l20 * m[2][0] - l21 * l21 * d1;
    const double y0 = b[0], y1 = b[1] - l10 * y0, y2 = b[2] - l20 * y0 - l21 * y1;
    const double z = y2 / d2, y = y1 / d1 - l21 * z;
    return {y0 / d0 - l10 * y - l20 * z, y, z};
  }

  void ascend(const ContactScene& scene, Contact& contact) {
    evaluate(scene, contact);
    const double most = contact.friction * std::abs(contact.normal.force);
    contact.normal.force = pushOf(contact);
    contact.tangent.force =
        std::clamp(contact.tangent.penalty * contact.tangent.value + contact.tangent.force, -most, most);
    if (contact.normal.force < 0) grow(contact.normal);
    if (std::abs(contact.tangent.force) < most) grow(contact.tangent);
  }
  static void grow(Constraint& constraint) {
    constraint.penalty = std::min(constraint.penalty + kRamp * std::abs(constraint.value), kMaxPenalty);
  }

  std::vector<Moving> m_bodies;
  std::vector<Contact> m_contacts;
};

const RegisteredMethod method({"avbd", "AVBD", "1", Method::Kind::CANDIDATE, makeContacts<Avbd>});

}  // namespace
}  // namespace lab
