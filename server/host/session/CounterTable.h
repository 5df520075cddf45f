// Names of all counters in the log and the metrics: one table per struct of counters.
//
// A counter missing from its table is a compile error (CounterTable.cpp).
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
  std::string_view field;  ///< the member's name, for the log; empty: not logged
  std::uint64_t value = 0;
  std::string_view family = {};  ///< name of the metric family
  std::string_view labels = {};
  std::string_view help = {};      ///< help text of the family; only in its first sample
  std::uint64_t metric_value = 0;  ///< value without the part that has a sample of its own
};

/// Returns all counters of the struct, in table order. The string views in it are always valid.
std::vector<CounterSample> samplesOf(const Counters& counters);
std::vector<CounterSample> samplesOf(const PasswordCheck::Counters& counters);
std::vector<CounterSample> samplesOf(const TcpListener::Counters& counters);
std::vector<CounterSample> samplesOf(const ProxyListener::Counters& counters);
std::vector<CounterSample> samplesOf(const RelayCounters& counters);
std::vector<CounterSample> samplesOf(const DatagramDemuxCounters& counters);
std::vector<CounterSample> samplesOf(const UdpCounters& counters);
std::vector<CounterSample> samplesOf(const TrafficCounters& counters);

/// Returns "name=3 other=1 …", without counters that are zero.
std::string listCounters(const std::vector<CounterSample>& samples);

}  // namespace naiad
