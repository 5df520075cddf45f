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

void BodyContacts::begin() {
  m_news.clear();
}

void BodyContacts::add(const BodyContact& contact) {
  const auto at = find(contact);
  const bool is_known =
      at != m_touching.end() && at->contact.first == contact.first && at->contact.second == contact.second;
  if (is_known == contact.is_begin) {
    if (!is_known) return;
    at->doubt = 0;
    at->contact.by = contact.by;
    return;
  }
  m_news.push_back(contact);
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
    const auto at = m_touchers.begin() + (toucher(key) - m_touchers.cbegin());
    if (at == m_touchers.end() || at->key != key) {
      m_touchers.insert(at, {key, by});
    } else if (at->count += by; at->count == 0) {
      m_touchers.erase(at);
    }
  }
}

std::vector<BodyContacts::Toucher>::const_iterator BodyContacts::toucher(df::ObjectKey key) const {
  return std::lower_bound(m_touchers.begin(), m_touchers.end(), key, [](const Toucher& its, df::ObjectKey k) {
    return its.key.slot != k.slot ? its.key.slot < k.slot : its.key.generation < k.generation;
  });
}

void BodyContacts::doubtFor(df::ObjectKey key, int ticks, const BodyWay* p_by) {
  for (Touch& touch : m_touching) {
    const bool is_its = touch.contact.first == key || touch.contact.second == key;
    if (!is_its || (p_by != nullptr && (touch.contact.by != *p_by || touch.doubt > 0))) continue;
    touch.doubt = ticks;
  }
}

bool BodyContacts::isTouching(df::ObjectKey key) const {
  const auto at = toucher(key);
  return at != m_touchers.end() && at->key == key;
}

std::vector<BodyContact>& BodyContacts::finish() {
  if (m_touching.empty()) return m_news;
  std::erase_if(m_touching, [this](Touch& touch) {
    if (touch.doubt == 0 || --touch.doubt > 0) return false;
    count(touch.contact, -1);
    m_news.push_back(touch.contact);
    m_news.back().time = 0;
    m_news.back().is_begin = false;
    return true;
  });
  return m_news;
}

}  // namespace naiad::physics
