// The page that a scraper reads: /metrics.
#pragma once

#include <string>

#include "host/metrics/MetricsSnapshot.h"
#include "host/metrics/ProcessFacts.h"

namespace naiad {

/// In Prometheus' text format (Exposition.h). `snapshot` null: the host has none yet, and the page has only
/// what the process itself knows.
std::string renderMetrics(const MetricsSnapshot* p_snapshot, const ProcessFacts& process);

}  // namespace naiad
