#include "client/world/ReplicaBarriers.h"

#include <algorithm>

namespace naiad {

namespace {

bool blocks(const Body& mover, const Body& other) {
  return (mover.solidness == df::HARD && other.solidness == df::HARD) ||
         (mover.solidness != df::SPECTRAL && mover.no_soft && other.solidness == df::SOFT);
}

df::FixedBox unite(const df::FixedBox& a, const df::FixedBox& b) {
  const df::FixedVector low{std::min(a.corner.x, b.corner.x), std::min(a.corner.y, b.corner.y)};
  const df::FixedVector high{std::max(a.corner.x + a.size.x, b.corner.x + b.size.x),
                             std::max(a.corner.y + a.size.y, b.corner.y + b.size.y)};
  return {low, high - low};
}

}  // namespace

std::optional<df::FixedBox> boxAt(const Body& body, df::FixedVector position) {
  // Boxes are within 10^6 cells (LookCodec), so no box around two positions within kFar overflows.
  constexpr df::Fixed kFar = df::fromCells(1'000'000'000);
  if (position.x < -kFar || position.x > kFar || position.y < -kFar || position.y > kFar) return std::nullopt;
  return df::translate(body.box, position);
}

std::optional<df::FixedBox> boxAlong(const ObjectState& object, std::uint32_t first, std::uint32_t last) {
  // The ends of a straight path are its extreme points; those of a bent path may be anywhere.
  const std::uint32_t ticks = last - first;
  const bool bends = object.motion.acceleration != df::FixedVector{};
  std::optional<df::FixedBox> all;
  for (std::uint32_t i = 0; i <= ticks; i += bends || ticks == 0 ? 1 : ticks) {
    const auto box = boxAt(object.body, positionAt(object.motion, first + i));
    if (!box) return std::nullopt;
    all = all ? unite(*all, *box) : *box;
  }
  return all;
}

ReplicaBarriers::ReplicaBarriers(const Replica& replica, const ObjectState& own, const df::FixedBox& from,
                                 df::FixedVector reach, std::uint32_t first, std::uint32_t last)
    : m_own(own) {
  const df::FixedBox around{from.corner - reach, from.size + reach + reach};
  const std::size_t ticks = last - first + 1;
  for (const auto& [slot, entry] : replica.entries()) {
    if (!entry.alive || entry.state.order == own.order || !blocks(own.body, entry.state.body)) continue;
    m_work += entry.state.motion.acceleration != df::FixedVector{} ? ticks : 1;
    if (m_work > kMaxWork / 2) break;  // the other half is for isBlocked()
    const auto box = boxAlong(entry.state, first, last);
    if (box && df::intersects(*box, around)) m_others.push_back({*box, &entry.state});
  }
}

bool ReplicaBarriers::isBlocked(df::FixedVector to, std::uint32_t tick, bool in_update) const {
  const auto own = boxAt(m_own.body, to);
  if (!own) return false;
  for (const Other& other : m_others) {
    if (++m_work > kMaxWork) return false;
    if (!df::intersects(*own, other.along)) continue;
    ++m_work;
    const bool has_moved = in_update && other.p_state->order < m_own.order;
    const auto box =
        boxAt(other.p_state->body, positionAt(other.p_state->motion, has_moved ? tick : tick - 1));
    if (box && df::intersects(*own, *box)) return true;
  }
  return false;
}

}  // namespace naiad
