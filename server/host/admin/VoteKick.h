// A vote among players to throw one out.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/admin/AdminPlayer.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/PerAddress.h"

namespace naiad {

/// One vote at a time. An IPv4 address or IPv6 /64 is one voter, however many play there: more than half of
/// the voters with a connection, and two at least, have to agree within kTime. Not thread-safe; time is
/// passed in.
class VoteKick {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds kTime{30};
  /// Between two votes that the same voter begins.
  static constexpr std::chrono::seconds kBetween{120};
  /// How long whoever is thrown out stays out.
  static constexpr std::chrono::minutes kOut{5};

  enum class Outcome {
    kBegun,    ///< this is the first voice
    kAgreed,   ///< one more voice, and not enough
    kPassed,   ///< the player goes now; the vote is over
    kAlready,  ///< this voter has agreed before
    kOther,    ///< a vote on another player is on
    kTooSoon,  ///< this voter began one a moment ago
    kSelf,     ///< of oneself, or somebody at the same address
  };

  /// The player with the session `voter` wants the one with the session `target` out.
  Outcome vote(const std::vector<AdminPlayer>& players, std::uint64_t voter, std::uint64_t target, Time now);
  /// A vote has found too few voices: on this session. Once.
  std::optional<std::uint64_t> takeFailed(Time now);
  /// Voices so far, and how many it takes; of the vote that is on, or has just passed.
  std::size_t voices() const { return m_voices.size(); }
  std::size_t needed() const { return m_needed; }

 private:
  void count(const std::vector<AdminPlayer>& players);

  std::optional<std::uint64_t> m_target;
  Time m_ends{};
  std::set<AddressPrefix> m_voices;
  std::size_t m_needed = 0;
  struct Begun {
    std::optional<Time> at;
  };
  PerAddress<Begun> m_begun{256};
};

}  // namespace naiad
