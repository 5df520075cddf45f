// Like the target `snapshot`, but each snapshot has one bad field: it is rejected, or its values are in
// range.
//
//   input   numbers for HostileWriter, one snapshot after another, for a client that knows the prelude
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
