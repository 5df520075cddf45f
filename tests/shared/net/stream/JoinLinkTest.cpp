#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

const std::string kKey = "abcdefghijklmnopqrstuvwxya";  // its last bits are 0
const std::string kHex = "0123456789abcdef0123456789abcdeffedcba9876543210fedcba9876543210";

std::optional<JoinLink> parse(const std::string& text) {
  const auto parsed = JoinLink::parse(text);
  const auto* p_link = std::get_if<JoinLink>(&parsed);
  return p_link != nullptr ? std::optional(*p_link) : std::nullopt;
}

std::string problem(const std::string& text) {
  const auto parsed = JoinLink::parse(text);
  const auto* p_problem = std::get_if<LinkError>(&parsed);
  return p_problem != nullptr ? p_problem->message : "";
}

TEST(ShortKey, IsTheFirst128BitsInBase32) {
  // Output of coreutils' base32 for the 16 bytes 01 23 … ef 01 23 … ef.
  EXPECT_EQ(ShortKey::of(*Fingerprint::parse(kHex)).text(), "aerukz4jvpg66ajdivtytk6n54");
}

TEST(ShortKey, OnlyTheFirstHalfOfTheFingerprintCounts) {
  const ShortKey whole = ShortKey::of(*Fingerprint::parse(kHex));
  for (std::size_t digit = 0; digit < kHex.size(); ++digit) {
    std::string other = kHex;
    other[digit] = other[digit] == '0' ? '1' : '0';
    EXPECT_EQ(ShortKey::of(*Fingerprint::parse(other)) == whole, digit >= 32) << digit;
  }
}

TEST(ShortKey, TextSurvivesTheRoundTripInEitherCase) {
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    std::string hex;
    for (int digit = 0; digit < 64; ++digit) hex += "0123456789abcdef"[random() % 16];
    const ShortKey key = ShortKey::of(*Fingerprint::parse(hex));
    std::string upper = key.text();
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    EXPECT_EQ(ShortKey::parse(key.text()), key);
    EXPECT_EQ(ShortKey::parse(upper), key);
    EXPECT_EQ(key.text().size(), 26u);
  }
}

TEST(ShortKey, MalformedTextsAreRefused) {
  ASSERT_TRUE(ShortKey::parse(kKey));
  for (const std::string& text :
       {std::string(), kKey.substr(1), kKey + "a", "0" + kKey.substr(1), "1" + kKey.substr(1),
        "8" + kKey.substr(1), kKey.substr(1) + "=", kKey.substr(1) + "b", kHex, std::string(26, '\0')}) {
    EXPECT_FALSE(ShortKey::parse(text)) << text;
  }
}

TEST(JoinLink, AcceptsPrintedAndEscapedLinks) {
  const struct {
    std::string text;
    std::string host;
    int port;
    std::string room;
  } good[] = {{"naiad://game.example#" + kKey, "game.example", 9876, ""},
              {"naiad://game.example:9877#" + kKey, "game.example", 9877, ""},
              {"NAIAD://Game.Example/#" + kKey, "Game.Example", 9876, ""},
              {"naiad://192.0.2.7:1/tron#" + kKey, "192.0.2.7", 1, "tron"},
              {"naiad://[2001:db8::1]#" + kKey, "2001:db8::1", 9876, ""},
              {"naiad://[::1]:65535/a.b-c_9#" + kKey, "::1", 65535, "a.b-c_9"},
              {"naiad://%5B::1%5D:65535/tr%6fn#%61" + kKey.substr(1), "::1", 65535, "tron"},
              {"naiad://a_b.c-d.example.#" + kKey, "a_b.c-d.example.", 9876, ""}};
  for (const auto& g : good) {
    const auto link = parse(g.text);
    ASSERT_TRUE(link) << g.text << ": " << problem(g.text);
    EXPECT_EQ(link->address.host, g.host);
    EXPECT_EQ(link->address.port, g.port);
    EXPECT_EQ(link->room, g.room);
    EXPECT_EQ(link->key.text(), kKey);
    EXPECT_EQ(parse(link->text()), link);
  }
  EXPECT_EQ(parse("naiad://[::1]:9876/tron#" + kKey)->text(), "naiad://[::1]/tron#" + kKey);
}

TEST(JoinLink, EachFaultHasItsOwnMessage) {
  using Texts = std::vector<std::string>;
  const auto expectMessage = [](const char* part, const Texts& links) {
    for (const std::string& link : links)
      EXPECT_NE(problem(link).find(part), std::string::npos) << link << ": " << problem(link);
  };
  expectMessage("no key", {"naiad://game.example", "naiad://game.example#"});
  expectMessage("26 letters", {"naiad://game.example#" + kKey.substr(1), "naiad://game.example#" + kHex,
                               "naiad://game.example#" + kKey + "#", "naiad://game.example#%"});
  expectMessage("naiad://", {"naiad:game.example#" + kKey, "http://game.example#" + kKey});
  const std::pair<const char*, Texts> places[] = {
      {"?", {"game.example?password=x"}},
      {"user", {"ann@game.example", "ann%40game.example"}},
      {"space", {"ga me", "game\033[2J"}},
      {"ASCII", {"g\xc3\xa4me"}},
      {"printable", {"game%1b", "game%00", "game%2", "game%-1", "game/%zz"}},
      {"512", {std::string(600, 'a')}},
      {"room",
       {"game.example/a/b", "game.example/../x", "game.example/.", "game.example/-x",
        "game.example/" + std::string(33, 'a')}}};
  for (const auto& [part, texts] : places) {
    for (const std::string& text : texts) expectMessage(part, {"naiad://" + text + "#" + kKey});
  }
}

TEST(JoinLink, InvalidHostsAreRefused) {
  EXPECT_FALSE(parse("naiad://#" + kKey));
  EXPECT_FALSE(parse("naiad://" + std::string(64, 'a') + "#" + kKey));
  std::istringstream hosts(
      "-oProxyCommand=x %2dv . a..b .a a: a:0 a:65536 a:+1 a:000001 a:1:2 ::1 [::1 [] [::1]9 [127.0.0.1] "
      "[fe80::1%25eth0] a;b a$b a`b a,b a*");
  for (std::string host; hosts >> host;) EXPECT_FALSE(parse("naiad://" + host + "#" + kKey)) << host;
}

// LinkHost also parses texts that may hold any byte, for example addresses of pages.
TEST(LinkHostTest, ZeroByteDoesNotEndAnAddress) {
  EXPECT_TRUE(LinkHost::parse("[::1]", 1));
  EXPECT_FALSE(LinkHost::parse(std::string_view("[::1\0]", 6), 1));
}

}  // namespace
}  // namespace naiad
