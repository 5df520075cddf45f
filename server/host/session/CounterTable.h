// What the log and the metrics call each counter of a host: one table for each struct of counters.
//
// A counter that no table has does not compile (CounterTable.cpp), so that none is forgotten.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/auth/PasswordCheck.h"
#include "host/net/NetworkThread.h"
#include "host/session/Counters.h"

namespace naiad {

struct CounterSample {
  std::string_view field;  ///< the member's name, for the log; empty: not in the log
  std::uint64_t value = 0;
  std::string_view family = {};  ///< of metrics
  std::string_view labels = {};
  std::string_view help = {};      ///< of the family: in its first sample
  std::uint64_t metric_value = 0;  ///< without a part that has a sample of its own
};

/// Returns all counters of the struct, in the order of their table. The names in them are always valid.
std::vector<CounterSample> samplesOf(const Counters& counters);
std::vector<CounterSample> samplesOf(const PasswordCheck::Counters& counters);
std::vector<CounterSample> samplesOf(const TcpListener::Counters& counters);
std::vector<CounterSample> samplesOf(const VisitorsListener::Counters& counters);
std::vector<CounterSample> samplesOf(const RelayCounters& counters);
std::vector<CounterSample> samplesOf(const DatagramGateCounters& counters);
std::vector<CounterSample> samplesOf(const UdpCounters& counters);
std::vector<CounterSample> samplesOf(const TrafficCounters& counters);

/// "name=3 other=1 …", only those that are not zero.
std::string listCounters(const std::vector<CounterSample>& samples);

}  // namespace naiad
