// A planned shutdown or restart: at a time, when all players have left, or at the end of the round.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace naiad {

/// Not thread-safe. Time is passed in.
class ShutdownScheduler {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Players get a last notice this long before the end.
  static constexpr std::chrono::seconds kFinalNotice{10};
  /// Clients try to reconnect to a restarting server for this long.
  static constexpr std::chrono::seconds kReconnectWindow{60};

  struct Plan {
    bool is_restart = false;      ///< a restart: the goodbye tells clients to look for the server again
    std::optional<Time> at = {};  ///< latest time of the end; nullopt: no limit
    bool when_empty = false;      ///< end as soon as no players are left
    bool at_round_end = false;    ///< end when the current round is over
    std::string sentence = {};    ///< last message to players; empty: a default one
  };

  /// Sets the plan. Replaces an earlier one.
  void setPlan(Plan plan, Time now);
  /// Cancels the plan. Returns false if there was none.
  bool cancel();
  const std::optional<Plan>& plan() const { return m_plan; }
  /// True if new players may join. False if the server ends for good at a set time or when all have left.
  bool acceptsPlayers() const { return !m_plan || m_plan->is_restart || !(m_plan->when_empty || m_plan->at); }

  /// True if it is time to end because of `at` or `when_empty`. `is_empty`: no players are left.
  bool isDue(Time now, bool is_empty) const;
  bool isRestart() const { return m_plan && m_plan->is_restart; }
  /// Returns the last message to players; empty if nothing is planned.
  std::string sentence() const;
  /// Returns the notice that players should get now, if any. Call once a tick.
  std::optional<std::string> popNotice(Time now);

 private:
  std::string notice(Time now) const;

  std::optional<Plan> m_plan;
  bool m_announced = false;
  bool m_final_notice_given = false;
};

}  // namespace naiad
