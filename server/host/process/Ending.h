// The end of a server that was asked for: at once, when its players have left, or so that it begins again.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace naiad {

/// Not thread-safe. Time is passed in.
class Ending {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Players hear of the end once more so long before it.
  static constexpr std::chrono::seconds kLastCall{10};
  /// Clients of a server that begins again look for it so long.
  static constexpr std::chrono::seconds kLookAgain{60};

  struct Plan {
    bool begins_again = false;    ///< restart: the goodbye tells clients to look for the server again
    std::optional<Time> at = {};  ///< then at the latest; nothing: no limit
    bool when_empty = false;      ///< as soon as no players are left
    bool at_round_end = false;    ///< when the round is over that is being played
    std::string sentence = {};    ///< the last one to players; empty: by what is planned
  };

  /// End so from now on. Replaces an earlier plan.
  void setPlan(Plan plan, Time now);
  /// Go on. False: nothing was planned.
  bool cancel();
  const std::optional<Plan>& plan() const { return m_plan; }
  /// May new players join? Not while the server waits for those who play to leave, and ends for good then.
  bool isOpen() const { return !m_plan || m_plan->begins_again || !(m_plan->when_empty || m_plan->at); }

  /// Is it time? `is_empty`: no players are left.
  bool isDue(Time now, bool is_empty) const;
  bool beginsAgain() const { return m_plan && m_plan->begins_again; }
  /// The last sentence to players; empty if nothing is planned.
  std::string sentence() const;
  /// The notice that players should get now, if any. Once a tick.
  std::optional<std::string> takeNews(Time now);

 private:
  std::string news(Time now) const;

  std::optional<Plan> m_plan;
  bool m_announced = false;
  bool m_last_call = false;
};

}  // namespace naiad
