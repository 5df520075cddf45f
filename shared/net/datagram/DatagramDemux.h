// The server's entry for datagrams: finds the session of each packet and protects the decryption from floods.
// Refused packets are counted and never answered.
//
// The order of checks is: length, kind, connection id, replay window, token buckets, authentication. A forged
// packet without a known connection id costs one look-up. One with a known id spends tokens shared by all
// unproven addresses, of which each session and each prefix may use only a part. Packets from a session's
// proven path use the session's own bucket, which no other address can empty.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string_view>
#include <unordered_map>

#include "shared/net/base/PrefixLruMap.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/datagram/Path.h"
#include "shared/net/datagram/SealedLink.h"

namespace naiad {

/// Every packet is counted once: as delivered, as refused by its link (whose counters give the reason), or in
/// one of the other counters. The rates are named as in DatagramDemuxRates.
struct DatagramDemuxCounters {
  std::uint64_t delivered = 0;
  std::uint64_t too_short = 0;
  std::uint64_t too_long = 0;
  std::uint64_t bad_kind = 0;
  std::uint64_t unknown_id = 0;
  std::uint64_t session_flood = 0;  ///< over the rate `session`: too many from a session's proven path
  std::uint64_t unvalidated_session_flood =
      0;                                ///< over the rate `claimed`: for one session, from unproven addresses
  std::uint64_t prefix_flood = 0;       ///< over the rate `prefix`: too many from one unproven prefix
  std::uint64_t unvalidated_flood = 0;  ///< over the rate `strangers`: from all unproven addresses
  std::uint64_t refused = 0;            ///< refused by the link
};

/// Packets per second and burst that may reach the authentication.
struct DatagramDemuxRates {
  BucketRate session{.per_second = 250, .burst = 500};      ///< each session, from its proven path
  BucketRate claimed{.per_second = 32, .burst = 64};        ///< each session, from unproven addresses
  BucketRate prefix{.per_second = 500, .burst = 500};       ///< each unproven prefix
  BucketRate strangers{.per_second = 4000, .burst = 1000};  ///< all unproven addresses together
};

/// Not thread-safe. All times come from one monotonic clock.
class DatagramDemux {
 public:
  using Time = SealedLink::Time;
  /// Receives an authentic payload, valid during the call. May add and remove sessions, including its own.
  using OnPayload = std::function<void(std::string_view payload)>;

  /// Maximum number of unproven prefixes whose buckets are remembered.
  static constexpr std::size_t kPrefixes = 4096;

  explicit DatagramDemux(DatagramDemuxRates rates = {}) : rates_(rates) {}

  /// Adds a server's link, which handles packets with its id and must live until it is removed. Returns false
  /// and changes nothing if the id is in use; then retry with another id.
  bool add(SealedLink& link, OnPayload on_payload);
  void remove(ConnectionId id);
  bool has(ConnectionId id) const { return registrations_.contains(id); }

  void receive(const Path& path, std::string_view packet, Time now);

  const DatagramDemuxCounters& counters() const { return counters_; }

 private:
  struct Registration {
    SealedLink* link = nullptr;
    OnPayload on_payload;
    TokenBucket own;
    TokenBucket claimed;
  };

  bool allowed(Registration& door, const Path& path, Time now);

  DatagramDemuxRates rates_;
  using Registrations = std::unordered_map<ConnectionId, Registration>;

  Registrations registrations_;
  const Registration* open_ = nullptr;  ///< session whose payload is being delivered
  Registrations::node_type leaving_;    ///< keeps that session if its callback removes it
  PrefixLruMap<TokenBucket> prefixes_{kPrefixes};
  TokenBucket strangers_;
  DatagramDemuxCounters counters_;
};

}  // namespace naiad
