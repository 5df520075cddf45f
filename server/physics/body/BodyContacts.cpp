#include "physics/body/BodyContacts.h"

#include <algorithm>

#include "engine/world/WorldStore.h"

namespace naiad::physics {

void BodyContacts::beginTick() {
  m_changes.clear();
}

// Returns the contact of these two Objects, not of earlier ones in their slots; else end().
BodyContacts::Touches::iterator BodyContacts::find(ObjectKey first, ObjectKey second) {
  const auto at = m_touching.find(keyOf(first, second));
  if (at == m_touching.end()) return at;
  const BodyContact& its = at->second.contact;
  return its.first == first && its.second == second ? at : m_touching.end();
}

// Ends a contact. Returns the next one in the map.
BodyContacts::Touches::iterator BodyContacts::end(Touches::iterator at, double time) {
  BodyContact& contact = m_changes.emplace_back(at->second.contact);
  contact.time = time;
  contact.is_begin = false;
  contact.impulse = 0;
  count(contact, -1);
  return m_touching.erase(at);
}

void BodyContacts::end(ObjectKey first, ObjectKey second, double time) {
  const auto at = find(first, second);
  if (at != m_touching.end()) end(at, time);
}

void BodyContacts::add(const BodyContact& contact) {
  applyLapses();
  const auto known = find(contact.first, contact.second);
  if (!contact.is_begin) {
    if (known != m_touching.end()) end(known, contact.time);
    return;
  }
  if (known != m_touching.end()) {
    Touch& touch = known->second;
    touch.ticks_left = 0;
    count(touch.contact, -1);
    touch.contact.by = contact.by;
    count(touch.contact, 1);
    return;
  }
  const auto other = m_touching.find(keyOf(contact.first, contact.second));
  if (other != m_touching.end()) end(other, contact.time);  // of earlier Objects in these slots
  m_changes.push_back(contact);
  m_touching.emplace(keyOf(contact.first, contact.second), Touch{contact});
  count(contact, 1);
}

void BodyContacts::count(const BodyContact& contact, int by) {
  if (contact.by == BodySolver::kSensor) return;
  for (const ObjectKey key : {contact.first, contact.second}) {
    if (key.slot >= m_counts.size()) m_counts.resize(key.slot + 1);
    TouchCount& its = m_counts[key.slot];
    const bool is_free = its.count == 0 && (m_other_counts.empty() || !m_other_counts.contains(nameOf(key)));
    if (is_free) its.generation = key.generation;
    if (its.generation == key.generation) {
      its.count += by;
    } else if (const auto at = m_other_counts.try_emplace(nameOf(key), 0).first; (at->second += by) == 0) {
      m_other_counts.erase(at);
    }
  }
}

void BodyContacts::handOver(ObjectKey first, ObjectKey second) {
  const auto at = find(first, second);
  if (at == m_touching.end() || at->second.contact.by != BodySolver::kSensor) return;
  at->second.ticks_left = kHandOverTicks;
  m_has_expiring = true;
}

// Applies all lapses in one pass, because a whole pile may be handed over or deleted.
void BodyContacts::applyLapses() {
  if (m_lapses.empty()) return;
  m_has_expiring = true;
  const auto isBefore = [](const Lapse& a, const Lapse& b) { return a.key.slot < b.key.slot; };
  std::stable_sort(m_lapses.begin(), m_lapses.end(), isBefore);
  const auto apply = [&](ObjectKey key, Touch& touch) {
    const auto [begin, end] = std::equal_range(m_lapses.begin(), m_lapses.end(), Lapse{key, 0, {}}, isBefore);
    for (auto lapse = begin; lapse != end; ++lapse) {
      const bool is_its = lapse->key == key && (!lapse->by || *lapse->by == touch.contact.by);
      if (!is_its || (lapse->by && touch.ticks_left > 0)) continue;
      touch.ticks_left = touch.ticks_left > 0 ? std::min(touch.ticks_left, lapse->ticks) : lapse->ticks;
    }
  };
  for (auto& [slots, touch] : m_touching) {
    if (touch.contact.by == BodySolver::kSensor) continue;
    apply(touch.contact.first, touch);
    apply(touch.contact.second, touch);
  }
  m_lapses.clear();
}

bool BodyContacts::isTouching(ObjectKey key) const {
  if (key.slot >= m_counts.size()) return false;
  const TouchCount& its = m_counts[key.slot];
  return its.generation == key.generation ? its.count > 0 : m_other_counts.contains(nameOf(key));
}

std::vector<BodyContact>& BodyContacts::finishTick() {
  applyLapses();
  if (!m_has_expiring) return m_changes;
  m_has_expiring = false;
  for (auto at = m_touching.begin(); at != m_touching.end();) {
    Touch& touch = at->second;
    if (touch.ticks_left > 0 && --touch.ticks_left == 0) {
      at = end(at, 0);
      continue;
    }
    m_has_expiring = m_has_expiring || touch.ticks_left > 0;
    ++at;
  }
  return m_changes;
}

void BodyContacts::noteMissed(const std::vector<BodyContact>& contacts) {
  for (const BodyContact& contact : contacts) {
    if (!contact.is_begin) continue;
    const auto at = find(contact.first, contact.second);
    if (at != m_touching.end()) at->second.contact.missed = contact.missed;
  }
}

std::vector<BodyContact>& BodyContacts::endMarked(const WorldStore& store) {
  m_changes.clear();
  const auto isMarked = [&](ObjectKey key) {
    return store.isCurrent(key) && store.has(key.slot, WorldStore::kMarked);
  };
  for (auto at = m_touching.begin(); at != m_touching.end();) {
    const BodyContact& contact = at->second.contact;
    isMarked(contact.first) || isMarked(contact.second) ? void(at = end(at, 1)) : void(++at);
  }
  return m_changes;
}

}  // namespace naiad::physics
