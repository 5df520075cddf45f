// The server's record of one client's replica: what was sent, and what is pending.
#pragma once

#include <cstdint>

#include "host/snapshot/AppearanceIds.h"
#include "host/snapshot/InFlightSnapshots.h"
#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/PerClientState.h"

namespace naiad {

struct ClientReplica {
  /// The result of requeueLost(): the parts that are pending again because a snapshot was lost.
  struct Requeued {
    std::size_t objects = 0;
    bool any = false;  ///< true if objects or client state are pending again
  };

  bool hasPending() const { return state.hasPending() || !objects.pendingIds().empty(); }
  void confirmArrival(const InFlightSnapshots::Snapshot& snapshot) {
    // Prefetch all objects first: with 1,500 clients, waiting for cache misses took 3.5 % of all time.
    for (const KnownObjects::Sent& sent : snapshot.objects) objects.prefetch(sent.id);
    state.confirmArrival(snapshot.number, snapshot.probe);
    for (const KnownObjects::Sent& sent : snapshot.objects) objects.confirmArrival(sent, snapshot.number);
    for (const auto& [id, sum] : snapshot.names) names.confirmArrival(id, sum, snapshot.number);
  }
  Requeued requeueLost(const InFlightSnapshots::Snapshot& snapshot, std::uint32_t tick) {
    Requeued requeued;
    requeued.any = state.requeueLost(snapshot.number);
    for (const KnownObjects::Sent& sent : snapshot.objects) {
      if (objects.requeueLost(sent, snapshot.number, tick)) ++requeued.objects;
    }
    requeued.any = requeued.any || requeued.objects > 0;
    return requeued;
  }

  KnownObjects objects;
  PerClientState state;
  AppearanceIds names;
};

}  // namespace naiad
