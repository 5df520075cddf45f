#include <gtest/gtest.h>

#include <vector>

#include "shared/replica/Bits.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

std::uint64_t lowBits(std::uint64_t value, int count) {
  return count == 64 ? value : value & ((std::uint64_t{1} << count) - 1);
}

/// Returns a random number of exactly `width` bits.
std::uint64_t ofWidth(SplitMix64& rng, int width) {
  return width == 0 ? 0 : lowBits(rng.next(), width - 1) | (std::uint64_t{1} << (width - 1));
}

TEST(Bits, FillBytesFromTheLowEnd) {
  BitWriter out;
  out.flag(true);
  out.bits(0b10, 2);
  out.bits(0x1FF, 9);
  EXPECT_EQ(out.bitCount(), 12u);
  EXPECT_EQ(out.byteCount(), 2u);
  EXPECT_EQ(out.bytes(), std::string("\xFD\x0F", 2));
}

TEST(Bits, EveryWidthSurvivesTheRoundTripAtEveryOffset) {
  SplitMix64 rng(1);
  for (int offset = 0; offset < 8; ++offset) {
    for (int width = 0; width <= 64; ++width) {
      const std::uint64_t all = lowBits(~std::uint64_t{0}, width);
      const std::uint64_t some = ofWidth(rng, width);
      BitWriter out;
      out.bits(0, offset);
      out.bits(all, width);
      out.bits(some, width);
      ASSERT_EQ(out.bitCount(), static_cast<std::size_t>(offset + 2 * width));
      const std::string bytes = out.bytes();
      ASSERT_EQ(bytes.size(), out.byteCount());
      BitReader in(bytes);
      ASSERT_EQ(in.bits(offset), 0u);
      ASSERT_EQ(in.bits(width), all) << width;
      ASSERT_EQ(in.bits(width), some) << width;
      ASSERT_TRUE(in.atEnd());
    }
  }
}

TEST(Bits, SignedNumbersOfEveryWidthSurviveTheRoundTrip) {
  for (int width = 1; width <= 64; ++width) {
    const auto least = static_cast<std::int64_t>(~std::uint64_t{0} << (width - 1));
    for (const std::int64_t value :
         {least, least / 2, std::int64_t{-1}, std::int64_t{0}, ~(least / 2), ~least}) {
      BitWriter out;
      out.signedBits(value, width);
      const std::string bytes = out.bytes();
      BitReader in(bytes);
      ASSERT_EQ(in.signedBits(width), value) << width;
      ASSERT_TRUE(in.atEnd());
    }
  }
}

TEST(Bits, ExpGolombOfEveryOrderSurvivesTheRoundTrip) {
  SplitMix64 rng(2);
  for (int order = 0; order <= 32; ++order) {
    BitWriter out;
    std::vector<std::uint64_t> values = {0, 1, (std::uint64_t{1} << order) - 1, std::uint64_t{1} << order};
    for (int width = 1; width < 64; ++width) values.push_back(ofWidth(rng, width));
    for (const std::uint64_t value : values) out.golomb(value, order);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    for (const std::uint64_t value : values) ASSERT_EQ(in.golomb(order, value), value) << "order " << order;
    ASSERT_TRUE(in.atEnd());
  }
}

TEST(Bits, ExpGolombLengthsMatchTheStandard) {
  const auto length = [](std::uint64_t value, int order) {
    BitWriter out;
    out.golomb(value, order);
    return out.bitCount();
  };
  // H.264, table 9-2: 0 takes 1 bit, 1 and 2 take 3, 3 to 6 take 5.
  EXPECT_EQ(length(0, 0), 1u);
  EXPECT_EQ(length(1, 0), 3u);
  EXPECT_EQ(length(2, 0), 3u);
  EXPECT_EQ(length(3, 0), 5u);
  EXPECT_EQ(length(6, 0), 5u);
  EXPECT_EQ(length(7, 0), 7u);
  EXPECT_EQ(length(7, 3), 4u);
  EXPECT_EQ(length(8, 3), 6u);
}

TEST(Bits, SignedExpGolombSurvivesTheRoundTrip) {
  SplitMix64 rng(3);
  for (int i = 0; i < 20'000; ++i) {
    const int order = static_cast<int>(rng.below(16));
    const auto value = static_cast<std::int64_t>(rng.next()) >> (1 + rng.below(63));
    BitWriter out;
    out.signedGolomb(value, order);
    const std::string bytes = out.bytes();
    BitReader in(bytes);
    ASSERT_EQ(in.signedGolomb(order, value < 0 ? -value : value), value);
    ASSERT_TRUE(in.atEnd());
  }
}

