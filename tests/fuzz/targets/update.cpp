// Updates of a client: all numbers read are in range, and a valid update can be written and read again.
//
//   input   newest snapshot, tick and input known (4 each) | 0 raw, 1 numbers for HostileWriter (1) | the
//   update
#include "HostileWriter.h"
#include "Target.h"
#include "shared/replica/Limits.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad::fuzz {
namespace {

void requireGood(const ClientUpdate& update) {
  REQUIRE(update.inputs.size() <= kMaxUpdateInputs);
  std::uint32_t id = update.inputs.empty() ? 0 : update.inputs[0].id;
  for (const Input& input : update.inputs) {
    REQUIRE(input.id == id++ && input.id != 0);
    REQUIRE(input.action < 3 && input.key < df::Keyboard::kKeyCount && input.button < 4);
    REQUIRE(input.x < kMaxViewWidth && input.y < kMaxViewHeight);
    REQUIRE(input.is_mouse ? input.key == 0 : input.button == 0 && input.x == 0 && input.y == 0);
    REQUIRE(update.acks.newest - input.snapshot <= 1u << 15);
  }
}

bool same(const ClientUpdate& a, const ClientUpdate& b) {
  return a.acks.newest == b.acks.newest && a.acks.mask == b.acks.mask && a.checksum == b.checksum &&
         a.needs_reset == b.needs_reset && a.inputs == b.inputs;
}

}  // namespace

void tryInput(Script script) {
  UpdateContext context;
  context.snapshot = script.number<std::uint32_t>();
  context.tick = script.number<std::uint32_t>();
  context.input = script.number<std::uint32_t>();
  const Exactly bytes(script.flag() ? HostileWriter(script).update() : script.rest());
  const auto update = readUpdate(bytes.view(), context);
  if (!update) return;
  requireGood(*update);
  const auto again = readUpdate(writeUpdate(*update), context);
  REQUIRE(again && same(*update, *again));
}

}  // namespace naiad::fuzz
