// The state that the connections of a gateway share.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "server/gateway/AllowedOrigins.h"
#include "server/gateway/GatewaySettings.h"
#include "server/gateway/HttpResponse.h"
#include "server/gateway/PageFiles.h"
#include "server/gateway/UpstreamLink.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/PrefixRateLimiter.h"
#include "shared/net/stream/HalfOpenLimit.h"
#include "shared/net/stream/ProxiedPeer.h"
#include "shared/program/ClientLog.h"

namespace naiad {

/// Limits the connections that do not play yet (HalfOpenLimit.h).
///
/// A connection is silent until it has sent a whole request, between requests, and as a WebSocket without a
/// hello. If no slot is free, the oldest silent connection of the most crowded prefix is evicted. A
/// connection is never evicted for another one while an answer is sent to it.
///
/// Not thread-safe. Must outlive its slots.
class PendingConnections {
 public:
  using Disconnect = std::function<void()>;

  /// A slot for a connection. Released by its destructor.
  class Slot {
   public:
    Slot() = default;
    Slot(Slot&& other) noexcept { swap(other); }
    Slot& operator=(Slot&& other) noexcept {
      Slot taken(std::move(other));
      swap(taken);
      return *this;
    }
    ~Slot();

    explicit operator bool() const { return m_owner != nullptr; }
    /// Marks the connection as busy after a whole request. Returns false if the connection's prefix has too
    /// many slots: then close the connection.
    [[nodiscard]] bool setBusy();
    /// Marks the connection as silent, and as the newest one.
    void setSilent();

   private:
    friend class PendingConnections;
    Slot(PendingConnections& owner, HalfOpenLimit::Id id, const AddressPrefix& prefix)
        : m_owner(&owner), m_id(id), m_prefix(prefix) {}
    void swap(Slot& other) noexcept {
      std::swap(m_owner, other.m_owner);
      std::swap(m_id, other.m_id);
      std::swap(m_prefix, other.m_prefix);
    }

    PendingConnections* m_owner = nullptr;
    HalfOpenLimit::Id m_id = 0;
    AddressPrefix m_prefix;
  };

  explicit PendingConnections(HalfOpenLimit::Limits limits) : m_limit(limits) {}

  /// Returns a slot for a connection from this prefix. `disconnect` must end the connection and release its
  /// slot before it returns. Returns an empty slot if none can be freed.
  Slot acquire(const AddressPrefix& prefix, Disconnect disconnect);
  /// Replaces the function that ends the connection. Call when the connection has become a WebSocket.
  void replace(const Slot& slot, Disconnect disconnect) { m_disconnects[slot.m_id] = std::move(disconnect); }

  /// Returns how many connections were evicted so far because another one needed a slot.
  std::uint64_t evicted() const { return m_evicted; }

 private:
  HalfOpenLimit::Id admit(const AddressPrefix& prefix, Disconnect disconnect);

  HalfOpenLimit m_limit;
  std::map<HalfOpenLimit::Id, Disconnect> m_disconnects;
  HalfOpenLimit::Id m_newest = 0;
  std::uint64_t m_evicted = 0;
};

/// Limits the WebSockets that play: in all, and from one IPv4 address or IPv6 /64.
/// Not thread-safe. Must outlive its slots.
class VisitorSlots {
 public:
  /// A slot, released when the last copy of this pointer is destroyed. Null: no slot.
  using Slot = std::shared_ptr<VisitorSlots>;

  VisitorSlots(std::size_t total, std::size_t max_per_prefix)
      : m_max_total(total), m_max_per_prefix(max_per_prefix) {}

  /// Returns null if no slot is free, in all or for this prefix.
  Slot acquire(const AddressPrefix& prefix) {
    if (m_count >= m_max_total) return {};
    std::size_t& here = m_by_prefix[prefix];
    if (here >= m_max_per_prefix) return {};
    ++here;
    ++m_count;
    return {this, [prefix](VisitorSlots* p_slots) { p_slots->release(prefix); }};
  }

