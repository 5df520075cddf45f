// What a server has to say to the sidecar of Agones, and when: requests one after the other, each until it
// was answered well. Time is passed in; AgonesPlatform.h makes the requests.
//
// Source: the interface's published description (sdk.swagger.json, beta.swagger.json of Agones).
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/fleet/GameServerFacts.h"
#include "host/fleet/HostPlatform.h"

namespace naiad {

/// "POST /ready {}".
struct SidecarRequest {
  enum class Kind { kReady, kAllocate, kHealth, kCounter, kList, kFacts, kShutdown } kind = Kind::kFacts;
  std::string method;
  std::string path;
  std::string body;  ///< JSON; empty for GET
};

/// Not thread-safe.
class SidecarDuties {
 public:
  using Time = HostPlatform::Clock::time_point;

  /// Between two tries after a failure: the sidecar may start after the server.
  static constexpr std::chrono::milliseconds kRetry{500};
  /// Between two words of health, if the sidecar does not say how often it wants one.
  static constexpr std::chrono::milliseconds kHealth{2500};
  /// Of the list of players: more are counted, and not listed.
  static constexpr std::size_t kMaxListed = 1000;

  // What is so now.

  void setReady() { m_ready = true; }
  void noteTick(Time now) { m_ticked = now; }
  void setPlayers(const PlatformPlayers& players);
  void setEnding() { m_ending = true; }

  /// What to say now; nothing if there is nothing, or the last one was not answered yet.
  std::optional<SidecarRequest> next(Time now);
  /// The answer to the last one: an HTTP status, or 0 if there was none.
  void onAnswer(int status, const std::string& body, Time now);
  /// When to ask next() again at the latest.
  Time wake() const { return m_wake; }
  /// The last word was answered.
  bool isOver() const { return m_over; }

  const PlatformCounters& counters() const { return m_counters; }
  /// What the sidecar said of the server; nothing before.
  const std::optional<GameServerFacts>& facts() const { return m_facts; }
  /// Counters or lists that the server's resource does not have.
  const std::string& missing() const { return m_missing; }

 private:
  enum class Said { kNothing, kReady, kAllocated };

  std::optional<SidecarRequest> choose(Time now) const;
  void takeFacts(const std::string& body, Time now);
  std::chrono::milliseconds healthTime() const;

  bool m_ready = false;
  bool m_ending = false;
  bool m_over = false;
  std::optional<Time> m_ticked;
  std::vector<std::uint32_t> m_players;
  std::size_t m_most = 0;
  Said m_said = Said::kNothing;
  std::optional<Time> m_healthy;  ///< said last
  std::string m_counter;          ///< body that was answered well last
  std::string m_list;
  std::string m_missing;
  std::optional<GameServerFacts> m_facts;
  std::optional<SidecarRequest> m_asked;  ///< not answered yet
  std::optional<Time> m_not_before;       ///< after a failure
  Time m_facts_not_before{};              ///< after facts that could not be read
  Time m_wake{};
  PlatformCounters m_counters;
};

}  // namespace naiad
