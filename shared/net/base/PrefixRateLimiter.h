// Rate limits for an address and for its network.
//
// Limits per connection restart when a client reconnects; the limits here belong to the address. A client
// with many addresses shares the limits of its network.
#pragma once

#include <cstddef>
#include <optional>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/PrefixLruMap.h"
#include "shared/net/base/TokenBucket.h"

namespace naiad {

/// Not thread-safe. Callers pass the time. Remembers only the most recently used prefixes and networks.
class PrefixRateLimiter {
 public:
  using Time = TokenBucket::Time;

  struct Rates {
    BucketRate per_prefix;            ///< rate of each IPv4 address or IPv6 /64
    BucketRate per_network;           ///< rate of each IPv4 /24 or IPv6 /48
    std::optional<BucketRate> total;  ///< rate of all together; nullopt: no limit
  };
  static constexpr std::size_t kPrefixes = 1024;  ///< maximum remembered prefixes, and also networks

  explicit PrefixRateLimiter(const Rates& rates) : m_rates(rates) {}

  /// Counts an event and returns true, or returns false if the event would exceed a limit. Narrower limits
  /// than that one count the event even then.
  bool tryConsume(const AddressPrefix& prefix, Time now) {
    // Narrowest first, so that an event over its prefix's limit does not consume tokens of the wider ones.
    return m_prefixes.use(prefix).tryConsume(m_rates.per_prefix, now) &&
           m_networks.use(prefix.widest()).tryConsume(m_rates.per_network, now) &&
           (!m_rates.total || m_all.tryConsume(*m_rates.total, now));
  }

  /// Returns the value that tryConsume() would return now, without counting.
  bool canConsume(const AddressPrefix& prefix, Time now) {
    TokenBucket* const p_prefix = m_prefixes.find(prefix);
    TokenBucket* const p_network = m_networks.find(prefix.widest());
    return (p_prefix == nullptr || p_prefix->canConsume(m_rates.per_prefix, now)) &&
           (p_network == nullptr || p_network->canConsume(m_rates.per_network, now)) &&
           (!m_rates.total || m_all.canConsume(*m_rates.total, now));
  }

 private:
  Rates m_rates;
  PrefixLruMap<TokenBucket> m_prefixes{kPrefixes};
  PrefixLruMap<TokenBucket> m_networks{kPrefixes};
  TokenBucket m_all;
};

/// The rates of a server that accepts `max_per_address` players per address. Bursts are sized for a school
/// class behind one address: this many players, but at least 64.
struct RateLimits {
  /// TLS handshakes. Burst: a class connects twice, with second streams. Then: one per player in 8 seconds.
  static PrefixRateLimiter::Rates handshakes(int max_per_address) {
    const double crowd = classSize(max_per_address);
    return {{crowd / 8, 4 * crowd}, {crowd / 2, 16 * crowd}, std::nullopt};
  }
  /// Joins. Burst: a class joins, leaves and joins again. After it: two a second.
  static PrefixRateLimiter::Rates joins(int max_per_address) {
    const double crowd = classSize(max_per_address);
    return {{2, 2 * crowd}, {8, 8 * crowd}, std::nullopt};
  }
  /// Private worlds, each a new process. Burst: two per player of a class. After it: one a second.
  static PrefixRateLimiter::Rates worlds(int max_per_address, int max_players) {
    const double crowd = classSize(max_per_address);
    return {{1, 2 * crowd}, {4, 8 * crowd}, BucketRate{8, 2.0 * max_players}};
  }
  /// Wake-ups of rooms, each a new process. Burst: four. After it: one a second.
  static PrefixRateLimiter::Rates wakes() { return {{1, 4}, {4, 16}, BucketRate{8, 64}}; }
  /// Moves to another room, each of which sends a world. Burst: three per player of a class, for example
  /// through one door of a lobby. After it: one per player in four seconds.
  static PrefixRateLimiter::Rates moves(int max_per_address) {
    const double crowd = classSize(max_per_address);
    return {{crowd / 4, 3 * crowd}, {crowd, 12 * crowd}, std::nullopt};
  }
  /// Chat lines. Burst: three per player of a class. After it: one per player in four seconds.
  static PrefixRateLimiter::Rates chat(int max_per_address) {
    const double crowd = classSize(max_per_address);
    return {{crowd / 4, 3 * crowd}, {crowd, 12 * crowd}, std::nullopt};
  }

 private:
  static double classSize(int max_per_address) { return max_per_address > 64 ? max_per_address : 64; }
};

}  // namespace naiad
