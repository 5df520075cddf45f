// Random network conditions of one client, drawn again from time to time.
#pragma once

#include <optional>

#include "shared/values/SplitMix64.h"
#include "tests/support/net/LinkConditions.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad::soak {

/// Events of a client in one tick.
struct Strokes {
  bool changed = false;  ///< the conditions have changed and must be applied
  bool healed = false;   ///< an outage has ended, or a blockade has begun or ended
  bool rebind = false;   ///< the client's address changes
  bool break_stream = false;
  bool kill = false;
  bool leave = false;
};

class Weather {
 public:
  using Time = VirtualClock::Time;

  /// `haste` is a factor for the rate of events; 1: those of Weather.cpp.
  Weather(std::uint64_t seed, double haste);

  Strokes tick(Time now);
  /// Makes the network perfect for the rest of the run.
  void heal();

  /// Conditions of datagrams from and to the client.
  LinkConditions up() const { return of(m_up); }
  LinkConditions down() const { return of(m_down); }
  /// Conditions of streams, with a tenth of the loss: the model of a stream has no fast retransmission, so
  /// this harms it as much as the full loss harms a real TCP connection.
  LinkConditions streamUp() const { return ofStream(m_up); }
  LinkConditions streamDown() const { return ofStream(m_down); }
  bool isOutage() const { return m_outage_until.has_value(); }
  bool blocksUp() const { return m_block_until && m_block_kind != 1; }
  bool blocksDown() const { return m_block_until && m_block_kind != 0; }
  bool isBlocked() const { return m_block_until.has_value(); }

  std::uint64_t outages() const { return m_outages; }
  std::uint64_t blockades() const { return m_blockades; }

 private:
  /// True about once in `seconds`, if called once a tick.
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
  int m_block_kind = 0;  ///< blocked direction: 0 from the client, 1 to it, 2 both
  std::uint64_t m_outages = 0;
  std::uint64_t m_blockades = 0;
};

}  // namespace naiad::soak