 private:
  void release(const AddressPrefix& prefix) {
    --m_count;
    const auto found = m_by_prefix.find(prefix);
    if (--found->second == 0) m_by_prefix.erase(found);
  }

  std::size_t m_max_total;
  std::size_t m_max_per_prefix;
  std::size_t m_count = 0;
  std::map<AddressPrefix, std::size_t> m_by_prefix;
};

class GatewayConnections;

/// A connection to the gateway: a browser that reads the page, or one stream of a player.
///
/// Each connection has one deadline. A periodic sweep checks all deadlines, so messages need no timers.
/// Make it with std::make_shared: pending handlers keep it alive.
class GatewayConnection : public std::enable_shared_from_this<GatewayConnection> {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Keeps `connections` alive.
  explicit GatewayConnection(std::shared_ptr<GatewayConnections> connections);
  virtual ~GatewayConnection();
  GatewayConnection(const GatewayConnection&) = delete;
  GatewayConnection& operator=(const GatewayConnection&) = delete;

  /// Called when the deadline has passed.
  virtual void onDeadline() = 0;
  /// Ends the connection because the gateway stops, with a close message if possible.
  virtual void shutDown() = 0;
  /// Ends the connection at once. Its slots are released when this returns.
  virtual void disconnect() = 0;

  /// Called ten times a second. Calls onDeadline() when the deadline has passed.
  virtual void onSweep(Time now) {
    if (m_deadline <= now) onDeadline();
  }

 protected:
  void setDeadline(std::chrono::milliseconds time) { m_deadline = std::chrono::steady_clock::now() + time; }
  void clearDeadline() { m_deadline = Time::max(); }
  template <class Self>
  static std::shared_ptr<Self> sharedFrom(Self* self) {
    return std::static_pointer_cast<Self>(self->shared_from_this());
  }

 private:
  std::shared_ptr<GatewayConnections> m_connections;
  Time m_deadline = Time::max();
};

/// All connections of a gateway.
class GatewayConnections {
 public:
  void sweep(GatewayConnection::Time now) {
    for (const auto& connection : list()) connection->onSweep(now);
  }
  void shutDown() {
    for (const auto& connection : list()) connection->shutDown();
  }
  void disconnect() {
    for (const auto& connection : list()) connection->disconnect();
  }
  std::size_t count() const { return m_all.size(); }

 private:
  friend class GatewayConnection;
  /// Returns all connections, to keep them alive in a loop. Skips connections that are being destroyed.
  std::vector<std::shared_ptr<GatewayConnection>> list() const {
    std::vector<std::shared_ptr<GatewayConnection>> all;
    all.reserve(m_all.size());
    for (GatewayConnection* const connection : m_all) {
      if (auto alive = connection->weak_from_this().lock()) all.push_back(std::move(alive));
    }
    return all;
  }

  std::unordered_set<GatewayConnection*> m_all;
};

inline GatewayConnection::GatewayConnection(std::shared_ptr<GatewayConnections> connections)
    : m_connections(std::move(connections)) {
  m_connections->m_all.insert(this);
}

inline GatewayConnection::~GatewayConnection() {
  m_connections->m_all.erase(this);
}

/// Use on the gateway's thread. Each GatewayConnection keeps this state alive.
struct GatewayState : std::enable_shared_from_this<GatewayState> {
  GatewayState(GatewaySettings given, const AllowedOrigins& allowed, LogLine line);

  /// Returns `connections`, for the constructor of a GatewayConnection.
  std::shared_ptr<GatewayConnections> sharedConnections() { return {shared_from_this(), &connections}; }

  const GatewaySettings settings;
  const AllowedOrigins origins;
  const PageFiles page;
  const HttpResponses responses;
  const GameServer server;
  std::shared_ptr<const TlsContext> tls;  ///< TLS for browsers; null: plain HTTP
  GatewayCounters counters;
  ClientLog log;
  PrefixRateLimiter arrivals;
  PendingConnections pending;
  VisitorSlots places;
  GatewayConnections connections;
};

}  // namespace naiad
