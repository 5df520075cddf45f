// The small codec agrees with protobuf for the features that it has: each reads what the other writes, and
// both accept or reject an input.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "kinds.twins.h"
#include "naiad.twins.h"
#include "proto/ParseErrors.h"
#include "proto/small/Utf8.h"
#include "tests/proto/RandomFields.h"
#include "tests/support/Sanitizers.h"

namespace naiad::test {
namespace {

constexpr int kDepth = 2;                                ///< depth of random nested messages
constexpr int kMessages = kSanitized ? 200 : 2'000;      ///< number of messages per type
constexpr int kMutations = kSanitized ? 5'000 : 60'000;  ///< number of mutations per type

/// Returns bytes in hex for failures.
std::string hex(const std::string& bytes) {
  std::string text;
  for (const char byte : bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    text += kDigits[static_cast<unsigned char>(byte) >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

template <class Twins>
std::string validBytes(RandomFields& random) {
  typename Twins::Real message;
  Twins::fill(random, message, kDepth);
  return message.SerializeAsString();
}

/// Reads `bytes` with both codecs, which must agree and find equal fields. Returns true if they accept the
/// bytes.
template <class Twins>
bool readByBoth(const std::string& bytes) {
  typename Twins::Real real, known;
  typename Twins::Small small;
  const bool good = real.ParseFromString(bytes);
  if (small.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())) != good) {
    ADD_FAILURE() << "protobuf " << (good ? "accepts " : "refuses ") << hex(bytes);
    return good;
  }
  if (!good) return false;
  Twins::copy(real, known);  // protobuf keeps unknown fields and writes them
  const std::string expected = known.SerializeAsString(), actual = small.SerializeAsString();
  if (actual != expected) ADD_FAILURE() << hex(bytes) << " is " << hex(actual) << ", not " << hex(expected);
  return true;
}

template <class Types>
class SmallProto : public testing::Test {
 protected:
  void SetUp() override { silenceParseErrors(); }
};

template <class Real, class Small>
struct Concat;
template <class... Some, class... More>
struct Concat<testing::Types<Some...>, testing::Types<More...>> {
  using type = testing::Types<Some..., More...>;
};
using AllTypes = Concat<naiad_twins::In<testing::Types>, kinds_twins::In<testing::Types>>::type;
TYPED_TEST_SUITE(SmallProto, AllTypes);

TYPED_TEST(SmallProto, SettersMakeTheSameBytes) {
  for (std::uint64_t seed = 0; seed < kMessages; ++seed) {
    typename TypeParam::Real real;
    typename TypeParam::Small small;
    RandomFields for_real(seed), for_small(seed);
    TypeParam::fill(for_real, real, kDepth);
    TypeParam::fill(for_small, small, kDepth);
    ASSERT_EQ(hex(small.SerializeAsString()), hex(real.SerializeAsString())) << seed;
  }
}

TYPED_TEST(SmallProto, EachReadsWhatTheOtherWrites) {
  for (std::uint64_t seed = 0; seed < kMessages; ++seed) {
    typename TypeParam::Real real, real_again;
    typename TypeParam::Small small, small_again;
    RandomFields random(seed);
    TypeParam::fill(random, real, kDepth);
    const std::string bytes = real.SerializeAsString();
    ASSERT_TRUE(small.ParseFromString(bytes)) << hex(bytes);
    ASSERT_EQ(hex(small.SerializeAsString()), hex(bytes));
    ASSERT_TRUE(real_again.ParseFromString(small.SerializeAsString()));
    // The getters return equal values, field by field.
    typename TypeParam::Real from_small;
    TypeParam::copy(small, from_small);
    ASSERT_EQ(hex(from_small.SerializeAsString()), hex(bytes));
    TypeParam::copy(real_again, small_again);
    ASSERT_EQ(hex(small_again.SerializeAsString()), hex(bytes));
  }
}

TYPED_TEST(SmallProto, CopiesAndMovesKeepAllFields) {
  for (std::uint64_t seed = 0; seed < kMessages / 10; ++seed) {
    typename TypeParam::Small small, assigned;
    RandomFields random(seed);
    TypeParam::fill(random, small, kDepth);
    TypeParam::fill(random, assigned, kDepth);
    const std::string bytes = small.SerializeAsString();
    typename TypeParam::Small copy(small);
    assigned = small;
    assigned = *&assigned;
    const typename TypeParam::Small moved(std::move(small));
    ASSERT_EQ(hex(copy.SerializeAsString()), hex(bytes));
    ASSERT_EQ(hex(assigned.SerializeAsString()), hex(bytes));
    ASSERT_EQ(hex(moved.SerializeAsString()), hex(bytes));
    small = std::move(copy);
    ASSERT_EQ(hex(small.SerializeAsString()), hex(bytes));
    small.Clear();
    ASSERT_EQ(small.SerializeAsString(), "");
    ASSERT_EQ(hex(moved.SerializeAsString()), hex(bytes)) << "copies share nothing";
  }
}

TYPED_TEST(SmallProto, CodecsAgreeOnMutatedBytes) {
  RandomFields random(7);
  std::string whole = validBytes<TypeParam>(random), other = whole;
  int accepted = 0;
  for (int i = 0; i < kMutations; ++i) {
    if (i % 16 == 0) other = std::exchange(whole, validBytes<TypeParam>(random));
    std::string bytes = i % 8 == 0 ? randomFields(random, kDepth) : whole;
    for (std::uint64_t changes = 1 + random.below(3); changes > 0; --changes) mutate(random, bytes, other);
    accepted += readByBoth<TypeParam>(bytes) ? 1 : 0;
    if (i % 64 == 0 && testing::Test::HasFailure()) return;
  }
  // Accepted and rejected inputs are both frequent, so the comparison is meaningful.
  EXPECT_GT(accepted, kMutations / 10);
  EXPECT_LT(accepted, kMutations * 9 / 10);
}

TYPED_TEST(SmallProto, CodecsAgreeOnAllTwoByteInputs) {
  const int step = kSanitized ? 7 : 1;
  for (int bytes = 0; bytes < 0x10000; bytes += step) {
    readByBoth<TypeParam>({static_cast<char>(bytes), static_cast<char>(bytes >> 8)});
    if (testing::Test::HasFailure()) return;
  }
}

TYPED_TEST(SmallProto, CodecsAgreeOnFieldsOfEveryWireType) {
  // Lengths of 2^31 − 1 and more, numbers of ten bytes and more, and some valid values.
  const std::vector<std::string> values = {std::string(8, '\0'),
                                           "\x01\x01",
                                           "\x80",
                                           std::string(8, '\x7F'),
                                           std::string(10, '\xFF'),
                                           "\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x7F",
                                           "\xFF\xFF\xFF\xFF\x07",
                                           "\xFF\xFF\xFF\xFF\x0F"};
  for (int key = 0; key < 40 * 8; ++key) {
    const std::string head = {static_cast<char>(key | 0x80), static_cast<char>(key >> 7)};
    for (const std::string& value : values) {
      for (std::size_t size = 0; size <= value.size(); ++size) {
        readByBoth<TypeParam>(head + value.substr(0, size));
        ASSERT_FALSE(testing::Test::HasFailure());
      }
    }
  }
}

using Real = naiad::kinds::Kinds;
using Small = naiad::small_kinds::Kinds;

bool bothAccept(const std::string& bytes) {
  silenceParseErrors();
  return readByBoth<kinds_twins::Kinds>(bytes);
}

/// Returns `levels` nested messages, or nested unknown groups.
std::string nested(int levels, bool group) {
  std::string bytes;
  for (int i = 0; i < levels; ++i) {
    if (group) {
      bytes = "\x2B" + bytes + "\x2C";
      continue;
    }
    std::string size;
    std::size_t left = bytes.size();
    for (; left >= 0x80; left >>= 7) size.push_back(static_cast<char>(left | 0x80));
    bytes = "\x9A\x01" + size + static_cast<char>(left) + bytes;
  }
  return bytes;
}

TEST(SmallProtoLimits, NestingIsLimitedTo100Levels) {
  for (const bool group : {false, true}) {
    EXPECT_TRUE(bothAccept(nested(100, group)));
    EXPECT_FALSE(bothAccept(nested(101, group)));
    EXPECT_FALSE(bothAccept(nested(10'000, group)));
  }
}

TEST(SmallProtoLimits, GroupsEndWithTheirOwnNumber) {
  EXPECT_TRUE(bothAccept("\x2B\x08\x01\x2C"));
  EXPECT_TRUE(bothAccept("\x2B\x33\x34\x2C"));
  EXPECT_FALSE(bothAccept("\x2B\x34"));
  EXPECT_FALSE(bothAccept("\x2B\x33\x2C\x34"));
  EXPECT_FALSE(bothAccept("\x2B"));
  EXPECT_FALSE(bothAccept("\x2C"));
  EXPECT_FALSE(bothAccept("\x9A\x01\x01\x2C")) << "in a message";
}

TEST(SmallProtoLimits, VarintLengthIsLimitedToFiveOrTenBytes) {
  EXPECT_TRUE(bothAccept(std::string("\xA0\x80\x80\x80\x00\x01", 6)));
  EXPECT_FALSE(bothAccept(std::string("\xA0\x80\x80\x80\x80\x00\x01", 7)));
  EXPECT_TRUE(bothAccept(std::string("\x8A\x01\x81\x80\x80\x80\x00x", 8)));
  EXPECT_FALSE(bothAccept(std::string("\x8A\x01\x81\x80\x80\x80\x80\x00x", 9)));
  EXPECT_TRUE(bothAccept("\x20\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x7F"));
  EXPECT_FALSE(bothAccept("\x20\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01"));
}

TEST(SmallProtoLimits, ANegativeSizeIsRefused) {
  Small small;
  EXPECT_FALSE(small.ParseFromArray("", -1));
}

TEST(SmallProtoLimits, CodecsAgreeOnValidUtf8) {
  silenceParseErrors();
  // All texts of two bytes, and those of three and four whose last bytes are at the ends of their ranges.
  const std::string lasts = "\x7F\x80\x8F\x90\x9F\xA0\xBF\xC0";
  for (int bytes = 0; bytes < 0x10000; ++bytes) {
    const std::string two = {static_cast<char>(bytes), static_cast<char>(bytes >> 8)};
    std::vector<std::string> texts = {two};
    if ((bytes & 0xC0) == 0xC0) {
      for (const char third : lasts) {
        texts.push_back(two + third);
        for (const char fourth : lasts) texts.push_back(two + third + fourth);
      }
    }
    for (const std::string& text : texts) {
      Real real;
      const std::string field = "\x8A\x01" + std::string(1, static_cast<char>(text.size())) + text;
      ASSERT_EQ(small::isUtf8(text), real.ParseFromString(field)) << hex(text);
      // Puts the text behind eight ASCII bytes, because isUtf8() checks eight at once.
      const std::string behind = "12345678" + text;
      ASSERT_EQ(small::isUtf8(behind), small::isUtf8(text)) << hex(text);
    }
  }
}

// bothAccept() compares the fields, too.
TEST(SmallProtoFields, CodecsAgreeOnDuplicatesAndLongNumbers) {
  // deeper { number 7 } and deeper { signed_number 2 }, which are merged, but not with a text between them.
  const std::string one("\xE2\x12\x02\x20\x07", 5), two("\xE2\x12\x02\x18\x04", 5), text("\xF2\x01\x01x", 4);
  const std::string packed("\xFA\x7F\x02\x01\x02", 5), single("\xF8\x7F\x03", 3);
  for (const std::string& bytes :
       {std::string("\x9A\x01\x02\x20\x07\x9A\x01\x02\x18\x04", 10),  // child, twice
        one + two, one + text + two, packed + single + packed,
        // 2^32 + 5 and 2^32 in fields of 32 bits, and 2^32 and 2^70 as a bool.
        std::string("\x20\x85\x80\x80\x80\x10\x18\x80\x80\x80\x80\x10"),
        std::string("\x10\x80\x80\x80\x80\x10"),
        std::string("\x10\x80\x80\x80\x80\x80\x80\x80\x80\x80\x40")}) {
    EXPECT_TRUE(bothAccept(bytes)) << hex(bytes);
  }
}

TEST(SmallProtoFields, AOneofHoldsOneOfItsMembers) {
  Small small;
  EXPECT_EQ(small.first_choice_case(), Small::FIRST_CHOICE_NOT_SET);
  EXPECT_EQ(&small.deeper(), &Small::default_instance());
  small.set_choice_text("x");
  EXPECT_EQ(small.first_choice_case(), Small::kChoiceText);
  small.mutable_deeper()->set_number(3);
  EXPECT_TRUE(small.has_deeper() && !small.has_choice_text() && !small.has_empty());
  EXPECT_EQ(small.mutable_choice_text()->size(), 0u);
  small.set_second_blob2("kept");
  small.clear_first_choice();
  EXPECT_EQ(small.first_choice_case(), Small::FIRST_CHOICE_NOT_SET);
  EXPECT_EQ(small.second_case(), Small::kSecondBlob2);
  const Small moved = std::move(small);
  EXPECT_EQ(small.second_case(), Small::SECOND_NOT_SET);
  EXPECT_EQ(moved.second_blob2(), "kept");
}

TEST(SmallProtoFields, RepeatedFieldsStoreTheirElements) {
  Small small;
  small.add_numbers(1);
  small.set_numbers(0, 5);
  EXPECT_EQ(small.numbers(0), 5u);
  EXPECT_EQ(small.numbers_size(), 1);
  *small.add_texts() = "a";
  small.add_texts("b");
  small.set_texts(0, "c");
  *small.mutable_texts(1) += "d";
  EXPECT_EQ(small.texts(), (std::vector<std::string>{"c", "bd"}));
  small.add_children()->set_number(1);
  small.add_children()->set_number(2);
  small.mutable_children(1)->set_flag(true);
  EXPECT_EQ(small.children_size(), 2);
  EXPECT_EQ(small.children().size(), 2);
  EXPECT_TRUE(small.children(1).flag() && small.children()[1].flag());
  std::uint32_t sum = 0;
  for (const Small& child : small.children()) sum += child.number();
  EXPECT_EQ(sum, 3u);
}

TEST(SmallProtoFields, EnumsMatchProtobuf) {
  using Other = naiad::small_wire::Refused;
  using Known = naiad::wire::Refused;
  static_assert(int{Other::SESSION_MOVED} == int{Known::SESSION_MOVED});
  static_assert(int{Other::Reason_MIN} == int{Known::Reason_MIN} &&
                int{Other::Reason_MAX} == int{Known::Reason_MAX});
  static_assert(int{naiad::small_wire::Refused_Reason_BUSY} == int{naiad::wire::Refused_Reason_BUSY});
  static_assert(int{Small::LOW} == -3 && int{Small::Level_MIN} == int{Real::Level_MIN});
  for (int value = -5; value < 20; ++value) {
    EXPECT_EQ(Other::Reason_IsValid(value), Known::Reason_IsValid(value)) << value;
    EXPECT_EQ(Small::Level_IsValid(value), Real::Level_IsValid(value)) << value;
  }
}

}  // namespace
}  // namespace naiad::test
