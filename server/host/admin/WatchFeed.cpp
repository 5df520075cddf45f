#include "host/admin/WatchFeed.h"

#include <utility>

namespace naiad {

void WatchFeed::begin(std::function<void()> wake) {
  const std::lock_guard lock(m_mutex);
  m_wake = std::move(wake);
  m_waiting = {};
  m_watched = true;
}

void WatchFeed::end() {
  const std::lock_guard lock(m_mutex);
  m_watched = false;
  m_wake = nullptr;
  m_waiting = {};
}

void WatchFeed::publish(std::string kind, std::string text) {
  if (!m_watched) return;
  const std::lock_guard lock(m_mutex);
  if (!m_wake) return;
  if (m_waiting.events.size() >= kMaxWaiting) {
    ++m_waiting.dropped;
    return;
  }
  m_waiting.events.push_back({std::move(kind), std::move(text)});
  if (m_waiting.events.size() == 1) m_wake();
}

WatchFeed::Taken WatchFeed::take() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_waiting, {});
}

}  // namespace naiad
