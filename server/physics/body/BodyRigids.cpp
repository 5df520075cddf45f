#include "physics/body/BodyRigids.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/geometry/Index.h"

namespace df {

namespace {

using naiad::physics::at;
using naiad::physics::BodyContact;
using naiad::physics::BodyContacts;
using naiad::physics::BodyForm;
using naiad::physics::BodyJoints;
using naiad::physics::BodyPlan;
using naiad::physics::BodyRow;
using naiad::physics::BodyTable;
using naiad::physics::BodyWay;
using naiad::physics::ConvexShape;
using naiad::physics::RigidBody;
using naiad::physics::RigidEvent;
using naiad::physics::ShapeStatus;
using naiad::physics::Vec2;
using RawJoint = naiad::physics::Joint;

bool takesPart(const BodyPlan& plan) {
  return plan.way == BodyWay::kRigid || plan.is_near_rigid;
}

}  // namespace

int BodyRigids::rigidOf(int row) const {
  if (row < 0 || row >= static_cast<int>(m_seats.size())) return -1;
  return m_seats[at(row)].is_taken ? m_seats[at(row)].id : -1;
}

void BodyRigids::know(int id, ObjectKey key, std::uint64_t order, int plan) {
  if (id >= static_cast<int>(m_who.size())) m_who.resize(at(id) + 1);
  m_who[at(id)] = {key, order, plan};
}

// What it looks like to the others: nothing, unless it is HARD.
void BodyRigids::shape(Seat& seat, const BodyTable& table, const BodyPlan& plan, const FixedBox& box,
                       const RigidBody& body) {
  const BodyForm& form = table.form(plan.index);
  const bool is_box = form.shapes.empty();
  const std::uint32_t version = plan.is_hard ? form.version + 1 : 0;
  if (seat.id >= 0 && seat.version == version && (!is_box || seat.box == box)) return;
  m_shapes.clear();
  if (plan.is_hard && !is_box) m_shapes = form.shapes;
  if (plan.is_hard && is_box) {
    const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
    const Vec2 centre = table.metric.fromCells(Vector::fromFixed(box.corner)) + half;
    ConvexShape made;
    if (makeBox(half.x, half.y, centre, {}, 0, made) == ShapeStatus::kOk) m_shapes.push_back(made);
  }
  seat.version = version;
  seat.box = box;
  if (seat.id < 0) {
    seat.id = m_world.add(body, m_shapes);
  } else {
    m_world.setShapes(seat.id, m_shapes);
  }
}

void BodyRigids::sitDown(const WorldStore& store, const BodyTable& table, const std::vector<BodyPlan>& plans,
                         const std::vector<double>& unit_inertias) {
  for (Seat& seat : m_seats) seat.is_taken = false;
  for (const BodyPlan& plan : plans) {
    if (!takesPart(plan)) continue;
    if (plan.index >= m_seats.size()) m_seats.resize(plan.index + 1);
    Seat& seat = m_seats[plan.index];
    const std::uint64_t order = table.row(plan.index).order;
    if (seat.id >= 0 && seat.order != order) {  // the one before is gone
      m_world.remove(seat.id);
      seat.id = -1;
    }
    seat.order = order;
    seat.is_taken = true;
  }
  for (Seat& seat : m_seats) {
    if (seat.is_taken || seat.id < 0) continue;
    m_world.remove(seat.id);
    seat.id = -1;
  }
  m_count = 0;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const BodyPlan& plan = plans[i];
    if (!takesPart(plan)) continue;
    const BodyRow& row = table.row(plan.index);
    const BodyForm& form = table.form(plan.index);
    RigidBody body;
    body.place = row.place;
    body.velocity = row.velocity;
    body.rotation = form.rotation;
    body.spin = form.spin;
    body.inverse_mass = row.inverse_mass;
    body.inverse_inertia = unit_inertias[i] > 0 ? row.inverse_mass / unit_inertias[i] : 0;
    if (!plan.is_kinematic) body.acceleration = plan.is_bent ? plan.flown.velocity - row.velocity : plan.push;
    body.torque = form.torque;
    body.friction = row.friction;
    body.restitution = row.restitution;
    Seat& seat = m_seats[plan.index];
    shape(seat, table, plan, store.box(plan.key.slot), body);
    if (seat.id < 0) continue;
    m_world.set(seat.id, body);
    know(seat.id, plan.key, plan.order, static_cast<int>(i));
    ++m_count;
  }
}

