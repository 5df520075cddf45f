// What the connections of one gateway share.
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

/// The connections that are no players' yet: they read a page, or have not said what they want.
///
/// HalfOpenLimit.h has the rule. A connection is silent while it has sent no whole request, while it waits
/// between two, and as a WebSocket without a hello; the oldest silent one of the most crowded prefix ends
/// where there is no place. While an answer is sent it is never ended for another one.
///
/// Not thread-safe. Must outlive its places.
class Newcomers {
 public:
  using HangUp = std::function<void()>;

  /// A place that is given back at its end.
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
    /// A whole request has come. False if its prefix has its share of the places: hang up.
    [[nodiscard]] bool setBusy();
    /// It waits for something to be said; it counts as the youngest.
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

  /// A place for one more connection from there; `hang_up` ends it, and gives its place back before it
  /// returns. None if all are taken by those that may not be ended.
  Place take(const AddressPrefix& prefix, HangUp hang_up);
  /// Another way to end it from now on: it has become something else.
  void replace(const Place& place, HangUp hang_up) { m_hang_ups[place.m_id] = std::move(hang_up); }

  /// Connections that were ended for another one.
  std::uint64_t ended() const { return m_ended; }

 private:
  HalfOpenLimit::Id admit(const AddressPrefix& prefix, HangUp hang_up);

  HalfOpenLimit m_limit;
  std::map<HalfOpenLimit::Id, HangUp> m_hang_ups;
  HalfOpenLimit::Id m_newest = 0;
  std::uint64_t m_ended = 0;
};

/// How many WebSockets play: in all, and from one IPv4 address or IPv6 /64.
/// Not thread-safe. Must outlive its places.
class VisitorPlaces {
 public:
  /// A place that is given back with its last holder; null: none.
  using Place = std::shared_ptr<VisitorPlaces>;

  VisitorPlaces(std::size_t in_all, std::size_t per_prefix) : m_in_all(in_all), m_per_prefix(per_prefix) {}

  /// None if all places are taken, or those of this prefix.
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

/// What is connected to the gateway: a browser that reads the page, or one stream of a player.
///
/// Each has one time by which something has to have come. They are compared in one sweep, so that no message
/// costs a timer.
/// Make it with std::make_shared; the handlers under way keep it alive.
class Guest : public std::enable_shared_from_this<Guest> {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `guests` are kept as long as this.
  explicit Guest(std::shared_ptr<Guests> guests);
  virtual ~Guest();
  Guest(const Guest&) = delete;
  Guest& operator=(const Guest&) = delete;

  /// Its time is over.
  virtual void onDeadline() = 0;
  /// The gateway ends: leave, saying so where that can be.
  virtual void endService() = 0;
  /// End at once; its places are given back when this returns.
  virtual void hangUp() = 0;

  /// Ten times a second. Calls onDeadline() when it is time.
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

/// All of them.
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
  /// They keep themselves alive; one that is going has nothing left to end.
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

/// Thread: the gateway's. Guests keep it as long as they live.
struct GatewayState : std::enable_shared_from_this<GatewayState> {
  GatewayState(GatewaySettings given, const AllowedNames& allowed, LogLine line);

  /// For a Guest.
  std::shared_ptr<Guests> sharedGuests() { return {shared_from_this(), &guests}; }

  const GatewaySettings settings;
  const AllowedNames names;
  const PageFiles page;
  const HttpAnswers answers;
  const GameServer server;
  std::shared_ptr<const TlsContext> tls;  ///< with browsers; null: plain HTTP
  GatewayCounters counters;
  ClientLog log;
  PrefixAllowance arrivals;
  Newcomers newcomers;
  VisitorPlaces places;
  Guests guests;
};

}  // namespace naiad
