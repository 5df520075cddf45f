#include <gtest/gtest.h>

#include <functional>

#include "shared/replica/Bits.h"
#include "shared/replica/Limits.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

Input randomInput(SplitMix64& rng, std::uint32_t id, std::uint32_t tick, std::uint32_t newest) {
  Input input;
  input.id = id;
  input.tick = tick;
  input.snapshot =
      newest == 0 ? 0 : newest - static_cast<std::uint32_t>(rng.below(rng.below(2) == 0 ? 5 : 32769));
  input.is_mouse = rng.below(2) == 0;
  input.action = static_cast<std::uint8_t>(rng.below(3));
  if (!input.is_mouse) {
    input.key = static_cast<std::uint8_t>(rng.below(df::Keyboard::kKeyCount));
    return input;
  }
  input.button = static_cast<std::uint8_t>(rng.below(4));
  input.x = static_cast<std::uint16_t>(rng.below(kMaxViewWidth));
  input.y = static_cast<std::uint16_t>(rng.below(kMaxViewHeight));
  return input;
}

ClientUpdate randomUpdate(SplitMix64& rng, std::size_t most_inputs) {
  ClientUpdate update;
  if (rng.below(4) != 0) {
    update.acks.newest = static_cast<std::uint32_t>(rng.next()) | 1;
    update.acks.mask = rng.below(2) == 0 ? ~std::uint64_t{0} : rng.next();
  }
  if (rng.below(2) == 0) update.checksum = rng.next();
  update.needs_reset = rng.below(2) == 0;
  auto id = static_cast<std::uint32_t>(1 + rng.below(0xFFFFFF00));
  auto tick = static_cast<std::uint32_t>(rng.next());
  for (auto n = rng.below(most_inputs + 1); n > 0; --n) {
    tick += static_cast<std::uint32_t>(rng.below(65537)) - 32768;
    update.inputs.push_back(randomInput(rng, id++, tick, update.acks.newest));
  }
  return update;
}

UpdateContext near(const ClientUpdate& update) {
  UpdateContext context{update.acks.newest, 0, 0};
  if (!update.inputs.empty()) context = {update.acks.newest, update.inputs[0].tick, update.inputs[0].id};
  return context;
}

void expectSame(const ClientUpdate& a, const ClientUpdate& b) {
  ASSERT_EQ(a.acks.newest, b.acks.newest);
  ASSERT_EQ(a.acks.mask, b.acks.mask);
  ASSERT_EQ(a.checksum, b.checksum);
  ASSERT_EQ(a.needs_reset, b.needs_reset);
  ASSERT_EQ(a.inputs, b.inputs);
}

TEST(UpdateCodec, RandomUpdatesSurviveTheRoundTrip) {
  SplitMix64 rng(1);
  for (int i = 0; i < 20'000; ++i) {
    const ClientUpdate update = randomUpdate(rng, 6);
    const auto read = readUpdate(writeUpdate(update), near(update));
    ASSERT_TRUE(read) << i;
    expectSame(update, *read);
    if (HasFatalFailure()) FAIL() << "round " << i;
  }
}

TEST(UpdateCodec, AcknowledgementAloneTakesThreeBytes) {
  ClientUpdate update;
  update.acks = {5, ~std::uint64_t{0}};
  EXPECT_EQ(writeUpdate(update).size(), 3u);
  EXPECT_EQ(writeUpdate({}).size(), 1u);
}

TEST(UpdateCodec, MaximumInputsAlwaysFit) {
  ClientUpdate update;
  update.acks = {0xFFFFFFFF, 1};
  update.checksum = 0;
  Input input;
  input.is_mouse = true;
  input.id = 0xFFFF;
  input.tick = 5;
  input.snapshot = update.acks.newest - 32768;
  for (std::size_t i = 0; i < kMaxUpdateInputs; ++i, ++input.id) {
    update.inputs.push_back(input);
    input.tick += 32768;  // a difference with the longest encoding
  }
  const std::string bytes = writeUpdate(update);
  EXPECT_LE(bytes.size(), kMaxUpdate);
  auto read = readUpdate(bytes, near(update));
  ASSERT_TRUE(read);
  ASSERT_EQ(read->inputs.size(), kMaxUpdateInputs);
  for (std::size_t i = 0; i < kMaxUpdateInputs; ++i) EXPECT_EQ(read->inputs[i].id, 0xFFFF + i);

  update.inputs.push_back(input);
  EXPECT_EQ(writeUpdate(update), bytes) << "of too many the first ones are taken";
}

TEST(UpdateCodec, EveryTruncationIsRefused) {
  SplitMix64 rng(2);
  for (int i = 0; i < 1000; ++i) {
    const ClientUpdate update = randomUpdate(rng, 5);
    const std::string bytes = writeUpdate(update);
    for (std::size_t length = 0; length < bytes.size(); ++length)
      ASSERT_FALSE(readUpdate(std::string_view(bytes).substr(0, length), near(update))) << i;
    ASSERT_FALSE(readUpdate(bytes + '\0', near(update)));
  }
}

