#include "host/process/EventFeed.h"

#include <utility>

#include "shared/program/LogText.h"

namespace naiad {

void EventFeed::begin(std::function<void()> wake) {
  const std::lock_guard lock(m_mutex);
  m_wake = std::move(wake);
  m_waiting = {};
  m_is_watched = true;
}

void EventFeed::end() {
  const std::lock_guard lock(m_mutex);
  m_is_watched = false;
  m_wake = nullptr;
  m_waiting = {};
}

void EventFeed::publish(std::string kind, std::string text) {
  if (!m_is_watched) return;
  const std::lock_guard lock(m_mutex);
  add({std::move(kind), std::move(text)});
}

void EventFeed::publishGame(const std::string& line, std::chrono::steady_clock::time_point now) {
  if (!m_is_watched) return;
  const std::lock_guard lock(m_mutex);
  if (!m_game_lines.tryConsume(kGameRate, now)) {
    ++m_dropped_game_lines;
    return;
  }
  if (const std::uint64_t count = std::exchange(m_dropped_game_lines, 0); count > 0)
    add({"game", "game: " + std::to_string(count) + " lines dropped (too many at once)"});
  add({"game", "game: " + oneLine(std::string_view(line).substr(0, kMaxGameLine))});
}

// Call with the mutex locked.
void EventFeed::add(FeedEvent event) {
  if (!m_wake) return;
  if (m_waiting.events.size() >= kMaxWaiting) {
    ++m_waiting.dropped;
    return;
  }
  m_waiting.events.push_back(std::move(event));
  if (m_waiting.events.size() == 1) m_wake();
}

LogLine EventFeed::publishing(LogLine log) {
  return [this, log = std::move(log)](const LogEvent& event) {
    log(event);
    publish("log", event.text);
  };
}

LogLine EventFeed::publishingGame(LogLine log) {
  return [this, log = std::move(log)](const LogEvent& event) {
    log(event);
    publishGame(event.text, std::chrono::steady_clock::now());
  };
}

EventFeed::EventBatch EventFeed::popAll() {
  const std::lock_guard lock(m_mutex);
  return std::exchange(m_waiting, {});
}

}  // namespace naiad
