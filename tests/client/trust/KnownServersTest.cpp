#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>

#include "client/trust/KnownServers.h"
#include "shared/net/base/SafeFile.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

Fingerprint key(char digit) {
  return *Fingerprint::parse(std::string(64, digit));
}

PeerIdentity selfSigned(char digit) {
  return {key(digit), false, "self-signed certificate"};
}

PeerIdentity verified(char digit) {
  return {key(digit), true, ""};
}

struct KnownServersTest : testing::Test {
  Trust admit(const PeerIdentity& facts, const std::optional<Fingerprint>& given = {},
              const std::string& host = "game.test") {
    return servers.admit(host, 9876, facts, given).trust;
  }
  std::string content() const { return readSmallFile(path, 10'000'000).value_or("(missing)"); }
  void write(const std::string& text) const {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }

  test::TempFolder base;
  const fs::path path = base / "share" / "naiad" / "known_servers";
  KnownServers servers{path};
};

TEST_F(KnownServersTest, FirstUsePinsKeyPrivatelyAndTrustsItLater) {
  EXPECT_EQ(admit(selfSigned('a')), Trust::kFirstUse);
  EXPECT_EQ(content(), "game.test:9876 " + std::string(64, 'a') + "\n");
  EXPECT_EQ(test::modeOf(path), 0600U);
  EXPECT_EQ(admit(selfSigned('a')), Trust::kPinned);
  EXPECT_TRUE(servers.problems().empty());
}

TEST_F(KnownServersTest, ChangedKeyIsAlwaysRefusedWithAWarning) {
  admit(selfSigned('a'));
  for (int i = 0; i < 2; ++i) {
    const TrustResult verdict = servers.admit("game.test", 9876, selfSigned('b'), {});
    EXPECT_EQ(verdict.trust, Trust::kChanged);
    EXPECT_FALSE(verdict.accepted());
    EXPECT_NE(verdict.message.find("THE KEY OF game.test:9876 HAS CHANGED"), std::string::npos);
    EXPECT_NE(verdict.message.find("--fingerprint " + std::string(64, 'b')), std::string::npos);
  }
  EXPECT_EQ(admit(selfSigned('a')), Trust::kPinned);
}

TEST_F(KnownServersTest, JudgingWritesNothing) {
  EXPECT_EQ(servers.verify("game.test", 9876, selfSigned('a'), {}).trust, Trust::kFirstUse);
  EXPECT_EQ(content(), "(missing)");
}

TEST_F(KnownServersTest, GivenFingerprintOverridesTheChainAndThePin) {
  EXPECT_EQ(admit(selfSigned('a'), key('b')), Trust::kFingerprintMismatch);
  EXPECT_EQ(admit(verified('a'), key('b')), Trust::kFingerprintMismatch);
  EXPECT_EQ(content(), "(missing)");
  admit(selfSigned('a'));
  EXPECT_EQ(admit(selfSigned('b'), key('b')), Trust::kFingerprintMatch);
  EXPECT_EQ(admit(selfSigned('b')), Trust::kPinned);
  EXPECT_EQ(admit(selfSigned('a')), Trust::kChanged);
}

TEST_F(KnownServersTest, MatchingLinkKeyPinsTheFullKey) {
  const auto admitBy = [this](const PeerIdentity& facts, char digit) {
    return servers.admit("game.test", 9876, facts, {}, ShortKey::of(key(digit)));
  };
  EXPECT_EQ(admitBy(selfSigned('a'), 'b').trust, Trust::kLinkMismatch);
  EXPECT_EQ(admitBy(verified('a'), 'b').trust, Trust::kLinkMismatch);
  EXPECT_FALSE(admitBy(selfSigned('a'), 'b').accepted());
  EXPECT_EQ(content(), "(missing)");
  EXPECT_EQ(admitBy(selfSigned('a'), 'a').trust, Trust::kLinkMatch);
  EXPECT_EQ(content(), "game.test:9876 " + std::string(64, 'a') + "\n");
  EXPECT_EQ(admitBy(selfSigned('a'), 'a').trust, Trust::kPinned);
  EXPECT_EQ(admit(selfSigned('a')), Trust::kPinned);
  // The second half of the key is in the pin but not in the link.
  const PeerIdentity twin{*Fingerprint::parse(std::string(32, 'a') + std::string(32, 'b')), false,
                          "self-signed"};
  EXPECT_EQ(admitBy(twin, 'a').trust, Trust::kChanged);
}

TEST_F(KnownServersTest, FingerprintReplacesThePinButLinkDoesNot) {
  admit(selfSigned('a'));
  const auto link = ShortKey::of(key('b'));
  const TrustResult verdict = servers.admit("game.test", 9876, selfSigned('b'), {}, link);
  EXPECT_EQ(verdict.trust, Trust::kChanged);
  EXPECT_NE(verdict.message.find("HAS CHANGED"), std::string::npos);
  EXPECT_EQ(admit(selfSigned('a')), Trust::kPinned);
  EXPECT_EQ(servers.admit("game.test", 9876, selfSigned('b'), key('b'), link).trust,
            Trust::kFingerprintMatch);
  EXPECT_EQ(admit(selfSigned('b')), Trust::kPinned);
}

