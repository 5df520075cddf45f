// The connections that are no players' yet: they read a page, or have not said what they want.
//
// HalfOpenLimit.h has the rule. A connection is silent while it has sent no whole request, while it waits
// between two, and as a WebSocket without a hello; the oldest silent one of the most crowded prefix ends
// where there is no place. While an answer is sent it is never ended for another one.
#pragma once

#include <functional>
#include <map>
#include <utility>

#include "shared/net/stream/HalfOpenLimit.h"

namespace naiad {

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

}  // namespace naiad
