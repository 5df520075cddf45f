#include "physics/body/BodyImpacts.h"

#include <algorithm>
#include <cmath>

namespace df {

namespace {

using naiad::physics::BodyContacts;
using naiad::physics::BodyForm;
using naiad::physics::BodyPlan;
using naiad::physics::BodyRow;
using naiad::physics::BodyTable;
using naiad::physics::ConvexShape;
using naiad::physics::ImpactBody;
using naiad::physics::ImpactEvent;
using naiad::physics::ImpactShape;
using naiad::physics::Metric;
using naiad::physics::Place;
using naiad::physics::Rotation;
using naiad::physics::Vec2;

constexpr int kMaxRounds = 100;  // then nobody looks any farther
constexpr double kRoom = 0.25;   // around what a body reaches by itself, metric cells

Vec2 sizeOf(Vec2 a) {
  return {std::fabs(a.x), std::fabs(a.y)};
}

Vec2 halfOf(const ImpactBody& body) {
  return body.shape == ImpactShape::kCircle ? Vec2{body.half.x, body.half.x} : body.half;
}

// A polygon that is a box along the axes around the origin: its half size.
bool isUpright(const ConvexShape& shape, Vec2& half) {
  if (shape.count != 4 || shape.radius != 0) return false;
  half = sizeOf(shape.vertices[0]);
  for (int i = 0; i < 4; ++i) {
    if (sizeOf(shape.vertices[i]) != half) return false;
  }
  return half.x > 0 && half.y > 0;
}

}  // namespace

bool BodyImpacts::canHave(const BodyForm& form, const Metric& metric, const FixedBox& box, ImpactBody& body,
                          Vec2& offset) {
  offset = {};
  const bool is_round =
      form.shapes.size() == 1 && form.shapes[0].count == 1 && form.shapes[0].vertices[0] == Vec2{};
  if (form.is_turning || form.shapes.size() > 1) return false;
  if (is_round) {
    body.shape = ImpactShape::kCircle;
    body.half = {form.shapes[0].radius, 0};
    return true;
  }
  if (form.rotation != Rotation{} || form.spin != 0) return false;
  body.shape = ImpactShape::kBox;
  if (!form.shapes.empty()) return isUpright(form.shapes[0], body.half);
  body.half = 0.5 * metric.fromCells(Vector::fromFixed(box.size));
  offset = metric.fromCells(Vector::fromFixed(box.corner)) + body.half;
  return true;
}

void BodyImpacts::begin() {
  m_entrants.clear();
  m_plan_of.clear();
  for (Seat& seat : m_seats) seat.is_taken = false;
}

// Only constant accelerations are known there. A path that is none gets one that begins and ends where it
// does, as fast as it does; on something it lies on, one that begins and ends as fast as it does.
void BodyImpacts::adapt(const BodyPlan& plan, const BodyRow& row, ImpactBody& body) {
  body.velocity = plan.start_velocity;
  body.acceleration = plan.push;
  const Seat& seat = m_seats[plan.index];
  if (row.inverse_mass == 0) return;
  if (!plan.is_bent) return;
  body.acceleration = plan.flown.velocity - plan.start_velocity;
  if (seat.id >= 0 && m_world.isTouching(seat.id)) return;
  body.velocity = 2 * plan.flown.displacement - plan.flown.velocity;
  body.acceleration = 2 * (plan.flown.velocity - plan.flown.displacement);
}

bool BodyImpacts::enter(const BodyPlan& plan, const BodyRow& row, ImpactBody body, Vec2 offset) {
  if (plan.index >= m_seats.size()) m_seats.resize(plan.index + 1);
  Seat& seat = m_seats[plan.index];
  if (seat.id >= 0 && seat.order != row.order) {  // the one before is gone
    m_world.remove(seat.id);
    seat = {};
  }
  seat.order = row.order;
  seat.is_taken = true;
  adapt(plan, row, body);
  // What the table was told comes back as it was, without another rounding.
  const bool is_as_told = seat.id >= 0 && seat.row_place == row.place && seat.offset == offset;
  body.place = is_as_told ? seat.world_place : row.place + offset;
  seat.offset = offset;
  body.inverse_mass = row.inverse_mass;
  body.restitution = row.restitution;
  body.friction = row.friction;
  if (!isSound(body)) return seat.is_taken = false;
  m_entrants.push_back({plan.index, body, {}, {}});
  return true;
}

// Those who came and went. Ids are given in the order of construction.
void BodyImpacts::sitDown() {
  for (Seat& seat : m_seats) {
    if (seat.is_taken || seat.id < 0) continue;
    m_world.remove(seat.id);
    seat.id = -1;
  }
  for (const Entrant& entrant : m_entrants) {
    Seat& seat = m_seats[entrant.index];
    if (seat.id < 0) {
      seat.id = m_world.add(entrant.body);
    } else {
      m_world.set(seat.id, entrant.body);
    }
  }
}

void BodyImpacts::know(int id, ObjectKey key, std::uint64_t order, int plan) {
  if (id >= static_cast<int>(m_who.size())) m_who.resize(static_cast<std::size_t>(id) + 1);
  m_who[static_cast<std::size_t>(id)] = {key, order, plan};
}

// What stands where it may get in the time left, `room` times as fast as it is now.
void BodyImpacts::look(World& world, const BodyTable& table, Entrant& entrant, double left, double room) {
  const Seat& seat = m_seats[entrant.index];
  const ImpactBody& body = m_world.body(seat.id);
  const Vec2 half = halfOf(body) + Vec2{kRoom, kRoom} + room * left * sizeOf(body.velocity) +
                    (0.5 * left * left) * sizeOf(body.acceleration);
  const Vec2 away = sizeOf(body.place - entrant.looked) + half;
  if (away.x > entrant.looked_half.x || away.y > entrant.looked_half.y) {
    entrant.looked = body.place;
    entrant.looked_half = half;
    m_found.clear();
    const WorldStore& store = world.store();
    store.touching(regionOf(table.metric, entrant.looked, half), table.row(entrant.index).key.slot, m_found);
    for (const ObjectKey key : m_found) {
      if (BodyObstacles::isOne(store, key)) m_obstacles.note(key);
    }
  }
  m_world.setReach(seat.id, entrant.looked, entrant.looked_half);
}

void BodyImpacts::takeObstacles(World& world, const BodyTable& table, BodyContacts& contacts) {
  const WorldStore& store = world.store();
  for (BodyObstacles::Obstacle& obstacle : m_obstacles.all()) {
    if (!obstacle.is_near) {
      if (obstacle.id >= 0) m_world.remove(obstacle.id);
      contacts.doubt(obstacle.key, naiad::physics::BodyWay::kImpact);
      continue;
    }
    const FixedBox box = store.box(obstacle.key.slot);
    ImpactBody body;
    body.half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
    body.place = table.metric.placeOf(store.position(obstacle.key.slot) + box.corner) + body.half;
    body.inverse_mass = 0;
    body.friction = table.obstacle_friction;
    body.restitution = table.obstacle_restitution;
    if (obstacle.id < 0) {
      obstacle.id = m_world.add(body);
    } else if (!m_world.set(obstacle.id, body)) {  // it has no size any more
      m_world.remove(obstacle.id);
      obstacle.id = -1;
    }
    if (obstacle.id >= 0) know(obstacle.id, obstacle.key, store.order(obstacle.key.slot), -1);
  }
  m_obstacles.forgetFar();
}

void BodyImpacts::step(World& world, const BodyTable& table, std::vector<BodyPlan>& plans,
                       BodyContacts& contacts) {
  m_had_entrants = !m_entrants.empty();
  sitDown();
  m_plan_of.clear();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (plans[i].way == naiad::physics::BodyWay::kImpact) {
      know(m_seats[plans[i].index].id, plans[i].key, plans[i].order, static_cast<int>(i));
      plans[i].is_touched = m_world.isTouching(m_seats[plans[i].index].id);
      m_plan_of.push_back(static_cast<int>(i));
    }
  }
  m_obstacles.begin();
  double done = 0;
  for (int round = 0;; ++round) {
    const double left = 1 - done;
    for (Entrant& entrant : m_entrants) {
      const bool looks = entrant.body.inverse_mass > 0 && round < kMaxRounds;
      if (looks) look(world, table, entrant, left, round == 0 ? 1 : 2);
    }
    takeObstacles(world, table, contacts);
    m_world.step(left);
    collect(done, plans, contacts);
    done += m_world.stepped();
    if (m_world.stepped() == left || done >= 1) break;
  }
  finish(plans);
}

