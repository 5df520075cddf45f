// How many WebSockets play: in all, and from one IPv4 address or IPv6 /64.
#pragma once

#include <cstddef>
#include <map>
#include <utility>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// Not thread-safe. Must outlive its places.
class VisitorPlaces {
 public:
  /// A place that is given back at its end.
  class Place {
   public:
    Place() = default;
    Place(Place&& other) noexcept
        : m_owner(std::exchange(other.m_owner, nullptr)), m_prefix(other.m_prefix) {}
    Place& operator=(Place&& other) noexcept {
      std::swap(m_owner, other.m_owner);
      std::swap(m_prefix, other.m_prefix);
      return *this;
    }
    ~Place() {
      if (m_owner) m_owner->giveBack(m_prefix);
    }
    explicit operator bool() const { return m_owner != nullptr; }

   private:
    friend class VisitorPlaces;
    Place(VisitorPlaces& owner, const AddressPrefix& prefix) : m_owner(&owner), m_prefix(prefix) {}

    VisitorPlaces* m_owner = nullptr;
    AddressPrefix m_prefix;
  };

  VisitorPlaces(std::size_t in_all, std::size_t per_prefix) : m_in_all(in_all), m_per_prefix(per_prefix) {}

  /// None if all places are taken, or those of this prefix.
  Place take(const AddressPrefix& prefix) {
    if (m_count >= m_in_all) return {};
    std::size_t& here = m_by_prefix[prefix];
    if (here >= m_per_prefix) return {};
    ++here;
    ++m_count;
    return {*this, prefix};
  }
  std::size_t count() const { return m_count; }

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

}  // namespace naiad
