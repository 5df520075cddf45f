// Records that are sent again before anybody knows whether they have to be: on a line that loses, once in the
// next tick, and the short ones once more in the tick after, for lines lose two in a row now and then.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/snapshot/KnownObjects.h"

namespace naiad {

class RedundantResend {
 public:
  /// Bits of all that is repeated in a tick; the first one may be longer.
  static constexpr std::size_t kBits = 768;
  /// A record that takes no more is repeated twice.
  static constexpr std::size_t kShortBits = 32;

  /// A record was just written. `urgency`: the higher, the rather it is repeated if not all can be.
  void consider(const KnownObjects::Sent& sent, std::size_t bits, double urgency);
  /// The next tick: owe again what is worth it and still unconfirmed.
  void owe(KnownObjects& known, std::uint32_t tick);

 private:
  struct Record {
    double urgency = 0;
    std::size_t bits = 0;
    KnownObjects::Sent sent;
    int repeats = 0;  ///< so far
  };

  std::vector<Record> m_next;     ///< for the next tick
  std::vector<Record> m_present;  ///< repeated in this one
};

}  // namespace naiad
