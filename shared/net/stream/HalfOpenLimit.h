// Decides which connections may be half-open: between "accepted" and "handshake done".
//
// A connection is silent until its client hello is complete; from then on it has greeted. Silence is free for
// an attacker, while the hello of an honest client comes with its connection. So silent connections are ended
// to make room: the oldest one of the most crowded prefix. A connection that has greeted is never ended for
// another one. Lest these fill all places, a prefix may have no more of them than places are left: one prefix
// leaves half of the places free, and n that take all they can in turn leave 1/(n + 1). That is judged when a
// connection comes and again when its hello is complete, for many may begin their hellos before one is.
//
// A prefix counts in three widths (AddressPrefix.h), so an IPv6 customer with many networks, or a
// neighbourhood of rented servers, is as crowded as all of it together.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// Not thread-safe. Uses no clock: older is what was admitted earlier. Memory is that of the connections
/// admitted; the dearest call goes through them once.
class HalfOpenLimit {
 public:
  using Id = std::uint64_t;

  struct Limits {
    std::size_t in_all = 256;     ///< connections at once
    std::size_t per_prefix = 64;  ///< of these, from one IPv4 address or IPv6 /64
  };
  /// What a connection from some prefix meets.
  struct Verdict {
    enum class Kind {
      kFits,
      kEndFirst,       ///< It fits once the silent connection `id` has ended. Ask again afterwards.
      kFull,           ///< Refuse it: all places belong to connections that have greeted.
      kFullForPrefix,  ///< Refuse it: its prefix has its share of the places.
    } kind = Kind::kFits;
    Id id = 0;
  };

  explicit HalfOpenLimit(Limits limits) : limits_(limits) {}

  /// May one more connection come from `prefix`? Changes nothing.
  Verdict judge(const AddressPrefix& prefix) const;
  /// Count this one, until release(). `id` is greater than all before.
  void admit(Id id, const AddressPrefix& prefix);
  /// The client hello of this one is complete. False: its prefix has its share of the places, so hang up on
  /// it; it counts as silent until release(). Throws std::out_of_range if it is not admitted.
  [[nodiscard]] bool noteHello(Id id);
  /// Once for each admitted. Throws std::out_of_range if it is not.
  void release(Id id);

  /// Admitted, and its hello is not complete.
  bool isSilent(Id id) const;
  std::size_t count() const { return by_id_.size(); }
  /// More than half of the places are taken: time to be less patient.
  bool isCrowded() const { return 2 * count() > limits_.in_all; }

 private:
  /// Connections of one prefix, in one width.
  struct Group {
    std::size_t silent = 0;
    std::size_t greeted = 0;
  };
  using Groups = std::map<AddressPrefix, Group>;  // none is empty
  struct Entry {
    AddressPrefix prefix;
    bool greeted = false;
    std::array<Groups::iterator, 3> groups;  ///< by width, the narrowest first
  };

  static std::array<AddressPrefix, 3> widthsOf(const AddressPrefix& prefix);
  bool exceedsShare(const AddressPrefix& prefix) const;
  std::optional<Id> oldestSilent(const AddressPrefix& prefix) const;
  std::optional<Id> oldestOfMostCrowded() const;

  Limits limits_;
  std::size_t greeted_ = 0;
  std::map<Id, Entry> by_id_;  // so the oldest first
  std::array<Groups, 3> groups_;
};

}  // namespace naiad
