// Redundancy: on a line that loses packets, records are sent again in the next tick, before a loss is known.
// Short ones are sent once more in the tick after, since lines sometimes lose two packets in a row.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/snapshot/KnownObjects.h"

namespace naiad {

class RedundantResend {
 public:
  /// Of all records repeated in a tick; the first one may be longer.
  static constexpr std::size_t kBits = 768;
  /// A record of at most so many bits is repeated twice.
  static constexpr std::size_t kShortBits = 32;

  /// A record was just written. Of the records that are to be repeated, those of the highest urgency are.
  void addRecord(const KnownObjects::Sent& sent, std::size_t bits, double urgency);
  /// Begin the next tick: records that are unconfirmed are pending again, within the budget.
  void requeueRecords(KnownObjects& known, std::uint32_t tick);

 private:
  struct Record {
    double urgency = 0;
    std::size_t bits = 0;
    KnownObjects::Sent sent;
    int repeats = 0;
  };

  std::vector<Record> m_next;     ///< for the next tick
  std::vector<Record> m_current;  ///< repeated in this one
};

}  // namespace naiad
