// All bans at one moment, sorted to be looked up, and never changed.
#pragma once

#include <asio/ip/address.hpp>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "host/admin/Ban.h"

namespace naiad {

/// Safe to read from any thread. A look-up takes a binary search for each length of prefix that there is.
class BanSet {
 public:
  BanSet() = default;
  explicit BanSet(std::vector<Ban> bans);

  /// The ban that holds for this address now; null if none does. None ever holds for a loopback address:
  /// there the server's own doors and admins are.
  const Ban* find(const asio::ip::address& address, Ban::Time now) const;
  /// The same for a name (Names.h). `shapes` are those of LookAlikes.h.
  const Ban* findName(const std::vector<std::string>& shapes, Ban::Time now) const;
  /// By number.
  const std::vector<Ban>& all() const { return m_bans; }

 private:
  struct Place {
    int length;
    AddressRange::Bytes bytes;
    std::size_t ban;
  };
  /// Ranges by length and first address.
  struct Index {
    std::vector<Place> places;
    std::vector<int> lengths;
    void add(const AddressRange& range, std::size_t ban);
    void sort();
  };
  const Ban* findIn(const Index& index, const asio::ip::address& address, Ban::Time now) const;

  std::vector<Ban> m_bans;
  Index m_ranges;
  Index m_exceptions;
  std::vector<std::pair<std::string, std::size_t>> m_shapes;  ///< of banned names, sorted
};

}  // namespace naiad
