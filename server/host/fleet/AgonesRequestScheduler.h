// Decides which request the Agones sidecar gets next, and when: one at a time, each repeated until it
// succeeds or the sidecar does not support it. Callers pass the time; AgonesPlatform.h sends the requests.
//
// Source: the interface's published description (sdk.swagger.json, beta.swagger.json of Agones).
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/fleet/GameServerInfo.h"
#include "host/fleet/HostPlatform.h"

namespace naiad {

/// A request like "POST /ready {}".
struct SidecarRequest {
  enum class Kind { kReady, kAllocate, kHealth, kCounter, kList, kFacts, kShutdown } kind = Kind::kFacts;
  std::string method;
  std::string path;
  std::string body;  ///< JSON; empty for GET
};

/// Not thread-safe.
class AgonesRequestScheduler {
 public:
  using Time = HostPlatform::Clock::time_point;

  /// Retry interval: the sidecar may start after the server.
  static constexpr std::chrono::milliseconds kRetryInterval{500};
  /// Default interval of health requests, if the sidecar does not give one.
  static constexpr std::chrono::milliseconds kHealth{2500};
  /// Maximum length of the list of players; further players are only counted.
  static constexpr std::size_t kMaxListed = 1000;

  // The current state of the server.

  void setReady() { m_ready = true; }
  void onTick(Time now) { m_ticked = now; }
  void setPlayers(const PlatformPlayers& players);
  void setEnding() { m_ending = true; }

  /// Returns the request to send now; nullopt if none is due or one is not answered yet.
  std::optional<SidecarRequest> next(Time now);
  /// Handles the response to the last request. `status`: HTTP status, or 0 without a response.
  void onResponse(int status, const std::string& body, Time now);
  /// Call next() again at this time, at the latest.
  Time wake() const { return m_wake; }
  /// True if the shutdown request has succeeded.
  bool isOver() const { return m_over; }

  const PlatformCounters& counters() const { return m_counters; }
  /// The sidecar's facts about the server; nullopt if not known yet.
  const std::optional<GameServerInfo>& facts() const { return m_facts; }
  /// Paths of counters or lists that the server's resource does not have, separated by commas.
  const std::string& missing() const { return m_missing; }

 private:
  enum class ReportedState { kNothing, kReady, kAllocated };

  std::optional<SidecarRequest> choose(Time now) const;
  void handleFacts(const std::string& body, Time now);
  std::chrono::milliseconds healthTime() const;

  bool m_ready = false;
  bool m_ending = false;
  bool m_over = false;
  std::optional<Time> m_ticked;
  std::vector<std::uint32_t> m_players;
  std::size_t m_max_players = 0;
  ReportedState m_reported_state = ReportedState::kNothing;
  std::optional<Time> m_healthy;  ///< time of the last successful health request
  std::string m_counter;          ///< body of the last counter request that succeeded or was unsupported
  std::string m_list;             ///< body of the last list request that succeeded or was unsupported
  std::string m_missing;
  std::optional<GameServerInfo> m_facts;
  std::optional<SidecarRequest> m_pending;  ///< request that is not answered yet
  std::optional<Time> m_not_before;         ///< time of the next attempt after a failure
  Time m_facts_not_before{};                ///< time of the next attempt after invalid facts
  Time m_wake{};
  PlatformCounters m_counters;
};

}  // namespace naiad
