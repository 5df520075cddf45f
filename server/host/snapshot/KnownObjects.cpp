#include "host/snapshot/KnownObjects.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "shared/replica/Checksum.h"

namespace naiad {

namespace {

constexpr int kLifeIndex = 0;

}  // namespace

void KnownObjects::enqueue(std::uint32_t id, std::uint32_t tick) {
  Known& known = m_known[id];
  if (known.owed == 0) known.since = tick;
  if (known.queued) return;
  known.queued = true;
  m_owing.push_back(id);
}

std::uint32_t KnownObjects::learn(std::uint32_t slot, std::uint32_t generation, std::uint32_t tick) {
  auto id = static_cast<std::uint32_t>(m_known.size());
  if (m_free.empty()) {
    if (id >= kMaxSlots) return kNobody;
    m_known.emplace_back();
  } else {
    id = m_free.top();
    m_free.pop();
  }
  Known& known = m_known[id];
  known.slot = slot;
  known.generation = generation;
  ++known.birth;
  known.life = Life::kBorn;
  m_ids.insert(slot, id);
  ++m_alive;
  enqueue(id, tick);
  known.owed = kAllGroups;
  return id;
}

void KnownObjects::owe(std::uint32_t id, std::uint8_t groups, std::uint32_t tick) {
  if (groups == 0) return;
  enqueue(id, tick);
  m_known[id].owed |= groups;
}

void KnownObjects::forget(std::uint32_t id, std::uint32_t tick) {
  Told& known = m_known[id];
  m_ids.erase(known.slot);
  --m_alive;
  if (known.life == Life::kBorn && known.sent[kLifeIndex] == 0) return release(id);  // it never heard of it
  known.life = Life::kDying;
  known.owed = 0;
  known.unconfirmed = 0;
  enqueue(id, tick);
  known.owed = kLife;
}

void KnownObjects::release(std::uint32_t id) {
  Told& known = m_known[id];
  known.life = Life::kFree;
  known.owed = 0;
  known.unconfirmed = 0;
  known.sent = {};
  m_free.push(id);
}

void KnownObjects::oweUnconfirmed(std::uint32_t tick) {
  for (std::uint32_t id = 0; id < m_known.size(); ++id) {
    if (m_known[id].unconfirmed != 0) owe(id, m_known[id].unconfirmed, tick);
  }
}

std::uint8_t KnownObjects::due(std::uint32_t id) const {
  const Known& known = m_known[id];
  if (known.life == Life::kDying) return kDeath;
  return known.life == Life::kBorn ? kAllGroups : known.owed;
}

KnownObjects::Sent KnownObjects::paid(std::uint32_t id, std::uint32_t snapshot, const ObjectState& state,
                                      std::uint32_t tick) {
  Told& known = m_known[id];
  const std::uint8_t groups = due(id);
  if (groups == kDeath) {
    for (std::uint64_t& sum : known.sums) m_checksum -= std::exchange(sum, 0);
    known.sent[kLifeIndex] = brief(snapshot);
  } else {
    if ((groups & kLife) != 0) carry(known, 0, snapshot, lifeSum(id, generationOf(known), state.order));
    if ((groups & kMotion) != 0) carry(known, 1, snapshot, motionSum(id, rebase(state.motion, tick)));
    if ((groups & kLook) != 0) carry(known, 2, snapshot, lookSum(id, rebase(state.look, tick)));
    if ((groups & kBody) != 0) carry(known, 3, snapshot, bodySum(id, state.body));
  }
  known.unconfirmed |= groups == kDeath ? +kLife : groups;
  known.owed = 0;
  return {id, known.birth, groups};
}

// What is carried again as it was is confirmed by any snapshot since it was so.
void KnownObjects::carry(Told& told, std::size_t group, std::uint32_t snapshot, std::uint64_t sum) {
  constexpr std::uint32_t kMax = std::numeric_limits<std::uint8_t>::max();  // none of these is in flight
  const bool first = told.sent[group] == 0 || told.sums[group] != sum;
  const std::uint32_t since = first ? 0 : told.since_first[group] + before(told.sent[group], brief(snapshot));
  told.since_first[group] = static_cast<std::uint8_t>(std::min(since, kMax));
  told.sent[group] = brief(snapshot);
  m_checksum += sum - told.sums[group];
  told.sums[group] = sum;
}

void KnownObjects::sweepOwing() {
  std::erase_if(m_owing, [this](std::uint32_t id) {
    Known& known = m_known[id];
    if (known.owed != 0) return false;
    known.queued = false;
    return true;
  });
}

void KnownObjects::arrived(const Sent& sent, std::uint32_t snapshot) {
  Told& known = m_known[sent.id];
  if (known.birth != sent.birth || known.life == Life::kFree) return;
  if (sent.groups == kDeath) {
    if (known.life == Life::kDying) release(sent.id);
    return;
  }
  if (known.life == Life::kDying) return;
  for (int i = 0; i < kGroupCount; ++i) {
    if ((sent.groups & (1 << i)) != 0 && before(brief(snapshot), known.sent[i]) <= known.since_first[i])
      known.unconfirmed &= ~(1 << i);
  }
  if ((sent.groups & kLife) != 0) known.life = Life::kAlive;
}

bool KnownObjects::lost(const Sent& sent, std::uint32_t snapshot, std::uint32_t tick) {
  Told& known = m_known[sent.id];
  if (known.birth != sent.birth || known.life == Life::kFree) return false;
  const bool dying = known.life == Life::kDying;
  if (dying != (sent.groups == kDeath)) return false;
  std::uint8_t missing = 0;
  for (int i = 0; i < kGroupCount; ++i) {
    const bool carried = dying ? i == kLifeIndex : (sent.groups & (1 << i)) != 0;
    if (carried && known.sent[i] == brief(snapshot)) missing |= 1 << i;
  }
  missing &= known.unconfirmed;
  // A birth that was lost after another one arrived leaves its other groups, if they are the newest.
  if (known.life == Life::kAlive) missing &= ~kLife;
  owe(sent.id, missing, tick);
  return missing != 0;
}

}  // namespace naiad