TEST_F(KnownServersTest, ValidChainUpdatesThePinButUnverifiedKeyCannot) {
  EXPECT_EQ(admit(verified('a')), Trust::kChain);
  EXPECT_EQ(admit(verified('b')), Trust::kChain);  // renewed with a new key
  EXPECT_EQ(admit(selfSigned('b')), Trust::kPinned);
  EXPECT_EQ(admit(selfSigned('c')), Trust::kChanged);
}

TEST_F(KnownServersTest, ServersAreDistinguishedByHostAndPort) {
  admit(selfSigned('a'));
  EXPECT_EQ(servers.admit("game.test", 9877, selfSigned('b'), {}).trust, Trust::kFirstUse);
  EXPECT_EQ(admit(selfSigned('c'), {}, "other.test"), Trust::kFirstUse);
  EXPECT_EQ(admit(selfSigned('d'), {}, "2001:db8::1"), Trust::kFirstUse);
  EXPECT_EQ(admit(selfSigned('d'), {}, "2001:DB8::1"), Trust::kPinned);
  EXPECT_EQ(admit(selfSigned('a'), {}, "GAME.Test."), Trust::kPinned);
  EXPECT_NE(content().find("[2001:db8::1]:9876 "), std::string::npos);
}

TEST_F(KnownServersTest, MalformedLinesAreKeptAndReported) {
  const std::string before = "# mine\n\ngame.test:9876 abc\n???\nother.test " + std::string(64, 'a') +
                             "\nOld.test:9876 \t" + std::string(64, 'e') + " \nx.test:9 " +
                             std::string(64, 'b') + " more";
  write(before);
  const auto problems = servers.problems();
  ASSERT_EQ(problems.size(), 4u);
  EXPECT_EQ(problems[0].substr(0, 7), "Line 3 ");
  EXPECT_EQ(problems[1].substr(0, 7), "Line 4 ");
  EXPECT_EQ(problems[2].substr(0, 7), "Line 5 ");
  EXPECT_EQ(problems[3].substr(0, 7), "Line 7 ");
  EXPECT_EQ(admit(selfSigned('e'), {}, "old.test"), Trust::kPinned);
  EXPECT_EQ(admit(selfSigned('c')), Trust::kFirstUse);
  EXPECT_EQ(content(), before + "\ngame.test:9876 " + std::string(64, 'c') + "\n");
}

TEST_F(KnownServersTest, KnownServersAreNotWrittenAgain) {
  admit(selfSigned('a'));
  fs::remove(path.string() + ".lock");
  EXPECT_EQ(admit(selfSigned('a')), Trust::kPinned);
  EXPECT_EQ(admit(selfSigned('b')), Trust::kChanged);
  EXPECT_FALSE(fs::exists(path.string() + ".lock"));
}

TEST_F(KnownServersTest, UnusableFileIsAnError) {
  fs::create_directories(path);  // a directory where the file should be
  EXPECT_THROW(admit(selfSigned('a')), KnownServersError);
  EXPECT_THROW(servers.problems(), KnownServersError);
}

TEST_F(KnownServersTest, ConcurrentThreadsLoseNoPins) {
  constexpr int kThreads = 8, kServers = 20;
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      const KnownServers own(path);
      for (int i = 0; i < kServers; ++i)
        own.admit("t" + std::to_string(t) + "-" + std::to_string(i), 1, selfSigned('a'), {});
    });
  }
  for (std::thread& thread : threads) thread.join();
  const std::string all = content();
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), kThreads * kServers);
}

TEST_F(KnownServersTest, ConcurrentProcessesAgreeOnOneKey) {
  constexpr int kProcesses = 8;
  std::vector<pid_t> children;
  for (int i = 0; i < kProcesses; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      const Trust trust =
          KnownServers(path).admit("game.test", 9876, selfSigned(static_cast<char>('0' + i)), {}).trust;
      _exit(trust == Trust::kFirstUse ? 1 : trust == Trust::kChanged ? 2 : 3);
    }
    children.push_back(child);
  }
  int first = 0, changed = 0;
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    first += WIFEXITED(status) && WEXITSTATUS(status) == 1;
    changed += WIFEXITED(status) && WEXITSTATUS(status) == 2;
  }
  EXPECT_EQ(first, 1);
  EXPECT_EQ(changed, kProcesses - 1);
}

TEST(KnownServersPath, FollowsTheEnvironment) {
  const char* before = std::getenv("XDG_DATA_HOME");
  const std::string kept = before ? before : "";
  setenv("XDG_DATA_HOME", "/somewhere", 1);
  EXPECT_EQ(KnownServers::defaultPath(), "/somewhere/naiad/known_servers");
  unsetenv("XDG_DATA_HOME");
  EXPECT_EQ(KnownServers::defaultPath(),
            std::string(std::getenv("HOME")) + "/.local/share/naiad/known_servers");
  if (before) setenv("XDG_DATA_HOME", kept.c_str(), 1);
}

}  // namespace
}  // namespace naiad