// Who is hit by somebody faster may get as far as he.
void BodyRigids::takeObstacles(const WorldStore& store, const BodyTable& table,
                               const std::vector<BodyPlan>& plans, BodyContacts& contacts) {
  m_obstacles.begin();
  m_surroundings.begin();
  Vec2 fastest;
  for (const BodyPlan& plan : plans) {
    if (plan.way != BodyWay::kRigid) continue;
    fastest = {std::max(fastest.x, std::fabs(plan.start_velocity.x)),
               std::max(fastest.y, std::fabs(plan.start_velocity.y))};
  }
  for (const BodyPlan& plan : plans) {
    if (plan.way != BodyWay::kRigid || !plan.is_hard) continue;
    m_surroundings.ask(regionOf(table.metric, plan.start, plan.reach + fastest));
  }
  m_surroundings.answer(store, [&](std::size_t /*number*/, ObjectKey key) {
    if (BodyObstacles::isOne(store, key)) m_obstacles.note(key);
  });
  for (BodyObstacles::Obstacle& obstacle : m_obstacles.all()) {
    if (!obstacle.is_near) {
      if (obstacle.id >= 0) m_world.remove(obstacle.id);
      contacts.doubt(obstacle.key, BodyWay::kRigid);
      continue;
    }
    const std::uint32_t slot = obstacle.key.slot;
    const FixedBox box = store.box(slot);
    const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
    RigidBody body;
    body.place = table.metric.placeOf(store.position(slot) + box.corner) + half;
    body.inverse_mass = 0;
    body.friction = table.obstacle_friction;
    body.restitution = table.obstacle_restitution;
    const bool is_known = obstacle.id >= 0;
    if (is_known && m_obstacle_boxes[at(obstacle.id)].size == box.size) {
      m_world.set(obstacle.id, body);
    } else {
      if (is_known) m_world.remove(obstacle.id);
      obstacle.id = -1;
      ConvexShape made;
      if (makeBox(half.x, half.y, {}, {}, 0, made) != ShapeStatus::kOk) continue;
      obstacle.id = m_world.add(body, made);
      if (obstacle.id < 0) continue;
      if (at(obstacle.id) >= m_obstacle_boxes.size()) m_obstacle_boxes.resize(at(obstacle.id) + 1);
      m_obstacle_boxes[at(obstacle.id)] = box;
    }
    know(obstacle.id, obstacle.key, store.order(slot), -1);
  }
  m_obstacles.forgetFar();
}

// A joint is here if one of its bodies is.
void BodyRigids::takeJoints(const BodyTable& table) {
  const std::vector<naiad::physics::JointEntry>& entries = table.joints.entries();
  if (m_joint_seats.size() < entries.size()) m_joint_seats.resize(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const naiad::physics::JointEntry& entry = entries[i];
    JointSeat& seat = m_joint_seats[i];
    const int a = rigidOf(entry.joint.a), b = rigidOf(entry.joint.b);
    const bool is_world_a = entry.joint.a == BodyJoints::kWorld;
    const bool is_world_b = entry.joint.b == BodyJoints::kWorld;
    const bool is_here = entry.used && (a >= 0 || is_world_a) && (b >= 0 || is_world_b);
    if (seat.id >= 0 && (!is_here || seat.generation != entry.generation || !m_world.jointExists(seat.id))) {
      m_world.removeJoint(seat.id);
      if (seat.anchor >= 0) m_world.remove(seat.anchor);
      seat = {};
    }
    if (!is_here) continue;
    RawJoint joint = entry.joint;
    if (seat.id < 0 && (is_world_a || is_world_b)) {
      RigidBody anchor;
      anchor.place = entry.anchor;
      anchor.inverse_mass = 0;
      seat.anchor = m_world.add(anchor, std::span<const ConvexShape>());
    }
    joint.a = is_world_a ? seat.anchor : a;
    joint.b = is_world_b ? seat.anchor : b;
    if (seat.id < 0) {
      seat.id = m_world.addJoint(joint);
    } else if (seat.tunings != entry.tunings) {
      m_world.setJoint(seat.id, joint);
    }
    seat.generation = entry.generation;
    seat.tunings = entry.tunings;
  }
}

