// Groups of circles that bounce, some of them joined: who is struck by whom.
#include <algorithm>
#include <cmath>

#include "physics/body/BodyLinks.h"
#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

bool isBefore(const BodyPlan& a, const BodyPlan& b) {
  return a.order < b.order;
}

}  // namespace

// Are there others than before?
bool BodyLinks::findGuests(const std::vector<BodyPlan>& plans) {
  m_new_guests.clear();
  for (const BodyPlan& plan : plans) {
    if (plan.way == BodyWay::kStruck && !isJoined(plan.index)) m_new_guests.push_back(plan.index);
  }
  if (m_new_guests == m_guests) return false;
  m_guests.swap(m_new_guests);
  return true;
}

void BodyLinks::strike(BodyTable& table, std::vector<BodyPlan>& plans,
                       const std::vector<BodyMeeting>& meetings, BodyContacts& contacts) {
  m_is_moved.assign(m_solver.islands().size(), 0);
  for (std::size_t i = 0; i < meetings.size();) {
    std::size_t end = i + 1;
    while (end < meetings.size() && meetings[end].group == meetings[i].group) ++end;
    if (!strikeGroup(table, plans, std::span(meetings).subspan(i, end - i), contacts)) {
      handOn(meetings[i].group, table, plans, contacts);
    }
    i = end;
  }
}

bool BodyLinks::strikeGroup(const BodyTable& table, std::vector<BodyPlan>& plans,
                            std::span<const BodyMeeting> meetings, BodyContacts& contacts) {
  m_pairs.clear();
  for (const BodyMeeting& meeting : meetings) {
    const BodyPlan &a = plans[at(meeting.a)], &b = plans[at(meeting.b)];
    const BodyRow &row_a = table.row(a.index), &row_b = table.row(b.index);
    JointPair pair;
    pair.a = bodyAt(a.index), pair.b = bodyAt(b.index);
    if (pair.a < 0 || pair.b < 0) return false;
    pair.reach = a.radius + b.radius;
    pair.restitution = std::max(row_a.restitution, row_b.restitution);
    pair.friction = std::sqrt(row_a.friction * row_b.friction);
    m_pairs.push_back(pair);
  }
  if (!m_impacts.step(m_solver, m_bodies, m_joints, m_pairs, 1)) return false;
  for (const BodyMeeting& meeting : meetings) {  // beyond that, nobody has looked who is there
    for (const int i : {meeting.a, meeting.b}) {
      const BodyPlan& plan = plans[at(i)];
      const Vec2 way = m_bodies[at(bodyAt(plan.index))].place - plan.start;
      const bool is_within =
          std::abs(way.x) + plan.radius <= plan.reach.x && std::abs(way.y) + plan.radius <= plan.reach.y;
      if (is_within) continue;
      m_impacts.undo(m_bodies);
      return false;
    }
  }
  for (const int island : m_impacts.islands()) m_is_moved[at(island)] = 1;
  for (const JointImpact& impact : m_impacts.impacts()) {
    BodyPlan& a = plans[at(meetings[at(impact.pair)].a)];
    BodyPlan& b = plans[at(meetings[at(impact.pair)].b)];
    a.is_struck = b.is_struck = true;
    const BodyPlan &first = isBefore(b, a) ? b : a, &second = isBefore(b, a) ? a : b;
    BodyContact contact = {impact.time,  first.key,      second.key, first.order,
                           second.order, impact.impulse, true,       BodyWay::kStruck};
    contacts.add(contact);
    contact.is_begin = false;
    contacts.add(contact);
  }
  return true;
}

// To a RigidWorld.
void BodyLinks::handOn(int group, BodyTable& table, std::vector<BodyPlan>& plans, BodyContacts& contacts) {
  for (BodyPlan& plan : plans) {
    if (plan.way != BodyWay::kStruck || plan.group != group) continue;
    plan.way = BodyWay::kRigid;
    const int body = bodyAt(plan.index), island = body < 0 ? -1 : m_solver.islandOf(body);
    if (island >= 0) m_is_moved[at(island)] = 1;
    auto& last_way = table.row(plan.index).last_way;
    if (last_way == static_cast<std::uint8_t>(BodyWay::kRigid)) continue;
    last_way = static_cast<std::uint8_t>(BodyWay::kRigid);
    contacts.hand(plan.key);
  }
}

}  // namespace naiad::physics
