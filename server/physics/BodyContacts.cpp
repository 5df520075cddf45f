#include "BodyContacts.h"

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
    m_touching.erase(at);
    return;
  }
  const bool is_slot_reused = at != m_touching.end() && at->contact.first.slot == contact.first.slot &&
                              at->contact.second.slot == contact.second.slot;
  if (is_slot_reused) {
    *at = {contact};
  } else {
    m_touching.insert(at, {contact});
  }
}

void BodyContacts::doubtFor(df::ObjectKey key, int ticks, const BodyWay* p_by) {
  for (Touch& touch : m_touching) {
    const bool is_its = touch.contact.first == key || touch.contact.second == key;
    if (!is_its || (p_by != nullptr && (touch.contact.by != *p_by || touch.doubt > 0))) continue;
    touch.doubt = ticks;
  }
}

bool BodyContacts::isTouching(df::ObjectKey key) const {
  return std::any_of(m_touching.begin(), m_touching.end(), [key](const Touch& touch) {
    return touch.contact.first == key || touch.contact.second == key;
  });
}

std::vector<BodyContact>& BodyContacts::finish() {
  if (m_touching.empty()) return m_news;
  std::erase_if(m_touching, [this](Touch& touch) {
    if (touch.doubt == 0 || --touch.doubt > 0) return false;
    m_news.push_back(touch.contact);
    m_news.back().time = 0;
    m_news.back().is_begin = false;
    return true;
  });
  return m_news;
}

}  // namespace naiad::physics