TEST(UpdateCodec, OversizedUpdatesAreRefused) {
  EXPECT_FALSE(readUpdate(std::string(kMaxUpdate + 1, '\0'), {}));
}

TEST(UpdateCodec, NumbersAreRestoredNearKnownOnes) {
  for (const std::uint32_t known : {7u, 0x8000u, 0x1FFFFu, 0x20000u, 0x7FFFFFFFu, 0xFFFFFFF0u}) {
    for (const std::int32_t apart : {-32768, -5, 0, 5, 32767}) {
      ClientUpdate update;
      const std::uint32_t number = known + static_cast<std::uint32_t>(apart);
      if (number == 0) continue;
      update.acks.newest = number;
      Input input;
      input.id = number;
      input.tick = number;
      input.snapshot = number - 3;
      update.inputs = {input};
      const auto read = readUpdate(writeUpdate(update), {known, known, known});
      ASSERT_TRUE(read) << known << " " << apart;
      expectSame(update, *read);
    }
  }
}

TEST(UpdateCodec, NumberZeroIsNeitherASnapshotNorAnInput) {
  ClientUpdate update;
  update.acks.newest = 0x10000;
  EXPECT_TRUE(readUpdate(writeUpdate(update), {0x10000, 0, 0}));
  EXPECT_FALSE(readUpdate(writeUpdate(update), {0, 0, 0})) << "that would be 0";
  update.acks.newest = 0;
  update.inputs.resize(2);
  update.inputs[0].id = 0xFFFF;
  update.inputs[1].id = 0x10000;
  EXPECT_TRUE(readUpdate(writeUpdate(update), {0, 0, 0xFFFF}));
  EXPECT_FALSE(readUpdate(writeUpdate(update), {0, 0, 0})) << "-1 and 0";
}

TEST(UpdateCodec, NumbersOutOfRangeAreRefused) {
  const auto isRead = [](const std::function<void(Input&)>& change) {
    ClientUpdate update;
    update.inputs.resize(1);
    update.inputs[0].id = 1;
    change(update.inputs[0]);
    return readUpdate(writeUpdate(update), {}).has_value();
  };
  const auto mouse = [&](const std::function<void(Input&)>& change) {
    return isRead([&](Input& input) {
      input.is_mouse = true;
      change(input);
    });
  };
  EXPECT_TRUE(isRead([](Input& i) { i.key = df::Keyboard::kKeyCount - 1; }));
  EXPECT_FALSE(isRead([](Input& i) { i.key = df::Keyboard::kKeyCount; }));
  EXPECT_FALSE(isRead([](Input& i) { i.key = 127; }));
  EXPECT_TRUE(isRead([](Input& i) { i.action = 2; }));
  EXPECT_FALSE(isRead([](Input& i) { i.action = 3; }));
  EXPECT_TRUE(mouse([](Input& i) { i.action = 2; }));
  EXPECT_FALSE(mouse([](Input& i) { i.action = 3; }));
  EXPECT_TRUE(mouse([](Input& i) { i.button = 3; }));
  EXPECT_TRUE(mouse([](Input& i) { i.x = kMaxViewWidth - 1; }));
  EXPECT_FALSE(mouse([](Input& i) { i.x = kMaxViewWidth; }));
  EXPECT_TRUE(mouse([](Input& i) { i.y = kMaxViewHeight - 1; }));
  EXPECT_FALSE(mouse([](Input& i) { i.y = kMaxViewHeight; }));
}

/// Begins an update by hand, up to its inputs.
BitWriter bareInputs(std::uint64_t count) {
  BitWriter out;
  out.bits(0, 3);  // no acknowledgement, checksum, reset
  out.golomb(count, 0);
  out.bits(1, 16);  // id
  out.bits(0, 16);  // tick
  return out;
}

void addKey(BitWriter& out, std::uint64_t behind) {
  out.golomb(behind, 3);
  out.flag(false);
  out.bits(0, 7 + 2);
}

TEST(UpdateCodec, ASnapshotTooFarBackIsRefused) {
  for (const std::uint64_t behind : {32768u, 32769u}) {
    BitWriter out = bareInputs(1);
    addKey(out, behind);
    EXPECT_EQ(readUpdate(out.bytes(), {}).has_value(), behind == 32768);
  }
}

TEST(UpdateCodec, TicksTooFarApartAreRefused) {
  for (const std::int64_t apart : {-32769, -32768, 32768, 32769}) {
    BitWriter out = bareInputs(2);
    addKey(out, 0);
    out.signedGolomb(apart, 2);
    addKey(out, 0);
    EXPECT_EQ(readUpdate(out.bytes(), {}).has_value(), apart == 32768 || apart == -32768);
  }
}

TEST(UpdateCodec, TooManyInputsAreRefused) {
  for (const std::uint64_t count : {kMaxUpdateInputs, kMaxUpdateInputs + 1}) {
    BitWriter out = bareInputs(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      if (i > 0) out.signedGolomb(0, 2);
      addKey(out, 0);
    }
    EXPECT_EQ(readUpdate(out.bytes(), {}).has_value(), count == kMaxUpdateInputs);
  }
}

}  // namespace
}  // namespace naiad
