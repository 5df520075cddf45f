// The parts that libdragonfly-ops.so adds to a host (host/loop/OperatorLibrary.h).
#include "host/loop/OperatorLibrary.h"
#include "host/ops/HostCommands.h"
#include "host/ops/HostFleet.h"
#include "host/ops/HostListing.h"
#include "host/ops/HostMetrics.h"
#include "host/ops/HostScores.h"
#include "host/rooms/HostContext.h"

namespace naiad {

// The fleet comes last: a platform that is sent the end takes the server away.
extern "C" void naiad_makeOperatorParts(const HostAccess& access,
                                        std::vector<std::unique_ptr<HostPart>>& parts) {
  auto scores = std::make_unique<HostScores>(access);
  HostScores& all_scores = *scores;
  parts.push_back(std::move(scores));
  parts.push_back(std::make_unique<HostCommands>(access, all_scores));
  parts.push_back(std::make_unique<HostListing>(access));
  if (!access.context.options.metrics.empty()) parts.push_back(std::make_unique<HostMetrics>(access));
  parts.push_back(std::make_unique<HostFleet>(access, all_scores));
}

}  // namespace naiad
