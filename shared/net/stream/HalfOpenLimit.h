// Limits half-open connections: those between "accepted" and "handshake done".
//
// A connection is silent until its client hello is complete; then it has greeted. Silence costs an attacker
// nothing, while an honest client sends its hello at once. So silent connections are ended when places are
// needed: the oldest one of the new connection's prefix if that is at its limit, else of the most crowded
// prefix. Greeted connections are never ended to make room. So that they cannot fill all places, a prefix may
// have at most as many of them as places are left: one greedy prefix leaves half of the places free, n greedy
// ones leave 1/(n + 1). This is checked when a connection arrives and again when its hello is complete,
// because many hellos may begin before one is complete.
//
// Prefixes of three widths count (AddressPrefix.h), so an IPv6 customer with many networks, or a group of
// rented servers, counts as one crowd.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// Not thread-safe. Uses no clock: age is the order of admission. Memory is proportional to the admitted
/// connections; the slowest call visits each of them once.
class HalfOpenLimit {
 public:
  using Id = std::uint64_t;

  struct Limits {
    std::size_t total = 256;      ///< simultaneous connections
    std::size_t per_prefix = 64;  ///< connections from one IPv4 address or IPv6 /64
  };
  /// The decision about a new connection.
  struct Result {
    enum class Kind {
      kFits,
      kEvictFirst,     ///< It fits after the silent connection `id` was ended. Call check() again then.
      kFull,           ///< Refuse it: all places belong to connections that have greeted.
      kFullForPrefix,  ///< Refuse it: greeted connections use up its prefix's share, or per_prefix.
    } kind = Kind::kFits;
    Id id = 0;
  };

  explicit HalfOpenLimit(Limits limits) : limits_(limits) {}

  /// Decides about one more connection from `prefix`. Changes nothing.
  Result check(const AddressPrefix& prefix) const;
  /// Counts a connection until release(). `id` must be greater than all earlier ones.
  void admit(Id id, const AddressPrefix& prefix);
  /// Records that the connection's client hello is complete. Returns false if the address prefix has used up
  /// its share of the places: then close the connection, which counts as silent until release(). Throws
  /// std::out_of_range if the connection is not admitted.
  [[nodiscard]] bool onHello(Id id);
  /// Removes an admitted connection; throws std::out_of_range if it is not admitted.
  void release(Id id);

  /// True if the connection is admitted and its hello is not complete.
  bool isSilent(Id id) const;
  std::size_t count() const { return by_id_.size(); }
  /// True if more than half of the places are taken, so that timeouts should be shorter.
  bool isCrowded() const { return 2 * count() > limits_.total; }

 private:
  /// Numbers of connections of one prefix, for one of the three widths.
  struct Group {
    std::size_t silent = 0;
    std::size_t greeted = 0;
  };
  using Groups = std::map<AddressPrefix, Group>;  // no group is empty
  struct HalfOpenConnection {
    AddressPrefix prefix;
    bool greeted = false;
    std::array<Groups::iterator, 3> groups;  ///< its groups, narrowest width first
  };

  static std::array<AddressPrefix, 3> widthsOf(const AddressPrefix& prefix);
  bool exceedsShare(const AddressPrefix& prefix) const;
  std::optional<Id> oldestSilent(const AddressPrefix& prefix) const;
  std::optional<Id> oldestOfMostCrowded() const;

  Limits limits_;
  std::size_t greeted_ = 0;
  std::map<Id, HalfOpenConnection> by_id_;  // oldest first
  std::array<Groups, 3> groups_;
};

}  // namespace naiad