void BodyImpacts::collect(double since, std::vector<BodyPlan>& plans, BodyContacts& contacts) const {
  for (const ImpactEvent& event : m_world.events()) {
    const Who* p_first = &m_who[static_cast<std::size_t>(event.first)];
    const Who* p_second = &m_who[static_cast<std::size_t>(event.second)];
    for (const Who* p_who : {p_first, p_second}) {
      if (p_who->plan < 0) continue;
      BodyPlan& plan = plans[static_cast<std::size_t>(p_who->plan)];
      plan.is_touched = plan.is_struck = true;
    }
    const bool is_swapped = p_first->plan < 0 || (p_second->plan >= 0 && p_second->order < p_first->order);
    if (is_swapped) std::swap(p_first, p_second);
    contacts.add({since + event.time, p_first->key, p_second->key, p_first->order, p_second->order,
                  event.impulse, event.is_begin, naiad::physics::BodyWay::kImpact});
  }
}

void BodyImpacts::finish(std::vector<BodyPlan>& plans) {
  for (const int at : m_plan_of) {
    BodyPlan& plan = plans[static_cast<std::size_t>(at)];
    Seat& seat = m_seats[plan.index];
    const ImpactBody& body = m_world.body(seat.id);
    if (m_world.isFrozen(seat.id)) plan.p_failure = "too many impacts in one tick";
    plan.is_touched = plan.is_touched || m_world.isTouching(seat.id);
    if (!plan.is_touched) {  // exactly as on its own
      plan.place = plan.start + plan.flown.displacement;
      plan.velocity = plan.flown.velocity;
    } else {
      plan.place = seat.offset == Vec2{} ? body.place : body.place + -seat.offset;
      plan.velocity = body.velocity;
      plan.acceleration = m_world.acceleration(seat.id);
    }
    seat.row_place = plan.place;
    seat.world_place = plan.is_touched ? body.place : plan.place + seat.offset;
  }
}

}  // namespace df
