// The snapshot decoder and the replica behind it, over a sequence of snapshots of any bytes: see
// SnapshotChecks.h for what has to hold.
//
//   input   flags 1: bit 0, begin with a world in which origins, names and objects are known (then epoch 0,
//           tick 1000)
//           then for each snapshot: length + 2^14·draw a far tick + 2^15·again (2) | the snapshot
#include "Prelude.h"
#include "Script.h"
#include "SnapshotChecks.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace naiad;
  constexpr std::uint32_t kSoon = 3;
  constexpr std::uint32_t kFar = 0x7FFFFFF0;
  fuzz::Script script(data, size);
  const std::uint8_t flags = script.byte();
  Replica replica = (flags & 1) != 0 ? fuzz::preludeReplica() : Replica(fuzz::kPreludeTick);
  while (!script.atEnd()) {
    const auto head = script.number<std::uint16_t>();
    fuzz::receiveAndCheck(replica, script.bytes(head & 0x3FFF), (head & 0x8000) != 0);
    fuzz::drawAndCheck(replica, replica.newest().tick + ((head & 0x4000) != 0 ? kFar : kSoon));
  }
  return 0;
}
