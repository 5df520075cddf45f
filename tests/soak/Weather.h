// What the network does to one client: drawn at random, drawn again now and then.
#pragma once

#include <chrono>
#include <optional>

#include "shared/values/SplitMix64.h"
#include "tests/support/net/LinkConditions.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad::soak {

/// What happens to a client in one tick, besides what is in force anyway.
struct Strokes {
  bool changed = false;  ///< other conditions than before: apply them
  bool healed = false;   ///< an outage or a blockade has ended, or something else begun
  bool rebind = false;   ///< its address changes
  bool break_stream = false;
  bool kill = false;
  bool leave = false;
};

class Weather {
 public:
  using Time = VirtualClock::Time;

  /// `haste`: how many times more often than usual things happen.
  Weather(std::uint64_t seed, double haste);

  Strokes tick(Time now);
  /// Fine from now on, for ever.
  void heal();

  /// Of datagrams, from and to the client.
  LinkConditions up() const { return of(m_up); }
  LinkConditions down() const { return of(m_down); }
  /// Of streams: the model of a stream knows no fast retransmission, so that loss hits it far harder than a
  /// real one; a tenth of it does what all of it does to TCP.
  LinkConditions streamUp() const { return ofStream(m_up); }
  LinkConditions streamDown() const { return ofStream(m_down); }
  bool isOutage() const { return m_outage_until.has_value(); }
  bool blocksUp() const { return m_block_until && m_block_kind != 1; }
  bool blocksDown() const { return m_block_until && m_block_kind != 0; }
  bool isBlocked() const { return m_block_until.has_value(); }

  std::uint64_t outages() const { return m_outages; }
  std::uint64_t blockades() const { return m_blockades; }

 private:
  /// About once in `seconds`.
  bool strikes(double seconds) { return m_random.unit() < m_haste / (30 * seconds); }
  Time between(int low_millis, int high_millis);
  LinkConditions draw();
  LinkConditions of(LinkConditions conditions) const;
  LinkConditions ofStream(LinkConditions conditions) const;

  SplitMix64 m_random;
  double m_haste;
  bool m_fine = false;
  LinkConditions m_up;
  LinkConditions m_down;
  std::optional<Time> m_outage_until;
  std::optional<Time> m_block_until;
  int m_block_kind = 0;  ///< 0: up, 1: down, 2: both ways
  std::uint64_t m_outages = 0;
  std::uint64_t m_blockades = 0;
};

}  // namespace naiad::soak
