#include "physics/body/BodyContacts.h"

#include <algorithm>

namespace naiad::physics {

std::vector<BodyContacts::Touch>::iterator BodyContacts::find(const BodyContact& contact) {
  return std::lower_bound(m_touching.begin(), m_touching.end(), contact,
                          [](const Touch& touch, const BodyContact& other) {
                            const BodyContact& its = touch.contact;
                            if (its.first.slot != other.first.slot) return its.first.slot < other.first.slot;
                            return its.second.slot < other.second.slot;
                          });
}

void BodyContacts::beginTick() {
  m_changes.clear();
}

void BodyContacts::add(const BodyContact& contact) {
  const auto at = find(contact);
  const bool is_known =
      at != m_touching.end() && at->contact.first == contact.first && at->contact.second == contact.second;
  if (is_known == contact.is_begin) {
    if (!is_known) return;
    at->ticks_left = 0;
    at->contact.by = contact.by;
    return;
  }
  m_changes.push_back(contact);
  if (!contact.is_begin) {
    count(at->contact, -1);
    m_touching.erase(at);
    return;
  }
  const bool is_slot_reused = at != m_touching.end() && at->contact.first.slot == contact.first.slot &&
                              at->contact.second.slot == contact.second.slot;
  if (is_slot_reused) {
    count(at->contact, -1);
    *at = {contact};
  } else {
    m_touching.insert(at, {contact});
  }
  count(contact, 1);
}

void BodyContacts::count(const BodyContact& contact, int by) {
  for (const df::ObjectKey key : {contact.first, contact.second}) {
    const auto at = m_touch_counts.begin() + (findCount(key) - m_touch_counts.cbegin());
    if (at == m_touch_counts.end() || at->key != key) {
      m_touch_counts.insert(at, {key, by});
    } else if (at->count += by; at->count == 0) {
      m_touch_counts.erase(at);
    }
  }
}

std::vector<BodyContacts::TouchCount>::const_iterator BodyContacts::findCount(df::ObjectKey key) const {
  return std::lower_bound(
      m_touch_counts.begin(), m_touch_counts.end(), key, [](const TouchCount& its, df::ObjectKey k) {
        return its.key.slot != k.slot ? its.key.slot < k.slot : its.key.generation < k.generation;
      });
}

void BodyContacts::expireIn(df::ObjectKey key, int ticks, const BodySolver* p_by) {
  for (Touch& touch : m_touching) {
    const bool is_its = touch.contact.first == key || touch.contact.second == key;
    if (!is_its || (p_by != nullptr && (touch.contact.by != *p_by || touch.ticks_left > 0))) continue;
    touch.ticks_left = ticks;
  }
}

bool BodyContacts::isTouching(df::ObjectKey key) const {
  const auto at = findCount(key);
  return at != m_touch_counts.end() && at->key == key;
}

std::vector<BodyContact>& BodyContacts::finishTick() {
  if (m_touching.empty()) return m_changes;
  std::erase_if(m_touching, [this](Touch& touch) {
    if (touch.ticks_left == 0 || --touch.ticks_left > 0) return false;
    count(touch.contact, -1);
    m_changes.push_back(touch.contact);
    m_changes.back().time = 0;
    m_changes.back().is_begin = false;
    return true;
  });
  return m_changes;
}

}  // namespace naiad::physics
