// The same as the target `snapshot`, by snapshots in which one field is bad: whatever it says, either the
// snapshot is refused, or what came out is in its ranges.
//
//   input   the numbers for HostileWriter, one snapshot after the other; for a client that knows the prelude
#include "HostileWriter.h"
#include "Prelude.h"
#include "SnapshotChecks.h"
#include "Target.h"

namespace naiad::fuzz {

void tryInput(Script script) {
  HostileWriter writer(script);
  Replica replica = preludeReplica();
  while (!script.atEnd()) {
    const SnapshotContext newest = replica.newest();
    receiveAndCheck(replica, writer.snapshot(newest.number + 1, newest.tick + 1), false);
  }
}

}  // namespace naiad::fuzz
