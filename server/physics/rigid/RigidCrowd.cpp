// Bodies that lie in one another by the dozen, as when a game makes all of them in one place: each is pushed
// by the nearest, and passes through the rest until there is room. What a crowd costs grows with the number
// of its bodies, not with the number of their pairs. A body that lies beside others touches only the nearest
// of them.
#include <algorithm>
#include <tuple>

#include "physics/rigid/RigidWorld.h"

namespace naiad::physics {

namespace {

constexpr std::uint32_t kMaxOthers = 12;  // twice the six discs of one size that can touch a disc

}  // namespace

// Nearer than two discs of their areas would touch, and free to part.
bool RigidWorld::areHeaped(const Pair& pair) const {
  if (!isMovable(pair.a) || !isMovable(pair.b) || pair.is_jointed) return false;
  const double size = m_extras[at(pair.a)].size + m_extras[at(pair.b)].size;
  return lengthSquared(m_bodies[at(pair.b)].place - m_bodies[at(pair.a)].place) < size * size;
}

// A pair is passed over if for both it is one of too many, and neither has it among its nearest.
void RigidWorld::thinCrowds() {
  if (m_pairs.size() <= kMaxOthers) return;
  m_others.assign(m_bodies.size(), 0);
  std::uint32_t most = 0;
  for (const Pair& pair : m_pairs) {
    most = std::max({most, ++m_others[at(pair.a)], ++m_others[at(pair.b)]});
  }
  if (most <= kMaxOthers) return;
  m_others.assign(m_bodies.size(), 0);
  for (const Pair& pair : m_pairs) {
    if (!areHeaped(pair)) continue;
    ++m_others[at(pair.a)];
    ++m_others[at(pair.b)];
  }
  m_choices.clear();
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(m_pairs.size()); ++i) {
    Pair& pair = m_pairs[at(i)];
    if (m_others[at(pair.a)] <= kMaxOthers || m_others[at(pair.b)] <= kMaxOthers || !areHeaped(pair))
      continue;
    const double square = lengthSquared(m_bodies[at(pair.b)].place - m_bodies[at(pair.a)].place);
    // Of bodies in one place each begins with another one.
    m_choices.push_back({pair.a, square, static_cast<std::uint32_t>(pair.b - pair.a), i});
    m_choices.push_back({pair.b, square, static_cast<std::uint32_t>(pair.a - pair.b), i});
    pair.is_passed = true;
    ++m_counters.passed;
  }
  std::sort(m_choices.begin(), m_choices.end(), [](const Choice& x, const Choice& y) {
    return std::tie(x.by, x.square, x.turn) < std::tie(y.by, y.square, y.turn);
  });
  std::uint32_t chosen = 0;
  for (std::size_t i = 0; i < m_choices.size(); ++i) {
    chosen = i > 0 && m_choices[i].by == m_choices[i - 1].by ? chosen + 1 : 0;
    if (chosen >= kMaxOthers || !m_pairs[at(m_choices[i].pair)].is_passed) continue;
    m_pairs[at(m_choices[i].pair)].is_passed = false;
    --m_counters.passed;
  }
}

}  // namespace naiad::physics
