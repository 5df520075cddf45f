// A map with one value per address prefix, in bounded memory: it keeps the most recently used prefixes.
#pragma once

#include <cassert>
#include <cstddef>
#include <iterator>
#include <list>
#include <map>
#include <utility>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// If the table is full, the least recently used prefix is evicted; later it starts with a new value. So a
/// flood from other prefixes can at most reset the limits of a prefix, never use them up. A lookup costs
/// O(log capacity), whichever prefixes an attacker chooses.
template <class T>
class PrefixLruMap {
 public:
  explicit PrefixLruMap(std::size_t capacity) : capacity_(capacity) { assert(capacity_ > 0); }
  PrefixLruMap(const PrefixLruMap&) = delete;
  PrefixLruMap& operator=(const PrefixLruMap&) = delete;

  /// Returns the value of `prefix`, created if missing, and makes it the most recently used one. The
  /// reference is valid until the prefix is erased or evicted.
  T& use(const AddressPrefix& prefix) {
    if (const auto found = index_.find(prefix); found != index_.end()) {
      order_.splice(order_.end(), order_, found->second);
      return found->second->second;
    }
    if (order_.size() == capacity_) {
      index_.erase(order_.front().first);
      order_.pop_front();
    }
    order_.emplace_back(prefix, T{});
    index_.emplace(prefix, std::prev(order_.end()));
    return order_.back().second;
  }
  /// Returns nullptr if the prefix is unknown. Does not count as a use.
  T* find(const AddressPrefix& prefix) {
    const auto found = index_.find(prefix);
    return found != index_.end() ? &found->second->second : nullptr;
  }
  void erase(const AddressPrefix& prefix) {
    const auto found = index_.find(prefix);
    if (found == index_.end()) return;
    order_.erase(found->second);
    index_.erase(found);
  }
  std::size_t size() const { return order_.size(); }

 private:
  using Order = std::list<std::pair<AddressPrefix, T>>;

  std::size_t capacity_;
  Order order_;  ///< the least recently used first
  std::map<AddressPrefix, typename Order::iterator> index_;
};

}  // namespace naiad