void BodyRigids::step(const WorldStore& store, BodyTable& table, std::vector<BodyPlan>& plans,
                      const std::vector<double>& unit_inertias, BodyContacts& contacts) {
  sitDown(store, table, plans, unit_inertias);
  takeObstacles(store, table, plans, contacts);
  takeJoints(table);
  if (m_count == 0) return;
  for (BodyPlan& plan : plans) {
    if (plan.way == BodyWay::kRigid) plan.is_touched = contacts.isTouching(plan.key);
  }
  m_world.step(1);
  collect(plans, contacts);
  finish(table, plans, contacts);
}

void BodyRigids::collect(std::vector<BodyPlan>& plans, BodyContacts& contacts) const {
  for (const RigidEvent& event : m_world.events()) {
    const Who* p_first = &m_who[at(event.first)];
    const Who* p_second = &m_who[at(event.second)];
    for (const Who* p_who : {p_first, p_second}) {
      if (p_who->plan >= 0) plans[at(p_who->plan)].is_touched = plans[at(p_who->plan)].is_struck = true;
    }
    const bool is_swapped = p_first->plan < 0 || (p_second->plan >= 0 && p_second->order < p_first->order);
    if (is_swapped) std::swap(p_first, p_second);
    contacts.add({event.time, p_first->key, p_second->key, p_first->order, p_second->order, event.impulse,
                  event.is_begin, BodyWay::kRigid});
  }
}

void BodyRigids::finish(BodyTable& table, std::vector<BodyPlan>& plans, const BodyContacts& contacts) {
  for (BodyPlan& plan : plans) {
    if (plan.way != BodyWay::kRigid) continue;
    const Seat& seat = m_seats[plan.index];
    if (seat.id < 0) {
      plan.p_failure = "its numbers are beyond what can be calculated with";
      continue;
    }
    if (m_world.isFrozen(seat.id)) plan.p_failure = "what happens to it cannot be worked out";
    const RigidBody& body = m_world.body(seat.id);
    const Vec2 pushed = body.velocity - (plan.start_velocity + body.acceleration);
    const double rounding = 1e-9 * (length(plan.start_velocity) + length(body.acceleration));
    const bool is_touched = plan.is_touched || plan.is_joined || contacts.isTouching(plan.key);
    if (!is_touched && length(pushed) <= rounding) {  // exactly as on its own
      plan.place = plan.start + plan.flown.displacement;
      plan.velocity = plan.flown.velocity;
      continue;
    }
    plan.turns_alone = false;
    plan.place = body.place;
    plan.velocity = body.velocity;
    plan.rotation = body.rotation;
    plan.spin = body.spin;
    const bool is_still = body.velocity == Vec2{} && body.spin == 0;
    if (is_still) {
      plan.acceleration = {};
    } else if (!plan.is_struck) {
      plan.acceleration = body.velocity - plan.start_velocity;
    }
  }
  const std::vector<naiad::physics::JointEntry>& entries = std::as_const(table).joints.entries();
  for (std::size_t i = 0; i < m_joint_seats.size() && i < entries.size(); ++i) {
    const JointSeat& seat = m_joint_seats[i];
    if (seat.id < 0 || !entries[i].used || entries[i].generation != seat.generation) continue;
    const RawJoint& joint = m_world.joint(seat.id);
    naiad::physics::JointEntry& entry = table.joints.entries()[i];
    entry.joint.force = joint.force;
    entry.joint.torque = joint.torque;
    if (joint.is_broken) table.joints.remove({static_cast<std::uint32_t>(i), seat.generation});
  }
}

}  // namespace df
