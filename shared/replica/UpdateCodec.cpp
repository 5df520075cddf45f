#include "shared/replica/UpdateCodec.h"

#include <algorithm>

#include "shared/replica/Bits.h"
#include "shared/replica/Limits.h"

namespace naiad {

// The layout, drawn out in PROTOCOL.md:
//
//   update  acks 1 (newest 16, more than 8 missing 1, then the mask 64; else their number: exp-Golomb(0), and
//           6 each) | checksum 1 (64 bits)
//           | reset 1 | inputs: exp-Golomb(0) | id of the first 16, if any | each input
//   input   tick 16, or for later ones signed exp-Golomb(2) from the one before | snapshots before the newest
//           acknowledged: exp-Golomb(3) | mouse 1 | key 7, action 2, or action 2, button 2, x 9, y 8
namespace {

constexpr int kTickBits = 16;
constexpr int kMaxNamed = 8;  ///< maximum missing snapshots that are listed one by one
constexpr int kKeyBits = 7;
constexpr int kTickOrder = 2;
constexpr int kSnapshotOrder = 3;
constexpr std::int64_t kMaxTicksApart = 1 << 15;
constexpr std::uint64_t kOldestBase = 1 << 15;
constexpr int kActions = 3;
constexpr int kButtons = 4;

// Lists the missing snapshots if they are few, which is usual; else writes the mask.
void writeMask(BitWriter& out, std::uint64_t mask) {
  const int missing = std::popcount(~mask);
  out.flag(missing > kMaxNamed);
  if (missing > kMaxNamed) return out.bits(mask, 64);
  out.golomb(static_cast<std::uint64_t>(missing), 0);
  for (std::uint64_t left = ~mask; left != 0; left &= left - 1) {
    out.bits(static_cast<std::uint64_t>(std::countr_zero(left)), 6);
  }
}

std::uint64_t readMask(BitReader& in) {
  if (in.flag()) return in.bits(64);
  std::uint64_t mask = ~std::uint64_t{0};
  for (std::uint64_t missing = in.golomb(0, kMaxNamed); missing > 0; --missing) {
    mask &= ~(std::uint64_t{1} << in.bits(6));
  }
  return mask;
}

void writeWhat(BitWriter& out, const Input& input) {
  out.flag(input.is_mouse);
  if (!input.is_mouse) out.bits(input.key, kKeyBits);
  out.bits(input.action, 2);
  if (!input.is_mouse) return;
  out.bits(input.button, 2);
  out.bits(input.x, 9);
  out.bits(input.y, 8);
}

void readWhat(BitReader& in, Input& input) {
  input.is_mouse = in.flag();
  if (!input.is_mouse) input.key = static_cast<std::uint8_t>(in.bits(kKeyBits));
  input.action = static_cast<std::uint8_t>(in.bits(2));
  if (input.is_mouse) {
    input.button = static_cast<std::uint8_t>(in.bits(2));
    input.x = static_cast<std::uint16_t>(in.bits(9));
    input.y = static_cast<std::uint16_t>(in.bits(8));
  }
  static_assert(df::Mouse::MIDDLE + 2 == kButtons);
  if (input.key >= df::Keyboard::kKeyCount || input.action >= kActions || input.x >= kMaxViewWidth ||
      input.y >= kMaxViewHeight) {
    in.fail();
  }
}

void readInputs(BitReader& in, const UpdateContext& context, ClientUpdate& update) {
  const std::uint64_t count = in.golomb(0, kMaxUpdateInputs);
  if (count == 0) return;
  std::uint32_t id = expandSerial(in.bits(kTickBits), context.input);
  std::uint32_t tick = 0;
  for (std::uint64_t i = 0; i < count && in.ok(); ++i, ++id) {
    Input input;
    if (id == 0) return in.fail();
    input.id = id;
    tick = i == 0 ? expandSerial(in.bits(kTickBits), context.tick)
                  : tick + static_cast<std::uint32_t>(in.signedGolomb(kTickOrder, kMaxTicksApart));
    input.tick = tick;
    input.snapshot = update.acks.newest - static_cast<std::uint32_t>(in.golomb(kSnapshotOrder, kOldestBase));
    readWhat(in, input);
    update.inputs.push_back(input);
  }
}

}  // namespace

std::string writeUpdate(const ClientUpdate& update) {
  BitWriter out;
  out.flag(update.acks.newest != 0);
  if (update.acks.newest != 0) {
    out.bits(update.acks.newest & 0xFFFF, kTickBits);
    writeMask(out, update.acks.mask);
  }
  out.flag(update.checksum.has_value());
  if (update.checksum) out.bits(*update.checksum, 64);
  out.flag(update.needs_reset);
  const std::size_t count = std::min(update.inputs.size(), kMaxUpdateInputs);
  out.golomb(count, 0);
  if (count > 0) out.bits(update.inputs[0].id & 0xFFFF, kTickBits);
  for (std::size_t i = 0; i < count; ++i) {
    const Input& input = update.inputs[i];
    assert(input.id == update.inputs[0].id + i);
    if (i == 0) {
      out.bits(input.tick & 0xFFFF, kTickBits);
    } else {
      const auto apart = static_cast<std::int32_t>(input.tick - update.inputs[i - 1].tick);
      out.signedGolomb(std::clamp<std::int64_t>(apart, -kMaxTicksApart, kMaxTicksApart), kTickOrder);
    }
    const std::uint64_t behind = update.acks.newest - input.snapshot;
    out.golomb(std::min(behind, kOldestBase), kSnapshotOrder);
    writeWhat(out, input);
  }
  return out.bytes();
}

std::optional<ClientUpdate> readUpdate(std::string_view bytes, const UpdateContext& context) {
  if (bytes.size() > kMaxUpdate) return std::nullopt;
  BitReader in(bytes);
  ClientUpdate update;
  if (in.flag()) {
    update.acks.newest = expandSerial(in.bits(kTickBits), context.snapshot);
    update.acks.mask = readMask(in);
    if (update.acks.newest == 0) in.fail();
  }
  if (in.flag()) update.checksum = in.bits(64);
  update.needs_reset = in.flag();
  readInputs(in, context, update);
  if (!in.atEnd()) return std::nullopt;
  return update;
}

}  // namespace naiad
