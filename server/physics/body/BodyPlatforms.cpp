#include "physics/body/BodyPlatforms.h"

#include <algorithm>
#include <tuple>

#include "engine/world/WorldStore.h"
#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr int kMostInGroup = 512;  // bodies that move together; more are not merged

// True if the body has the shape of its Object's box, and does not turn.
bool isUpright(const BodyGeometry& form) {
  return form.rotation == Rotation{} && form.spin == 0 && form.torque == 0 && form.shapes.size() <= 1;
}

// Sets the body's box relative to its place. Returns false if it has another shape.
bool boxOf(const Metric& metric, const BodyGeometry& form, const FixedBox& box, FixedBox& own) {
  own = box;
  if (form.shapes.empty()) return true;
  const ConvexShape& shape = form.shapes[0];
  if (shape.count != 4 || shape.radius != 0) return false;
  Vec2 low = shape.vertices[0], high = low;
  for (std::size_t i = 1; i < 4; ++i) {
    low = {std::min(low.x, shape.vertices[i].x), std::min(low.y, shape.vertices[i].y)};
    high = {std::max(high.x, shape.vertices[i].x), std::max(high.y, shape.vertices[i].y)};
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec2 v = shape.vertices[i];
    if ((v.x != low.x && v.x != high.x) || (v.y != low.y && v.y != high.y)) return false;
  }
  const auto corner = toFixed(metric.toCells(low), kMaxVelocityCells),
             end = toFixed(metric.toCells(high), kMaxVelocityCells);
  if (!corner || !end) return false;
  own = {*corner, *end - *corner};
  return true;
}

}  // namespace

void BodyPlatforms::find(const WorldStore& store, const BodyTable& table, std::vector<BodyState>& states) {
  m_found.clear();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BodyState& state = states[i];
    if (state.is_kinematic && state.is_hard && !state.has_joints && state.p_failure == nullptr &&
        isUpright(table.form(state.index)))
      m_found.push_back(static_cast<int>(i));
  }
  m_platforms.swap(m_platforms_before);
  m_members.swap(m_members_before);
  m_groups.swap(m_groups_before);
  m_platforms.clear();
  m_groups.clear();
  m_members.clear();
  m_states_of.clear();
  if (m_found.size() < 2) return;
  const auto motionOf = [&](int i) {
    const BodyRow& row = table.row(states[at(i)].index);
    return std::tuple(row.velocity.x, row.velocity.y, row.restitution);
  };
  std::stable_sort(m_found.begin(), m_found.end(), [&](int a, int b) { return motionOf(a) < motionOf(b); });
  for (std::size_t i = 0, end = 0; i < m_found.size(); i = end) {
    const int first = static_cast<int>(m_members.size());
    const FixedVector origin = store.position(states[at(m_found[i])].key.slot);
    for (end = i; end < m_found.size() && motionOf(m_found[end]) == motionOf(m_found[i]); ++end) {
      const BodyState& state = states[at(m_found[end])];
      FixedBox box;
      if (!boxOf(table.metric, table.form(state.index), store.box(state.key.slot), box)) continue;
      const FixedVector position = store.position(state.key.slot);
      m_members.push_back({state.key, state.order, BoxArea::of(translate(box, position - origin)),
                           table.row(state.index).friction});
      m_states_of.push_back(m_found[end]);
    }
    const int last = static_cast<int>(m_members.size());
    if (last - first >= 2 && last - first <= kMostInGroup) addGroup(states, {first, last});
  }
}

bool BodyPlatforms::hasPart(const Platform& platform, const Member& member) {
  const BoxArea &area = member.area, &whole = platform.shape.whole;
  return area.low[0] < whole.high[0] && whole.low[0] < area.high[0] && area.low[1] < whole.high[1] &&
         whole.low[1] < area.high[1];
}

void BodyPlatforms::addGroup(std::vector<BodyState>& states, Group group) {
  const std::size_t before = m_platforms.size();
  if (!findAgain(group)) search(group);
  group.platforms = m_platforms.size() - before;
  m_groups.push_back(group);
  for (std::size_t i = before; i < m_platforms.size(); ++i) {
    Platform& platform = m_platforms[i];
    platform.first = group.first, platform.last = group.last;
    for (int k = group.first; k < group.last; ++k) {
      if (hasPart(platform, m_members[at(k)])) states[at(m_states_of[at(k)])].is_merged = true;
    }
  }
}

// Copies the platforms of the last tick if the group's bodies have their relative positions of then.
bool BodyPlatforms::findAgain(Group& group) {
  std::size_t first = 0;
  for (const Group& old : m_groups_before) {
    const auto isSame = [&] {
      return old.last - old.first == group.last - group.first &&
             std::equal(m_members_before.begin() + old.first, m_members_before.begin() + old.last,
                        m_members.begin() + group.first);
    };
    if (m_members_before[at(old.first)].key == m_members[at(group.first)].key && isSame()) {
      for (std::size_t i = 0; i < old.platforms; ++i) m_platforms.push_back(m_platforms_before[first + i]);
      return true;
    }
    first += old.platforms;
  }
  return false;
}

void BodyPlatforms::search(Group& group) {
  m_areas.clear();
  for (int i = group.first; i < group.last; ++i) m_areas.push_back(m_members[at(i)].area);
  m_union.setList(m_areas);
  const auto before = static_cast<std::ptrdiff_t>(m_platforms.size());
  for (std::size_t i = 0; i < m_areas.size(); ++i) {
    const BoxArea& area = m_areas[i];
    if (m_union.look(area) == 1) continue;
    std::array<bool, kBoxSides> is_hidden = {};
    for (int side = 0; side < kBoxSides; ++side) is_hidden[at(side)] = m_union.isHidden(area, side);
    for (int side = 0; side < kBoxSides; ++side) {
      const std::size_t along = BoxArea::alongOf(side);
      const auto hasSide = [&](const Platform& platform) {
        const BoxArea& whole = platform.shape.whole;
        return platform.shape.is_complete[at(side)] && whole.line(side) == area.line(side) &&
               whole.low[along] <= area.low[along] && whole.high[along] >= area.high[along];
      };
      if (is_hidden[at(side)] || std::any_of(m_platforms.begin() + before, m_platforms.end(), hasSide))
        continue;
      Platform& platform = m_platforms.emplace_back();
      platform.shape = m_union.blockAt(area, side, area.low[along], area.high[along]);
      platform.serial = ++m_serial;
      platform.order = m_members[at(group.first) + i].order;
      platform.side = side;
    }
  }
}

}  // namespace naiad::physics
