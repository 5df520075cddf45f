#include "host/snapshot/Urgency.h"

#include <cmath>

namespace naiad {

namespace {

/// A tick of waiting counts as much as being so many cells nearer.
constexpr double kCellsPerTick = 8;
/// For repeating, a cell per tick of speed counts as much as being so many cells nearer.
constexpr double kCellsPerSpeed = 20;
/// Deaths are short, and each removes a ghost.
constexpr double kDeathUrgency = 1e6;
constexpr double kOwnUrgency = 1e5;

/// The objects that the view follows and that the player steers.
bool isOwn(const KnownObjects::Known& known, const df::PlayerFacts& player) {
  const df::ObjectKey key{known.slot, known.generation};
  return player.followed == key || player.steering.object == key;
}

}  // namespace

// What is on the view, near its middle or has waited long comes first.
double Urgency::of(std::uint32_t id) const {
  const KnownObjects::Known& known = m_replica.objects.at(id);
  const df::PlayerFacts& player = m_replica.state.player();
  if (known.life == KnownObjects::Life::kDying) return kDeathUrgency;
  if (isOwn(known, player)) return kOwnUrgency;
  const std::uint32_t tick = m_publisher.tick();
  const double waited = kCellsPerTick * (tick - known.pending_since);
  const ObjectState& state = m_publisher.find(known.slot)->state;
  if (state.body.on_view) return waited;
  const df::FixedVector at = positionAt(state.motion, tick);
  const WorldRecord& world = m_replica.state.world();
  const df::FixedVector corner = player.view_corner;
  const df::FixedVector focus{corner.x + df::fromCells(world.view_width) / 2,
                              corner.y + df::fromCells(world.view_height) / 2};
  const double dx = df::toCells(at.x) - df::toCells(focus.x);
  const double dy = 2 * (df::toCells(at.y) - df::toCells(focus.y));  // cells are twice as high as wide
  return waited - std::sqrt(dx * dx + dy * dy);
}

double Urgency::ofRepeating(std::uint32_t id) const {
  const KnownObjects::Known& known = m_replica.objects.at(id);
  if (known.life == KnownObjects::Life::kDying) return of(id);
  const df::FixedVector v = m_publisher.find(known.slot)->state.motion.velocity;
  return of(id) + kCellsPerSpeed * (std::abs(df::toCells(v.x)) + std::abs(df::toCells(v.y)));
}

}  // namespace naiad
