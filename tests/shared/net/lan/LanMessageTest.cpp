#include <gtest/gtest.h>

#include "../../../support/HostileTexts.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/lan/LanMessage.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

LanNonce nonceOf(std::uint8_t first) {
  LanNonce nonce;
  for (std::size_t i = 0; i < nonce.size(); ++i) nonce[i] = static_cast<std::uint8_t>(first + i);
  return nonce;
}

LanAnswer sample() {
  LanAnswer answer;
  answer.protocol = 0x0104;
  answer.nonce = nonceOf(0x40);
  answer.port = 9876;
  answer.requires_password = true;
  answer.players = 3;
  answer.max_players = 64;
  ShortKey::Bytes key{};
  key[0] = 0xab;
  key[15] = 0xcd;
  answer.key = ShortKey::ofBytes(key);
  answer.name = "Ann's";
  answer.game = "hello";
  return answer;
}

bool isSafe(const std::string& text) {
  return safeText(text, kMaxLanText) == text && columnsOf(text) <= kMaxLanText;
}

TEST(LanMessage, QueryBytesMatchTheDocument) {
  const std::string query = writeLanQuery(nonceOf(0x40));
  ASSERT_EQ(query.size(), 512u);
  EXPECT_EQ(query.substr(0, 8), std::string("nlan\1\1\0\0", 8));
  EXPECT_EQ(query.substr(8, 16), "@ABCDEFGHIJKLMNO");
  EXPECT_EQ(query.substr(24), std::string(488, '\0'));
  EXPECT_EQ(readLanQuery(query), nonceOf(0x40));
}

TEST(LanMessage, AnswerBytesMatchTheDocument) {
  const std::string bytes = writeLanAnswer(sample());
  const std::string wanted = std::string("nlan\1\2\4\1", 8) + "@ABCDEFGHIJKLMNO" +
                             std::string("\x94\x26\1\0\3\0\x40\0", 8) +
                             ("\xab" + std::string(14, '\0') + "\xcd") + "\5Ann's\5hello";
  EXPECT_EQ(bytes, wanted);
  EXPECT_EQ(readLanAnswer(bytes), sample());
}

TEST(LanMessage, OnlyACompleteQueryIsAccepted) {
  const std::string query = writeLanQuery(nonceOf(1));
  for (std::size_t size = 0; size < query.size(); ++size)
    EXPECT_FALSE(readLanQuery(query.substr(0, size))) << size;
  EXPECT_FALSE(readLanQuery(query + '\0'));
  for (std::size_t i = 0; i < query.size(); ++i) {
    if (i >= 8 && i < 24) continue;  // any nonce is valid
    for (int bit = 0; bit < 8; ++bit) {
      std::string other = query;
      other[i] = static_cast<char>(other[i] ^ (1 << bit));
      EXPECT_FALSE(readLanQuery(other)) << i;
    }
  }
}

TEST(LanMessage, AnswersSurviveTheRoundTrip) {
  SplitMix64 random(7);
  for (int i = 0; i < 2000; ++i) {
    LanAnswer answer = sample();
    answer.port = static_cast<std::uint16_t>(1 + random.below(65535));
    answer.protocol = static_cast<std::uint32_t>(random.below(65536));
    answer.players = static_cast<std::uint16_t>(random.next());
    answer.max_players = static_cast<std::uint16_t>(random.next());
    answer.requires_password = random.below(2) == 0;
    for (std::uint8_t& byte : answer.nonce) byte = static_cast<std::uint8_t>(random.next());
    answer.name.assign(random.below(kMaxLanText + 1), 'n');
    answer.game.clear();
    for (std::size_t left = random.below(kMaxLanText + 1); left > 0; --left) answer.game += "\u2588";
    const std::string bytes = writeLanAnswer(answer);
    ASSERT_LE(bytes.size(), kLanQuerySize);
    ASSERT_EQ(readLanAnswer(bytes), answer);
  }
}

TEST(LanMessage, AnAnswerIsNeverLongerThanItsQuery) {
  LanAnswer answer = sample();
  for (const char* p_character : {"x", "\u00e9", "\u2588", "\U0001F600", "\x1b", "\xff"}) {
    answer.name.clear();
    for (int i = 0; i < 10'000; ++i) answer.name += p_character;
    answer.game = answer.name;
    EXPECT_LE(writeLanAnswer(answer).size(), kLanQuerySize);
    EXPECT_TRUE(readLanAnswer(writeLanAnswer(answer))) << p_character;
  }
}

TEST(LanMessage, TruncatedAndOverlongAnswersAreRefused) {
  const std::string bytes = writeLanAnswer(sample());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(readLanAnswer(bytes.substr(0, size))) << size;
  EXPECT_FALSE(readLanAnswer(bytes + '\0'));
  EXPECT_FALSE(readLanAnswer(writeLanQuery(nonceOf(0x40))));
}

TEST(LanMessage, OutOfRangeAnswerFieldsAreRefused) {
  const std::string bytes = writeLanAnswer(sample());
  const auto with = [&bytes](std::size_t at, const std::string& piece) {
    std::string other = bytes;
    other.replace(at, piece.size(), piece);
    return readLanAnswer(other).has_value();
  };
  EXPECT_TRUE(with(0, "nlan"));
  EXPECT_FALSE(with(0, "nlam"));
  EXPECT_FALSE(with(4, "\2"));                     // unknown format
  EXPECT_FALSE(with(5, "\1"));                     // a query
  EXPECT_FALSE(with(24, std::string("\0\0", 2)));  // port 0
  EXPECT_FALSE(with(26, "\2"));                    // unknown flag
  EXPECT_FALSE(with(27, "\1"));
  EXPECT_FALSE(with(48, "\6"));  // the name would include a byte of the game
  EXPECT_FALSE(with(48, "\xff"));
  std::string longer = bytes.substr(0, 48) + static_cast<char>(161) + std::string(161, 'x') + '\0';
  EXPECT_FALSE(readLanAnswer(longer));
}

TEST(LanMessage, HostileTextsAreMadeSafe) {
  for (const test::HostileText& text : test::hostileTexts()) {
    const std::string piece = text.bytes.substr(0, kMaxLanTextBytes);
    std::string bytes = writeLanAnswer(sample()).substr(0, 48);
    bytes += static_cast<char>(piece.size()) + piece + static_cast<char>(piece.size()) + piece;
    const auto answer = readLanAnswer(bytes);
    ASSERT_TRUE(answer) << text.what;
    EXPECT_TRUE(isSafe(answer->name)) << text.what;
    EXPECT_TRUE(isSafe(answer->game)) << text.what;
  }
}

}  // namespace
}  // namespace naiad
