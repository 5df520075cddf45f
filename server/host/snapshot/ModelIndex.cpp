#include "host/snapshot/ModelIndex.h"

#include <algorithm>
#include <cstdlib>

namespace naiad {

namespace {

/// Adds the slot to the list or removes it.
void setListed(std::vector<std::uint32_t>& slots, std::uint32_t slot, bool& is_listed, bool should_be) {
  if (is_listed == should_be) return;
  is_listed = should_be;
  if (should_be) return slots.push_back(slot);
  *std::find(slots.begin(), slots.end(), slot) = slots.back();
  slots.pop_back();
}

/// True if the motion covers more than a cell per tick, or is accelerated, so that it soon may.
bool isFast(const Motion& motion) {
  const auto above = [](df::Fixed v) { return v > df::kFixedOne || v < -df::kFixedOne; };
  return motion.acceleration != df::FixedVector{} || above(motion.velocity.x) || above(motion.velocity.y);
}

}  // namespace

void ModelIndex::indexModel(std::uint32_t slot, const PublishedModel& model, df::FixedVector position,
                            Membership& membership) {
  const bool wide = model.alive && (slot == kFreeDrawSlot || model.reach > PublishedModel::kWide);
  setListed(m_wide, slot, membership.wide, wide);
  if (slot == kFreeDrawSlot) return;
  if (wide || !model.alive) return m_grid.remove(slot);
  m_reach = std::max(m_reach, model.reach);
  indexMove(slot, position, membership);
}

void ModelIndex::indexMotion(std::uint32_t slot, const PublishedModel& model, Membership& membership) {
  setListed(m_fast, slot, membership.fast, model.alive && isFast(model.state.motion));
}

void ModelIndex::updateMaxSpeed(const PublishedModel& model, const Membership& membership) {
  if (membership.fast) return;
  const df::FixedVector v = model.state.motion.velocity;
  m_speed = {std::max(m_speed.x, std::abs(v.x)), std::max(m_speed.y, std::abs(v.y))};
}

}  // namespace naiad
