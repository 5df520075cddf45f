// The snapshot decoder and the replica behind it, over a sequence of snapshots of any bytes. SnapshotChecks.h
// lists the requirements.
//
//   input   flags 1: bit 0, begin with a world in which origins, names and objects are known (then epoch 0,
//           tick 1000)
//           then for each snapshot: length + 2^14·draw a far tick + 2^15·again (2) | the snapshot
#include "Prelude.h"
#include "SnapshotChecks.h"
#include "Target.h"

namespace naiad::fuzz {

void tryInput(Script script) {
  constexpr std::uint32_t kSoon = 3;
  constexpr std::uint32_t kFar = 0x7FFFFFF0;
  const std::uint8_t flags = script.byte();
  Replica replica = (flags & 1) != 0 ? preludeReplica() : Replica(kPreludeTick);
  while (!script.atEnd()) {
    const auto head = script.number<std::uint16_t>();
    receiveAndCheck(replica, script.bytes(head & 0x3FFF), (head & 0x8000) != 0);
    drawAndCheck(replica, replica.newest().tick + ((head & 0x4000) != 0 ? kFar : kSoon));
  }
}

}  // namespace naiad::fuzz
