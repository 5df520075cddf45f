#include "physics/body/BodyContacts.h"

#include <algorithm>

namespace naiad::physics {

void BodyContacts::beginTick() {
  m_changes.clear();
}

void BodyContacts::add(const BodyContact& contact) {
  applyHandOvers();
  const auto at = m_touching.find(keyOf(contact));
  const bool is_in_slots = at != m_touching.end();
  const bool is_known =
      is_in_slots && at->second.contact.first == contact.first && at->second.contact.second == contact.second;
  if (is_known == contact.is_begin) {
    if (!is_known) return;
    at->second.ticks_left = 0;
    at->second.contact.by = contact.by;
    return;
  }
  m_changes.push_back(contact);
  if (is_in_slots) count(at->second.contact, -1);  // the contact ends, or its Objects were deleted
  if (!contact.is_begin) {
    m_touching.erase(at);
    return;
  }
  m_touching.insert_or_assign(keyOf(contact), Touch{contact});
  count(contact, 1);
}

void BodyContacts::count(const BodyContact& contact, int by) {
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

void BodyContacts::expireIn(ObjectKey key, int ticks, const BodySolver* p_by) {
  applyHandOvers();
  m_has_expiring = true;
  for (auto& [slots, touch] : m_touching) {
    const bool is_its = touch.contact.first == key || touch.contact.second == key;
    if (!is_its || (p_by != nullptr && (touch.contact.by != *p_by || touch.ticks_left > 0))) continue;
    touch.ticks_left = ticks;
  }
}

// Lets the contacts of all handed-over bodies expire, in one pass: a whole pile may be handed over.
void BodyContacts::applyHandOvers() {
  if (m_handed_over.empty()) return;
  m_has_expiring = true;
  const auto isBefore = [](ObjectKey a, ObjectKey b) { return a.slot < b.slot; };
  std::sort(m_handed_over.begin(), m_handed_over.end(), isBefore);
  const auto isHandedOver = [&](ObjectKey key) {
    const auto at = std::lower_bound(m_handed_over.begin(), m_handed_over.end(), key, isBefore);
    return at != m_handed_over.end() && *at == key;
  };
  for (auto& [slots, touch] : m_touching) {
    if (isHandedOver(touch.contact.first) || isHandedOver(touch.contact.second))
      touch.ticks_left = kHandOverTicks;
  }
  m_handed_over.clear();
}

bool BodyContacts::isTouching(ObjectKey key) const {
  if (key.slot >= m_counts.size()) return false;
  const TouchCount& its = m_counts[key.slot];
  return its.generation == key.generation ? its.count > 0 : m_other_counts.contains(nameOf(key));
}

std::vector<BodyContact>& BodyContacts::finishTick() {
  applyHandOvers();
  if (!m_has_expiring) return m_changes;
  m_has_expiring = false;
  for (auto at = m_touching.begin(); at != m_touching.end();) {
    Touch& touch = at->second;
    if (touch.ticks_left == 0 || --touch.ticks_left > 0) {
      m_has_expiring = m_has_expiring || touch.ticks_left > 0;
      ++at;
      continue;
    }
    count(touch.contact, -1);
    m_changes.push_back(touch.contact);
    m_changes.back().time = 0;
    m_changes.back().is_begin = false;
    at = m_touching.erase(at);
  }
  return m_changes;
}

}  // namespace naiad::physics
