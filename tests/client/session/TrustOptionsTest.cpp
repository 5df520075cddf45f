#include <gtest/gtest.h>

#include "client/session/TrustOptions.h"

namespace naiad {
namespace {

const std::string kKey = "abcdefghijklmnopqrstuvwxya";

struct Resolved {
  explicit Resolved(const std::string& text, const std::string& password = "", bool ambient = false,
                    const ServerTrust& given = {})
      : trust(given) {
    session.password = password;
    problem = resolveServer({.text = text, .is_password_ambient = ambient}, address, trust, session);
  }
  ServerAddress address;
  ServerTrust trust;
  SessionOptions session;
  std::string problem;
};

TEST(TrustOptions, ALinkNamesTheServerAndItsKey) {
  const Resolved link("naiad://[2001:db8::1]:9877#" + kKey);
  EXPECT_EQ(link.problem, "");
  EXPECT_EQ(link.address.text(), "[2001:db8::1]:9877");
  ASSERT_TRUE(link.trust.link_key);
  EXPECT_EQ(link.trust.link_key->text(), kKey);
  const Resolved address("game.example:9877");
  EXPECT_EQ(address.problem, "");
  EXPECT_EQ(address.address.text(), "game.example:9877");
  EXPECT_FALSE(address.trust.link_key);
}

TEST(TrustOptions, ErrorMessagesContainNoControlCharacters) {
  EXPECT_NE(Resolved("naiad://game.example").problem.find("it has no key"), std::string::npos);
  EXPECT_NE(Resolved("a b").problem.find("is not a valid server"), std::string::npos);
  const std::string hostile = Resolved("naiad://x\033]0;y\a\n#" + kKey).problem;
  EXPECT_NE(hostile.find("is not a valid link"), std::string::npos);
  for (const char c : hostile) EXPECT_GE(static_cast<unsigned char>(c), ' ');
}

TEST(TrustOptions, AddressMayNameTheFirstRoom) {
  const Resolved link("naiad://game.example/tron#" + kKey);
  EXPECT_EQ(link.problem, "");
  EXPECT_EQ(link.session.room, "tron");
  for (const char* text : {"game.example/tron", "game.example:9876/tron"}) {
    const Resolved address(text);
    EXPECT_EQ(address.problem, "") << text;
    EXPECT_EQ(address.address.text(), "game.example:9876");
    EXPECT_EQ(address.session.room, "tron");
  }
  EXPECT_EQ(Resolved("[::1]:9877/a-b.c_d").session.room, "a-b.c_d");
  EXPECT_EQ(Resolved("game.example").session.room, "");
  for (const char* text :
       {"game.example/", "game.example/a/b", "game.example/-x", "game.example/x y", "game.example/\033[2J"}) {
    const std::string problem = Resolved(text).problem;
    EXPECT_NE(problem.find("is not a valid room name"), std::string::npos) << text;
    for (const char c : problem) EXPECT_GE(static_cast<unsigned char>(c), ' ');
  }
}

TEST(TrustOptions, OptionsThatContradictALinkAreErrors) {
  ServerTrust other;
  other.fingerprint = Fingerprint::parse(std::string(64, 'f'));
  EXPECT_NE(Resolved("naiad://game.example#" + kKey, "", false, other).problem, "");
  EXPECT_EQ(
      Resolved("naiad://game.example#" + ShortKey::of(*other.fingerprint).text(), "", false, other).problem,
      "");
  ServerTrust insecure;
  insecure.insecure = true;
  EXPECT_NE(Resolved("naiad://127.0.0.1#" + kKey, "", false, insecure).problem, "");
}

TEST(TrustOptions, EnvironmentPasswordIsNotUsedForLinks) {
  EXPECT_EQ(Resolved("naiad://game.example#" + kKey, "xyzzy", true).session.password, "");
  EXPECT_EQ(Resolved("naiad://game.example#" + kKey, "xyzzy", false).session.password, "xyzzy");
  EXPECT_EQ(Resolved("game.example", "xyzzy", true).session.password, "xyzzy");
}

TEST(TrustOptions, WebPageAddressSelectsItsGateway) {
  const Resolved page("https://play.example:8443/#" + kKey, "xyzzy", true);
  EXPECT_EQ(page.problem, "");
  ASSERT_TRUE(page.trust.gateway);
  EXPECT_TRUE(page.trust.gateway->encrypted);
  EXPECT_EQ(page.trust.gateway->hostText(), "play.example:8443");
  EXPECT_EQ(page.session.password, "") << "addresses come from strangers, as links do";
  const Resolved local("http://[::1]/");
  ASSERT_TRUE(local.trust.gateway);
  EXPECT_FALSE(local.trust.gateway->encrypted);
  EXPECT_EQ(local.trust.gateway->hostText(), "[::1]");
  for (const char* wrong :
       {"https://", "https://-x/", "https://a@b/", "https://host/other", "http://host:0/"})
    EXPECT_NE(Resolved(wrong).problem, "") << wrong;
  ServerTrust insecure;
  insecure.insecure = true;
  EXPECT_NE(Resolved("http://127.0.0.1:80/", "", false, insecure).problem, "");
}

TEST(TrustOptions, VisitNeedsASocketAndAnAddress) {
  const auto problem = [](const std::string& visitors, const std::string& visitor, bool insecure = false) {
    ServerAddress address;
    ServerTrust trust;
    trust.insecure = insecure;
    SessionOptions session;
    const ServerChoice choice{.text = "127.0.0.1", .visitors = visitors, .visitor = visitor};
    const std::string wrong = resolveServer(choice, address, trust, session);
    EXPECT_EQ(wrong.empty() && !visitors.empty(), session.proxy.has_value());
    return wrong;
  };
  EXPECT_EQ(problem("", ""), "");
  EXPECT_EQ(problem("/run/x", "192.0.2.7:50312"), "");
  EXPECT_NE(problem("/run/x", ""), "");
  EXPECT_NE(problem("", "192.0.2.7:50312"), "");
  EXPECT_NE(problem("/run/x", "192.0.2.7"), "");
  EXPECT_NE(problem("/run/x", "192.0.2.7:50312", true), "");
}

TEST(TrustOptions, ListedServerUsesListKeyWithoutEnvironmentPassword) {
  const auto resolve = [](const std::string& text, bool ambient, ServerTrust& trust) {
    SessionOptions session;
    session.password = "xyzzy";
    ServerAddress address;
    const ServerChoice server{
        .text = text, .is_password_ambient = ambient, .list_key = *ShortKey::parse(kKey)};
    EXPECT_EQ(resolveServer(server, address, trust, session), "") << text;
    return session.password;
  };
  for (const std::string& text : {"naiad://192.168.1.5#" + kKey, std::string("[fe80::5%eth0]:9876")}) {
    ServerTrust trust;
    EXPECT_EQ(resolve(text, true, trust), "");
    ASSERT_TRUE(trust.link_key) << text;
    EXPECT_EQ(trust.link_key->text(), kKey);
    EXPECT_EQ(resolve(text, false, trust), "xyzzy") << "typed for this server";
  }
}

TEST(TrustOptions, OptionsThatContradictAListedKeyAreErrors) {
  ServerTrust trust;
  trust.insecure = true;
  ServerAddress address;
  SessionOptions session;
  const ServerChoice server{.text = "[fe80::5%eth0]:9876", .list_key = *ShortKey::parse(kKey)};
  EXPECT_NE(resolveServer(server, address, trust, session), "");
  trust = {};
  trust.fingerprint = Fingerprint::parse(std::string(64, 'f'));
  EXPECT_NE(resolveServer(server, address, trust, session), "");
}

}  // namespace
}  // namespace naiad
