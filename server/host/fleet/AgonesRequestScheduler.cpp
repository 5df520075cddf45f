#include "host/fleet/AgonesRequestScheduler.h"

#include <algorithm>
#include <utility>

namespace naiad {

namespace {

using Kind = SidecarRequest::Kind;

constexpr std::chrono::milliseconds kIdle{500};  ///< time until the next check if no request is due
constexpr int kNotFound = 404;
constexpr int kNotImplemented = 501;

bool isGood(int status) {
  return status >= 200 && status < 300;
}

SidecarRequest post(Kind kind, const char* p_path) {
  return {kind, "POST", p_path, "{}"};
}

/// Quotes a number, because 64-bit numbers are strings in the JSON of Protocol Buffers.
std::string quoted(std::size_t number) {
  std::string text = "\"";
  text += std::to_string(number);
  return text += '"';
}

}  // namespace

void AgonesRequestScheduler::setPlayers(const PlatformPlayers& players) {
  m_players = players.ids;
  m_max_players = players.most;
}

std::chrono::milliseconds AgonesRequestScheduler::healthTime() const {
  if (!m_facts || m_facts->health_seconds == 0) return kHealth;
  return std::clamp(std::chrono::milliseconds(std::chrono::seconds(m_facts->health_seconds)) / 2,
                    std::chrono::milliseconds(500), std::chrono::milliseconds(5000));
}

std::optional<SidecarRequest> AgonesRequestScheduler::next(Time now) {
  m_wake = now + kIdle;
  if (m_pending || m_over) return std::nullopt;
  if (m_not_before && now < *m_not_before) {
    m_wake = *m_not_before;
    return std::nullopt;
  }
  m_pending = choose(now);
  return m_pending;
}

// Shutdown has priority. Ready and health come before values that are only displayed, because the cluster
// ends a server that is not ready or not healthy. A server that no longer ticks is not healthy.
std::optional<SidecarRequest> AgonesRequestScheduler::choose(Time now) const {
  if (m_ending) return post(Kind::kShutdown, "/shutdown");
  if (!m_ready) return std::nullopt;
  const bool ticks = m_ticked && now - *m_ticked < healthTime();
  if (ticks && (!m_healthy || now - *m_healthy >= healthTime())) return post(Kind::kHealth, "/health");
  const ReportedState wanted = m_players.empty() ? ReportedState::kReady : ReportedState::kAllocated;
  if (m_reported_state == ReportedState::kNothing) return post(Kind::kReady, "/ready");
  if (m_reported_state != wanted)
    return m_players.empty() ? post(Kind::kReady, "/ready") : post(Kind::kAllocate, "/allocate");
  if (!m_facts && now >= m_facts_not_before) return SidecarRequest{Kind::kFacts, "GET", "/gameserver", ""};
  const std::string counter =
      R"({"count":)" + quoted(m_players.size()) + R"(,"capacity":)" + quoted(m_max_players) + "}";
  if (m_counter != counter)
    return SidecarRequest{Kind::kCounter, "PATCH", "/v1beta1/counters/players", counter};
  std::string list = R"({"capacity":)" + quoted(std::min(m_max_players, kMaxListed)) + R"(,"values":[)";
  for (std::size_t i = 0; i < std::min(m_players.size(), kMaxListed); ++i) {
    if (i > 0) list += ',';
    list += quoted(m_players[i]);
  }
  list += "]}";
  if (m_list != list) return SidecarRequest{Kind::kList, "PATCH", "/v1beta1/lists/players", list};
  return std::nullopt;
}

void AgonesRequestScheduler::onResponse(int status, const std::string& body, Time now) {
  if (!m_pending) return;
  const SidecarRequest asked = *std::exchange(m_pending, std::nullopt);
  const bool optional = asked.kind == Kind::kCounter || asked.kind == Kind::kList;
  const bool missing = optional && (status == kNotFound || status == kNotImplemented);
  if (missing && m_missing.find(asked.path) == std::string::npos)
    m_missing += (m_missing.empty() ? "" : ", ") + asked.path;
  if (!isGood(status) && !missing) {
    ++m_counters.failures;
    m_not_before = now + kRetryInterval;
    return;
  }
  m_not_before.reset();
  if (!missing && asked.kind != Kind::kFacts) ++m_counters.requests;
  switch (asked.kind) {
    case Kind::kReady:
      m_reported_state = ReportedState::kReady;
      break;
    case Kind::kAllocate:
      m_reported_state = ReportedState::kAllocated;
      break;
    case Kind::kHealth:
      ++m_counters.health;
      m_healthy = now;
      break;
    case Kind::kCounter:
      m_counter = asked.body;
      break;
    case Kind::kList:
      m_list = asked.body;
      break;
    case Kind::kFacts:
      handleFacts(body, now);
      break;
    case Kind::kShutdown:
      m_over = true;
      break;
  }
}

// If the facts are invalid, they are requested again later. Other requests do not wait for that.
void AgonesRequestScheduler::handleFacts(const std::string& body, Time now) {
  m_facts = GameServerInfo::parse(body, false);
  ++(m_facts ? m_counters.requests : m_counters.failures);
  if (!m_facts) m_facts_not_before = now + kRetryInterval;
}

}  // namespace naiad
