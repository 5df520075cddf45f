#include "server/directory/FleetWatch.h"

#include <utility>

#include "shared/fleet/ServerId.h"

namespace naiad {

FleetWatch::FleetWatch(std::unique_ptr<Bus> bus, std::function<void(const std::string& line)> log, Time now,
                       std::chrono::milliseconds interval)
    : m_bus(std::move(bus)), m_log(std::move(log)), m_servers(interval), m_connected_at(now) {}

void FleetWatch::update(Time now) {
  if (const std::string line = m_bus->takeNews(); !line.empty()) m_log(line);
  for (const BusMessage& message : m_bus->takeMessages()) {
    if (m_servers.put(message.subject, message.payload, now))
      logNews(message.subject.substr(presenceSubject("").size()) + " is there", now);
  }
  if (m_bus->isConnected()) m_connected_at = now;
  // Servers cannot be heard without a bus, so their time does not run; it does once that has lasted for too
  // long.
  const bool is_blind = m_connected_at != now;
  if (is_blind && now - m_connected_at < kBlind) return m_servers.forgiveSilence(now);
  for (const std::string& id : m_servers.removeSilent(now)) logNews(id + " is gone", now);
}

void FleetWatch::logNews(const std::string& line, Time now) {
  if (!m_news.takeToken(kNewsRate, now)) {
    ++m_news_left_out;
    return;
  }
  if (const auto count = std::exchange(m_news_left_out, 0); count > 0)
    m_log(std::to_string(count) + " more servers came or went");
  m_log(line);
}

}  // namespace naiad
