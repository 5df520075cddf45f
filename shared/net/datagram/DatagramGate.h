// The server's entry for datagrams: finds the session of a packet, and keeps floods away from the
// cryptography. What is refused is counted, and never answered.
//
// The order is: length, kind, connection id, replay window, token buckets, authentication. A forged packet
// without a known connection id costs one look-up. One with it spends tokens of all unproven addresses, of
// which that session and that prefix have a share each. Packets from a session's proven path use that
// session's own bucket, which no other address can empty.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string_view>
#include <unordered_map>

#include "shared/net/base/PerAddress.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/datagram/Path.h"
#include "shared/net/datagram/SealedLink.h"

namespace naiad {

/// Every packet is counted once: delivered, refused by its link (whose counters say why), or one of the
/// others.
struct DatagramGateCounters {
  std::uint64_t delivered = 0;
  std::uint64_t too_short = 0;
  std::uint64_t too_long = 0;
  std::uint64_t bad_kind = 0;
  std::uint64_t unknown_id = 0;
  std::uint64_t session_flood = 0;   ///< a session sends more than its allowance
  std::uint64_t claimed_flood = 0;   ///< more for one session from unproven addresses than its share
  std::uint64_t prefix_flood = 0;    ///< more from one unproven prefix than its share
  std::uint64_t stranger_flood = 0;  ///< more from unproven addresses in all than is allowed
  std::uint64_t refused = 0;         ///< by the link
};

/// Packets per second and at once that may reach the authentication.
struct DatagramGateRates {
  BucketRate session{.per_second = 250, .burst = 500};      ///< each session, from its proven path
  BucketRate claimed{.per_second = 32, .burst = 64};        ///< for each session, from elsewhere
  BucketRate prefix{.per_second = 500, .burst = 500};       ///< each unproven prefix
  BucketRate strangers{.per_second = 4000, .burst = 1000};  ///< unproven addresses in all
};

/// Not thread-safe. Times are of one monotonic clock.
class DatagramGate {
 public:
  using Time = SealedLink::Time;
  /// An authentic payload, valid during the call. The callee may add and remove sessions, its own too.
  using OnPayload = std::function<void(std::string_view payload)>;

  /// Unproven prefixes whose allowance is remembered.
  static constexpr std::size_t kPrefixes = 4096;

  explicit DatagramGate(DatagramGateRates rates = {}) : rates_(rates) {}

  /// Packets with the link's id go through `link` (a server's), which must live until removed. False, and
  /// nothing changes, if there is such an id already: draw another.
  bool add(SealedLink& link, OnPayload on_payload);
  void remove(ConnectionId id);
  bool has(ConnectionId id) const { return doors_.contains(id); }

  /// A packet arrived.
  void receive(const Path& path, std::string_view packet, Time now);

  const DatagramGateCounters& counters() const { return counters_; }

 private:
  struct Door {
    SealedLink* link = nullptr;
    OnPayload on_payload;
    TokenBucket own;
    TokenBucket claimed;
  };

  bool allowed(Door& door, const Path& path, Time now);

  DatagramGateRates rates_;
  using Doors = std::unordered_map<ConnectionId, Door>;

  Doors doors_;
  const Door* open_ = nullptr;  ///< whose payload is being delivered
  Doors::node_type leaving_;    ///< the same, if it was removed meanwhile
  PerAddress<TokenBucket> prefixes_{kPrefixes};
  TokenBucket strangers_;
  DatagramGateCounters counters_;
};

}  // namespace naiad
