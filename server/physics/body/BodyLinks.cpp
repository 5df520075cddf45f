#include "physics/body/BodyLinks.h"

#include <algorithm>
#include <utility>

#include "physics/geometry/Index.h"
#include "physics/geometry/UnionFind.h"

namespace naiad::physics {

namespace {

// Maximum loops of a group. With this many, the search for an elimination order takes some milliseconds.
constexpr int kMaxLoops = 32;

}  // namespace

void BodyLinks::prepare(const BodyTable& table) {
  if (m_changes == table.joints.changes()) return;
  m_changes = table.joints.changes();
  countLoops(table);
  findKinds(table);
}

void BodyLinks::findKinds(const BodyTable& table) {
  const std::vector<JointEntry>& entries = table.joints.entries();
  m_kinds.clear();
  std::vector<int> joints_of;
  const auto count = [&](int row) {
    if (row == BodyJoints::kWorld) return;
    if (at(row) >= m_kinds.size()) {
      m_kinds.resize(at(row) + 1, kNoJoint);
      joints_of.resize(at(row) + 1, 0);
    }
    m_kinds[at(row)] = kJoined;
    ++joints_of[at(row)];
  };
  for (const JointEntry& entry : entries) {
    if (!entry.used) continue;
    count(entry.joint.a);
    count(entry.joint.b);
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Joint& joint = entries[i].joint;
    if (!entries[i].used || joint.kind != JointKind::kSpring || joint.a != BodyJoints::kWorld) continue;
    if (joints_of[at(joint.b)] == 1 && joint.anchor_b == Vec2{}) m_kinds[at(joint.b)] = static_cast<int>(i);
  }
}

// Marks the bodies of groups with too many loops of joints. A tree of bodies is factored without fill-in, and
// each loop adds some. Several joints between the same two bodies are not a loop.
void BodyLinks::countLoops(const BodyTable& table) {
  m_is_costly.clear();
  if (table.joints.count() <= kMaxLoops) return;
  std::vector<std::pair<int, int>> edges;  // kWorld is the end of a joint that is fixed to the world
  const auto fixedOr = [&](int row) {
    return row == BodyJoints::kWorld || table.row(static_cast<BodyTable::Index>(row)).inverse_mass == 0
               ? BodyJoints::kWorld
               : row;
  };
  int rows = 0;
  for (const JointEntry& entry : table.joints.entries()) {
    if (!entry.used || entry.joint.kind == JointKind::kMouse) continue;
    const std::pair<int, int> edge = std::minmax(fixedOr(entry.joint.a), fixedOr(entry.joint.b));
    if (edge.second == BodyJoints::kWorld) continue;
    edges.push_back(edge);
    rows = std::max(rows, edge.second + 1);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<int> loops(at(rows), 0);
  std::vector<std::uint8_t> is_held(at(rows), 0);
  UnionFind sets;
  sets.reset(at(rows));
  for (const auto& [a, b] : edges) {
    const int root = sets.rootOf(b);
    if (a == BodyJoints::kWorld) {  // because all fixed ends of a group count as one body
      loops[at(root)] += is_held[at(root)];
      is_held[at(root)] = 1;
      continue;
    }
    const int other = sets.rootOf(a);
    if (other == root) {
      ++loops[at(root)];
      continue;
    }
    const int kept = std::min(root, other), merged = std::max(root, other);
    sets.unite(kept, merged);
    loops[at(kept)] += loops[at(merged)] + (is_held[at(kept)] & is_held[at(merged)]);
    is_held[at(kept)] |= is_held[at(merged)];
  }
  for (int row = 0; row < rows; ++row) {
    if (loops[at(sets.rootOf(row))] <= kMaxLoops) continue;
    m_is_costly.resize(at(rows), 0);
    m_is_costly[at(row)] = 1;
  }
}

}  // namespace naiad::physics
