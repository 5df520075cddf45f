#include "host/snapshot/KnownObjects.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "shared/replica/Checksum.h"

namespace naiad {

namespace {

constexpr int kLifeIndex = 0;

/// Returns the checksum of the look as a snapshot of `tick` carries it. Looks without a clock are not copied.
std::uint64_t lookSumAt(std::uint32_t id, const Look& look, std::uint32_t tick) {
  const Selector::Kind kind = look.selector.kind;
  const bool clock = kind == Selector::kClock || kind == Selector::kClockOnce;
  return clock ? lookSum(id, rebase(look, tick)) : lookSum(id, look);
}

}  // namespace

void KnownObjects::queueId(std::uint32_t id, std::uint32_t tick) {
  Known& known = m_known[id];
  if (known.pending == 0) known.pending_since = tick;
  if (known.queued) return;
  known.queued = true;
  m_pending_ids.push_back(id);
}

std::uint32_t KnownObjects::addObject(std::uint32_t slot, std::uint32_t generation, std::uint32_t tick) {
  auto id = static_cast<std::uint32_t>(m_known.size());
  if (m_free.empty()) {
    if (id >= kMaxSlots) return kNone;
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
  queueId(id, tick);
  known.pending = kAllGroups;
  return id;
}

void KnownObjects::addPending(std::uint32_t id, std::uint8_t groups, std::uint32_t tick) {
  if (groups == 0) return;
  queueId(id, tick);
  m_known[id].pending |= groups;
}

void KnownObjects::removeObject(std::uint32_t id, std::uint32_t tick) {
  KnownObject& known = m_known[id];
  m_ids.erase(known.slot);
  --m_alive;
  if (known.life == Life::kBorn && known.sent[kLifeIndex] == 0) return releaseId(id);
  known.life = Life::kDying;
  known.pending = 0;
  known.unconfirmed = 0;
  queueId(id, tick);
  known.pending = kLife;
}

void KnownObjects::releaseId(std::uint32_t id) {
  KnownObject& known = m_known[id];
  known.life = Life::kFree;
  known.pending = 0;
  known.unconfirmed = 0;
  known.sent = {};
  m_free.push(id);
}

void KnownObjects::requeueUnconfirmed(std::uint32_t tick) {
  for (std::uint32_t id = 0; id < m_known.size(); ++id) {
    if (m_known[id].unconfirmed != 0) addPending(id, m_known[id].unconfirmed, tick);
  }
}

std::uint8_t KnownObjects::groupsToSend(std::uint32_t id) const {
  const Known& known = m_known[id];
  if (known.life == Life::kDying) return kDeath;
  return known.life == Life::kBorn ? kAllGroups : known.pending;
}

KnownObjects::Sent KnownObjects::markSent(std::uint32_t id, std::uint32_t snapshot, const ObjectState& state,
                                          const Motion& motion, std::uint32_t tick) {
  KnownObject& known = m_known[id];
  const std::uint8_t groups = groupsToSend(id);
  if (groups == kDeath) {
    for (std::uint64_t& sum : known.sums) m_checksum -= std::exchange(sum, 0);
    known.sent[kLifeIndex] = brief(snapshot);
  } else {
    if ((groups & kLife) != 0) recordSum(known, 0, snapshot, lifeSum(id, generationOf(known), state.order));
    if ((groups & kMotion) != 0) recordSum(known, 1, snapshot, motionSum(id, motion));
    if ((groups & kLook) != 0) recordSum(known, 2, snapshot, lookSumAt(id, state.look, tick));
    if ((groups & kBody) != 0) recordSum(known, 3, snapshot, bodySum(id, state.body));
  }
  known.unconfirmed |= groups == kDeath ? +kLife : groups;
  known.pending = 0;
  return {id, known.birth, groups};
}

// A group sent again unchanged is confirmed by any snapshot since the first that carried this content.
void KnownObjects::recordSum(KnownObject& entry, std::size_t group, std::uint32_t snapshot,
                             std::uint64_t sum) {
  constexpr std::uint32_t kMax = std::numeric_limits<std::uint8_t>::max();  // older ones are not in flight
  const bool first = entry.sent[group] == 0 || entry.sums[group] != sum;
  const std::uint32_t since =
      first ? 0 : entry.since_first[group] + before(entry.sent[group], brief(snapshot));
  entry.since_first[group] = static_cast<std::uint8_t>(std::min(since, kMax));
  entry.sent[group] = brief(snapshot);
  m_checksum += sum - entry.sums[group];
  entry.sums[group] = sum;
}

void KnownObjects::trimPending() {
  std::erase_if(m_pending_ids, [this](std::uint32_t id) {
    Known& known = m_known[id];
    if (known.pending != 0) return false;
    known.queued = false;
    return true;
  });
}

void KnownObjects::confirmArrival(const Sent& sent, std::uint32_t snapshot) {
  KnownObject& known = m_known[sent.id];
  if (known.birth != sent.birth || known.life == Life::kFree) return;
  if (sent.groups == kDeath) {
    if (known.life == Life::kDying) releaseId(sent.id);
    return;
  }
  if (known.life == Life::kDying) return;
  for (int i = 0; i < kGroupCount; ++i) {
    if ((sent.groups & (1 << i)) != 0 && before(brief(snapshot), known.sent[i]) <= known.since_first[i])
      known.unconfirmed &= ~(1 << i);
  }
  if ((sent.groups & kLife) != 0) known.life = Life::kAlive;
}

bool KnownObjects::requeueLost(const Sent& sent, std::uint32_t snapshot, std::uint32_t tick) {
  KnownObject& known = m_known[sent.id];
  if (known.birth != sent.birth || known.life == Life::kFree) return false;
  const bool dying = known.life == Life::kDying;
  if (dying != (sent.groups == kDeath)) return false;
  std::uint8_t missing = 0;
  for (int i = 0; i < kGroupCount; ++i) {
    const bool carried = dying ? i == kLifeIndex : (sent.groups & (1 << i)) != 0;
    if (carried && known.sent[i] == brief(snapshot)) missing |= 1 << i;
  }
  missing &= known.unconfirmed;
  // If a birth is lost after another record of it has arrived, only the record's other groups are missing,
  // and only if their content is the newest.
  if (known.life == Life::kAlive) missing &= ~kLife;
  addPending(sent.id, missing, tick);
  return missing != 0;
}

}  // namespace naiad
