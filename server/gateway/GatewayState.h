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

#include "server/gateway/AllowedNames.h"
#include "server/gateway/GameLink.h"
#include "server/gateway/GatewaySettings.h"
#include "server/gateway/HttpAnswer.h"
#include "server/gateway/PageFiles.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/PrefixAllowance.h"
#include "shared/net/stream/HalfOpenLimit.h"
#include "shared/net/stream/VisitorFacts.h"
#include "shared/program/ClientLog.h"

namespace naiad {

/// Limits the connections that do not play yet (HalfOpenLimit.h).
///
/// A connection is silent until it has sent a whole request, between requests, and as a WebSocket without a
/// hello. If no place is free, the oldest silent connection of the most crowded prefix is ended. A connection
/// is never ended for another one while an answer is sent to it.
///
/// Not thread-safe. Must outlive its places.
class Newcomers {
 public:
  using HangUp = std::function<void()>;

  /// A place for a connection. Released by its destructor.
  class Place {
   public:
    Place() = default;
    Place(Place&& other) noexcept { swap(other); }
    Place& operator=(Place&& other) noexcept {
      Place taken(std::move(other));
      swap(taken);
      return *this;
    }
    ~Place();

    explicit operator bool() const { return m_owner != nullptr; }
    /// Marks the connection as busy after a whole request. False: its prefix has too many places; close it.
    [[nodiscard]] bool setBusy();
    /// Marks the connection as silent, and as the youngest one.
    void setSilent();

   private:
    friend class Newcomers;
    Place(Newcomers& owner, HalfOpenLimit::Id id, const AddressPrefix& prefix)
        : m_owner(&owner), m_id(id), m_prefix(prefix) {}
    void swap(Place& other) noexcept {
      std::swap(m_owner, other.m_owner);
      std::swap(m_id, other.m_id);
      std::swap(m_prefix, other.m_prefix);
    }

    Newcomers* m_owner = nullptr;
    HalfOpenLimit::Id m_id = 0;
    AddressPrefix m_prefix;
  };

  explicit Newcomers(HalfOpenLimit::Limits limits) : m_limit(limits) {}

  /// Returns a place for a connection from this prefix. `hang_up` must end the connection and release its
  /// place before it returns. Returns an empty place if none can be freed.
  Place take(const AddressPrefix& prefix, HangUp hang_up);
  /// Replaces the function that ends the connection, for one that became a WebSocket.
  void replace(const Place& place, HangUp hang_up) { m_hang_ups[place.m_id] = std::move(hang_up); }

  /// Number of connections that were ended for another one.
  std::uint64_t ended() const { return m_ended; }

 private:
  HalfOpenLimit::Id admit(const AddressPrefix& prefix, HangUp hang_up);

  HalfOpenLimit m_limit;
  std::map<HalfOpenLimit::Id, HangUp> m_hang_ups;
  HalfOpenLimit::Id m_newest = 0;
  std::uint64_t m_ended = 0;
};

/// Limits the WebSockets that play: in all, and from one IPv4 address or IPv6 /64.
/// Not thread-safe. Must outlive its places.
class VisitorPlaces {
 public:
  /// A place. The last copy releases it; null: none.
  using Place = std::shared_ptr<VisitorPlaces>;

  VisitorPlaces(std::size_t in_all, std::size_t per_prefix) : m_in_all(in_all), m_per_prefix(per_prefix) {}

  /// Returns null if no place is free, in all or for this prefix.
  Place take(const AddressPrefix& prefix) {
    if (m_count >= m_in_all) return {};
    std::size_t& here = m_by_prefix[prefix];
    if (here >= m_per_prefix) return {};
    ++here;
    ++m_count;
    return {this, [prefix](VisitorPlaces* p_places) { p_places->giveBack(prefix); }};
  }

 private:
  void giveBack(const AddressPrefix& prefix) {
    --m_count;
    const auto found = m_by_prefix.find(prefix);
    if (--found->second == 0) m_by_prefix.erase(found);
  }

  std::size_t m_in_all;
  std::size_t m_per_prefix;
  std::size_t m_count = 0;
  std::map<AddressPrefix, std::size_t> m_by_prefix;
};

class Guests;

/// A connection to the gateway: a browser that reads the page, or one stream of a player.
///
/// Each has one deadline. A periodic sweep checks all of them, so messages need no timers of their own.
/// Make it with std::make_shared: pending handlers keep it alive.
class Guest : public std::enable_shared_from_this<Guest> {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Keeps `guests` alive.
  explicit Guest(std::shared_ptr<Guests> guests);
  virtual ~Guest();
  Guest(const Guest&) = delete;
  Guest& operator=(const Guest&) = delete;

  /// Called when the deadline has passed.
  virtual void onDeadline() = 0;
  /// Ends the connection because the gateway stops, with a goodbye if possible.
  virtual void endService() = 0;
  /// Ends the connection at once. Its places are released when this returns.
  virtual void hangUp() = 0;

  /// Called ten times a second. Calls onDeadline() when the deadline has passed.
  virtual void onSweep(Time now) {
    if (m_deadline <= now) onDeadline();
  }

 protected:
  void setTime(std::chrono::milliseconds time) { m_deadline = std::chrono::steady_clock::now() + time; }
  void setNoTime() { m_deadline = Time::max(); }
  template <class Self>
  static std::shared_ptr<Self> sharedFrom(Self* self) {
    return std::static_pointer_cast<Self>(self->shared_from_this());
  }

 private:
  std::shared_ptr<Guests> m_guests;
  Time m_deadline = Time::max();
};

/// All connections of a gateway.
class Guests {
 public:
  void sweep(Guest::Time now) {
    for (const auto& guest : list()) guest->onSweep(now);
  }
  void endService() {
    for (const auto& guest : list()) guest->endService();
  }
  void hangUp() {
    for (const auto& guest : list()) guest->hangUp();
  }
  std::size_t count() const { return m_all.size(); }

 private:
  friend class Guest;
  /// Returns all guests, to keep them alive in a loop. Skips guests that are being destroyed.
  std::vector<std::shared_ptr<Guest>> list() const {
    std::vector<std::shared_ptr<Guest>> all;
    all.reserve(m_all.size());
    for (Guest* const guest : m_all) {
      if (auto alive = guest->weak_from_this().lock()) all.push_back(std::move(alive));
    }
    return all;
  }

  std::unordered_set<Guest*> m_all;
};

inline Guest::Guest(std::shared_ptr<Guests> guests) : m_guests(std::move(guests)) {
  m_guests->m_all.insert(this);
}

inline Guest::~Guest() {
  m_guests->m_all.erase(this);
}

/// Thread: the gateway's. Guests keep it alive.
struct GatewayState : std::enable_shared_from_this<GatewayState> {
  GatewayState(GatewaySettings given, const AllowedNames& allowed, LogLine line);

  /// Returns `guests`, for the constructor of a Guest.
  std::shared_ptr<Guests> sharedGuests() { return {shared_from_this(), &guests}; }

  const GatewaySettings settings;
  const AllowedNames names;
  const PageFiles page;
  const HttpAnswers answers;
  const GameServer server;
  std::shared_ptr<const TlsContext> tls;  ///< TLS for browsers; null: plain HTTP
  GatewayCounters counters;
  ClientLog log;
  PrefixAllowance arrivals;
  Newcomers newcomers;
  VisitorPlaces places;
  Guests guests;
};

}  // namespace naiad