TEST(Bits, AppendContinuesAtAnyBit) {
  SplitMix64 rng(4);
  for (int first = 0; first <= 70; ++first) {
    for (int second = 0; second <= 70; ++second) {
      BitWriter a;
      BitWriter b;
      BitWriter whole;
      for (int i = 0; i < first + second; ++i) {
        const bool bit = rng.below(2) == 1;
        (i < first ? a : b).flag(bit);
        whole.flag(bit);
      }
      a.append(b);
      ASSERT_EQ(a.bitCount(), whole.bitCount());
      ASSERT_EQ(a.bytes(), whole.bytes()) << first << " and " << second;
    }
  }
}

TEST(Bits, ClearedWriterIsLikeNew) {
  BitWriter out;
  out.bits(0x1FFF, 13);
  out.clear();
  EXPECT_EQ(out.bitCount(), 0u);
  out.bits(2, 2);
  EXPECT_EQ(out.bytes(), "\x02");
}

TEST(Bits, ReaderFailsWhenBitsAreMissing) {
  const std::string bytes = "\xFF\xFF";
  BitReader in(bytes);
  EXPECT_EQ(in.bits(15), 0x7FFFu);
  EXPECT_EQ(in.remainingBits(), 1u);
  EXPECT_EQ(in.bits(2), 0u);
  EXPECT_FALSE(in.ok());
}

TEST(Bits, AFailedReaderStaysFailedAndYieldsZeros) {
  const std::string bytes(40, '\xFF');
  BitReader in(bytes);
  in.fail();
  EXPECT_FALSE(in.ok());
  EXPECT_EQ(in.bits(8), 0u);
  EXPECT_FALSE(in.flag());
  EXPECT_EQ(in.signedBits(5), 0);
  EXPECT_EQ(in.golomb(0, 100), 0u);
  EXPECT_EQ(in.signedGolomb(0, 100), 0);
  EXPECT_FALSE(in.atEnd());
  EXPECT_FALSE(in.ok());
}

TEST(Bits, ExpGolombBeyondItsLimitFails) {
  for (const std::uint64_t most : {0u, 5u, 1000u}) {
    for (const std::uint64_t value : {most, most + 1}) {
      BitWriter out;
      out.golomb(value, 2);
      out.signedGolomb(static_cast<std::int64_t>(value), 2);
      out.signedGolomb(-static_cast<std::int64_t>(value), 2);
      const std::string bytes = out.bytes();
      BitReader in(bytes);
      EXPECT_EQ(in.golomb(2, most), value == most ? value : 0);
      EXPECT_EQ(in.ok(), value == most);
      BitReader again(bytes);
      again.golomb(2, value);
      EXPECT_EQ(again.signedGolomb(2, static_cast<std::int64_t>(most)),
                value == most ? static_cast<std::int64_t>(value) : 0);
      EXPECT_EQ(again.ok(), value == most);
      if (value == most) {
        EXPECT_EQ(again.signedGolomb(2, static_cast<std::int64_t>(most)), -static_cast<std::int64_t>(value));
      }
    }
  }
}

TEST(Bits, ExpGolombWithTooManyZerosFails) {
  for (int order = 0; order < 16; ++order) {
    const std::string nothing(30, '\0');
    BitReader in(nothing);
    EXPECT_EQ(in.golomb(order, UINT64_MAX), 0u);
    EXPECT_FALSE(in.ok());
  }
}

TEST(Bits, EndAllowsOnlyZeroPaddingInTheLastByte) {
  const auto endsAfter = [](int count, const std::string& bytes) {
    BitReader in(bytes);
    in.bits(count);
    return in.atEnd();
  };
  EXPECT_TRUE(endsAfter(0, ""));
  EXPECT_TRUE(endsAfter(3, std::string("\x07", 1)));
  EXPECT_FALSE(endsAfter(2, std::string("\x07", 1))) << "a bit is set";
  EXPECT_TRUE(endsAfter(8, std::string("\x07", 1)));
  EXPECT_FALSE(endsAfter(8, std::string("\x07\x00", 2))) << "a byte too many";
  EXPECT_FALSE(endsAfter(9, std::string("\x07", 1))) << "failed before";
}

}  // namespace
}  // namespace naiad
