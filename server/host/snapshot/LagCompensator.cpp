#include "host/snapshot/LagCompensator.h"

#include <algorithm>

#include "shared/replica/Acks.h"

namespace naiad {

void LagCompensator::recordTick(const Publisher& publisher, const df::WorldView& view) {
  const bool continues = m_has_ticks && publisher.tick() == m_tick + 1;
  m_tick = publisher.tick();
  m_has_ticks = true;
  if (!continues) {
    m_histories.clear();
    m_views = {};
    publisher.forEach(
        [this](std::uint32_t slot, const Publisher::Model& model) { recordModel(slot, model, true); });
    return recordViews(publisher, view);
  }
  for (const Publisher::Change& change : publisher.changes()) {
    const Publisher::Model* p_model = publisher.find(change.slot);
    if (p_model == nullptr) {
      clearHistory(change.slot);
    } else {
      recordModel(change.slot, *p_model, (change.groups & (kLife | kMotion)) != 0);
    }
  }
  recordViews(publisher, view);
}

void LagCompensator::recordViews(const Publisher& publisher, const df::WorldView& view) {
  Views& now = m_views[m_tick % m_views.size()];
  now.tick = m_tick;
  now.size = {df::fromCells(publisher.world().view_width), df::fromCells(publisher.world().view_height)};
  now.boundary = publisher.world().boundary;
  now.players.clear();
  for (const df::PlayerFacts& player : view.players) {
    const bool follows = player.followed.generation != 0;
    const bool predicted = player.steering.p_table != nullptr && player.steering.object == player.followed;
    if (follows && predicted) continue;
    const Publisher::Model* p_model = follows ? publisher.find(player.followed.slot) : nullptr;
    now.players.push_back({player.id, player.view_corner, std::nullopt});
    if (p_model != nullptr) now.players.back().followed = p_model->state.motion;
  }
}

void LagCompensator::recordModel(std::uint32_t slot, const Publisher::Model& model, bool moved) {
  if (slot == kFreeDrawSlot) return;  // not an object
  if (slot >= m_histories.size()) m_histories.resize(std::size_t{slot} + 1);
  History& history = m_histories[slot];
  if (history.generation != model.generation) history = {model.generation, m_tick, {}};
  if (!moved && !history.motions.empty()) return;
  history.motions.push_back({m_tick, model.state.motion});
  // Motions that were replaced before the oldest kept tick, or in it, are not needed.
  while (history.motions.size() > 1 && !isNewer(history.motions[1].since, m_tick - kTicks)) {
    history.motions.pop_front();
  }
}

void LagCompensator::clearHistory(std::uint32_t slot) {
  if (slot < m_histories.size()) m_histories[slot] = {};
}

std::optional<df::FixedVector> LagCompensator::positionOf(df::ObjectKey object,
                                                          const df::ViewedTick& seen) const {
  if (!seen.known || object.generation == 0 || object.slot >= m_histories.size()) return std::nullopt;
  const History& history = m_histories[object.slot];
  if (history.generation != object.generation) return std::nullopt;
  const std::uint32_t base = baseOf(seen);
  if (isNewer(history.born, base)) return std::nullopt;

  const auto known = std::find_if(history.motions.rbegin(), history.motions.rend(),
                                  [base](const Known& k) { return !isNewer(k.since, base); });
  const Known& newest = known != history.motions.rend() ? *known : history.motions.front();
  return positionAt(newest.motion, drawnOf(seen));
}

std::optional<df::FixedVector> LagCompensator::viewCornerOf(std::uint32_t player,
                                                            const df::ViewedTick& seen) const {
  if (!seen.known) return std::nullopt;
  const std::uint32_t base = baseOf(seen);
  const Views& views = m_views[base % m_views.size()];
  if (views.tick != base) return std::nullopt;
  const auto found =
      std::lower_bound(views.players.begin(), views.players.end(), player,
                       [](const PlayerView& view, std::uint32_t id) { return view.player < id; });
  if (found == views.players.end() || found->player != player) return std::nullopt;
  const Motion* p_followed = found->followed ? &*found->followed : nullptr;
  return viewCornerAt({found->corner, views.size, views.boundary}, base, p_followed, drawnOf(seen));
}

std::uint32_t LagCompensator::baseOf(const df::ViewedTick& seen) const {
  const std::uint32_t oldest = m_tick - kTicks;
  return isNewer(seen.base, oldest) ? seen.base : oldest;
}

std::uint32_t LagCompensator::drawnOf(const df::ViewedTick& seen) const {
  if (isNewer(seen.drawn, m_tick)) return m_tick;
  return isNewer(m_tick - kMaxBehind, seen.drawn) ? m_tick - kMaxBehind : seen.drawn;
}

}  // namespace naiad
