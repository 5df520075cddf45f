// The same as the target `snapshot`, by snapshots in which one field is bad: whatever it says, either the
// snapshot is refused, or what came out is in its ranges.
//
//   input   the numbers for HostileWriter, one snapshot after the other; for a client that knows the prelude
#include "HostileWriter.h"
#include "Prelude.h"
#include "Script.h"
#include "SnapshotChecks.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace naiad;
  fuzz::Script script(data, size);
  fuzz::HostileWriter writer(script);
  Replica replica = fuzz::preludeReplica();
  while (!script.atEnd()) {
    const SnapshotContext newest = replica.newest();
    fuzz::receiveAndCheck(replica, writer.snapshot(newest.number + 1, newest.tick + 1), false);
  }
  return 0;
}
