// How often something may happen from one address, and from its network, whoever does it.
//
// What a connection or session may do is limited for each of them, and a client that comes again has a new
// one. These limits stay: they belong to the address. A client with many addresses shares those of its
// network.
#pragma once

#include <cstddef>
#include <optional>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/PerAddress.h"
#include "shared/net/base/TokenBucket.h"

namespace naiad {

/// Not thread-safe. Time is passed in. Memory is bounded: the prefixes and networks used last are remembered.
class PrefixAllowance {
 public:
  using Time = TokenBucket::Time;

  struct Rates {
    BucketRate of_a_prefix;            ///< an IPv4 address or an IPv6 /64
    BucketRate of_a_network;           ///< the /24 or /48 that it is in
    std::optional<BucketRate> in_all;  ///< nothing: no limit
  };
  static constexpr std::size_t kPrefixes = 1024;  ///< that are remembered, and as many networks

  explicit PrefixAllowance(const Rates& rates) : m_rates(rates) {}

  /// May it happen once more? Then it counts.
  bool take(const AddressPrefix& prefix, Time now) {
    // The narrowest first: what is over its own limit takes nothing from the others.
    return m_prefixes.use(prefix).takeToken(m_rates.of_a_prefix, now) &&
           m_networks.use(prefix.widest()).takeToken(m_rates.of_a_network, now) &&
           (!m_rates.in_all || m_all.takeToken(*m_rates.in_all, now));
  }

  /// Would take() say so now? Nothing is counted.
  bool has(const AddressPrefix& prefix, Time now) {
    TokenBucket* const p_prefix = m_prefixes.find(prefix);
    TokenBucket* const p_network = m_networks.find(prefix.widest());
    return (p_prefix == nullptr || p_prefix->hasToken(m_rates.of_a_prefix, now)) &&
           (p_network == nullptr || p_network->hasToken(m_rates.of_a_network, now)) &&
           (!m_rates.in_all || m_all.hasToken(*m_rates.in_all, now));
  }

 private:
  Rates m_rates;
  PerAddress<TokenBucket> m_prefixes{kPrefixes};
  PerAddress<TokenBucket> m_networks{kPrefixes};
  TokenBucket m_all;
};

/// The allowances of a server that lets so many players in from one address.
struct PrefixRates {
  /// TLS handshakes. A class that comes twice at once, each time with second streams; then one of each in
  /// eight seconds.
  static PrefixAllowance::Rates handshakes(int max_per_address) {
    const double crowd = classSize(max_per_address);
    return {{crowd / 8, 4 * crowd}, {crowd / 2, 16 * crowd}, std::nullopt};
  }
  /// A class that joins, leaves and joins again at once; then two in a second.
  static PrefixAllowance::Rates joins(int max_per_address) {
    const double crowd = classSize(max_per_address);
    return {{2, 2 * crowd}, {8, 8 * crowd}, std::nullopt};
  }
  /// Private worlds, each a process to start: the same class, then one in a second.
  static PrefixAllowance::Rates worlds(int max_per_address, int max_players) {
    const double crowd = classSize(max_per_address);
    return {{1, 2 * crowd}, {4, 8 * crowd}, BucketRate{8, 2.0 * max_players}};
  }
  /// Rooms that are woken, each a process to start: a few at once, then one in a second.
  static PrefixAllowance::Rates wakes() { return {{1, 4}, {4, 16}, BucketRate{8, 64}}; }
  /// Moves to another room, each a world to send: of a class, all at once through one door.
  static PrefixAllowance::Rates moves(int max_per_address) {
    const double crowd = classSize(max_per_address);
    return {{crowd / 4, 3 * crowd}, {crowd, 12 * crowd}, std::nullopt};
  }
  /// Lines of chat: three at once from each player of a class, and one of each in four seconds.
  static PrefixAllowance::Rates chat(int max_per_address) {
    const double crowd = classSize(max_per_address);
    return {{crowd / 4, 3 * crowd}, {crowd, 12 * crowd}, std::nullopt};
  }

 private:
  static double classSize(int max_per_address) { return max_per_address > 64 ? max_per_address : 64; }
};

}  // namespace naiad
