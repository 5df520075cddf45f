// A vote among players to kick one of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/admin/AdminPlayer.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/PrefixLruMap.h"

namespace naiad {

/// Runs one vote at a time. Players of an IPv4 address or IPv6 /64 are one voter. A vote passes if over half
/// of the connected voters, and at least two, agree within kTime. Not thread-safe. Time is a parameter.
class VoteKick {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds kTime{30};
  /// Minimum time between votes begun by one voter.
  static constexpr std::chrono::seconds kMinInterval{120};
  /// Ban time after a vote that passed.
  static constexpr std::chrono::minutes kBanTime{5};

  enum class Outcome {
    kBegun,    ///< the vote has begun
    kAgreed,   ///< one more voter agrees, not enough yet
    kPassed,   ///< enough voters agree; the vote is over
    kAlready,  ///< this voter has already agreed to the vote
    kOther,    ///< a vote on another player is running
    kTooSoon,  ///< this voter began a vote less than kMinInterval ago
    kSelf,     ///< the target is at the voter's own address, or one of the two players is gone
  };

  /// Begins a vote to kick a player, or agrees to the running one. `voter` and `target` are session ids.
  Outcome vote(const std::vector<AdminPlayer>& players, std::uint64_t voter, std::uint64_t target, Time now) {
    const AdminPlayer* const p_voter = findSession(players, voter);
    const AdminPlayer* const p_target = findSession(players, target);
    if (p_voter == nullptr || p_target == nullptr) return Outcome::kSelf;
    const AddressPrefix voice = voterAt(*p_voter);
    if (voice == voterAt(*p_target)) return Outcome::kSelf;
    if (m_target && now >= m_ends) m_target.reset();
    const bool begins = !m_target;
    if (begins) {
      LastVote& begun = m_last_votes.use(voice);
      if (begun.at && now - *begun.at < kMinInterval) return Outcome::kTooSoon;
      begun.at = now;
      m_target = target;
      m_ends = now + kTime;
      m_votes.clear();
    }
    if (*m_target != target) return Outcome::kOther;
    const bool is_new = m_votes.insert(voice).second;
    count(players);
    if (m_votes.size() >= m_needed) {
      m_target.reset();
      return Outcome::kPassed;
    }
    return begins ? Outcome::kBegun : is_new ? Outcome::kAgreed : Outcome::kAlready;
  }
  /// Returns, once, the target's session id if the vote has failed because its time is over.
  std::optional<std::uint64_t> popFailed(Time now) {
    if (!m_target || now < m_ends) return std::nullopt;
    const std::uint64_t target = *m_target;
    m_target.reset();
    return target;
  }
  /// Number of voters that agree to the current vote, or to the one that just passed, and the number needed.
  std::size_t votes() const { return m_votes.size(); }
  std::size_t needed() const { return m_needed; }

 private:
  static AddressPrefix voterAt(const AdminPlayer& player) {
    return AddressPrefix::ofEndpoint(player.address).value_or(AddressPrefix());
  }
  static const AdminPlayer* findSession(const std::vector<AdminPlayer>& players, std::uint64_t session) {
    const auto found = std::find_if(players.begin(), players.end(), [session](const AdminPlayer& player) {
      return player.session == session;
    });
    return found != players.end() ? &*found : nullptr;
  }
  void count(const std::vector<AdminPlayer>& players) {
    // Voters that have left or lost the connection since they agreed do not count.
    std::set<AddressPrefix> voters;
    for (const AdminPlayer& player : players) {
      if (!player.detached) voters.insert(voterAt(player));
    }
    std::erase_if(m_votes, [&voters](const AddressPrefix& voice) { return !voters.contains(voice); });
    m_needed = std::max<std::size_t>(2, voters.size() / 2 + 1);
  }

  std::optional<std::uint64_t> m_target;
  Time m_ends{};
  std::set<AddressPrefix> m_votes;
  std::size_t m_needed = 0;
  struct LastVote {
    std::optional<Time> at;
  };
  PrefixLruMap<LastVote> m_last_votes{256};
};

}  // namespace naiad
