#include "client/session/RoundTrip.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace naiad {
namespace {

constexpr std::size_t kMaxOpen = 20;

}  // namespace

std::uint64_t RoundTrip::startPing(Time now) {
  if (m_open.size() >= kMaxOpen) m_open.erase(m_open.begin());
  m_open.emplace(m_next_token, now);
  return m_next_token++;
}

std::optional<RoundTrip::Millis> RoundTrip::endPing(std::uint64_t token, Time now) {
  const auto ping = m_open.find(token);
  if (ping == m_open.end()) return std::nullopt;
  const Millis sample = now - ping->second;
  m_open.erase(m_open.begin(), std::next(ping));
  m_stats.addSample(sample, now);
  return sample;
}

RoundTrip::Millis RoundTrip::waiting(Time now) const {
  return m_open.empty() ? Millis{0} : Millis(now - m_open.begin()->second);
}

std::chrono::milliseconds RoundTrip::shown() const {
  const auto whole = std::chrono::ceil<std::chrono::milliseconds>(smoothed());
  return std::min<std::chrono::milliseconds>(whole, std::chrono::milliseconds(99999));
}

}  // namespace naiad
