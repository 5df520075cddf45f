#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "host/auth/LoginRateLimit.h"
#include "host/auth/PasswordCheck.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Answer = PasswordCheck::Answer;
using Time = std::chrono::steady_clock::time_point;

constexpr PasswordHash::Cost kCheap{.memory_kib = 64, .passes = 1};

AddressPrefix prefix(int number) {
  return AddressPrefix::of(asio::ip::address_v4(static_cast<unsigned>(number)));
}

struct PasswordCheckTest : testing::Test {
  void ask(const AddressPrefix& from, const std::string& password, std::function<void(Answer)> done) {
    check->check(from, false, password, now, [this, done = std::move(done)](Answer answer) {
      EXPECT_EQ(std::this_thread::get_id(), home);
      done(answer);
    });
  }
  void ask(int from, const std::string& password) {
    ask(prefix(from), password, [this](Answer answer) { answers.push_back(answer); });
  }
  /// Runs until all answers have arrived, because then the loop has no work left.
  std::vector<Answer> run() {
    context.restart();
    context.run();
    return std::exchange(answers, {});
  }

  asio::io_context context;
  std::unique_ptr<PasswordCheck> check = std::make_unique<PasswordCheck>(
      context.get_executor(), PasswordHash::of("open sesame", kCheap), PasswordCheck::Limits());
  Time now{};
  std::vector<Answer> answers;
  const std::thread::id home = std::this_thread::get_id();
};

TEST(PasswordHash, KnowsTheRightPasswordOnly) {
  const PasswordHash hash = PasswordHash::of("open sesame", kCheap);
  EXPECT_TRUE(hash.matches("open sesame"));
  for (const std::string& wrong : {std::string(), std::string("open sesam"), std::string("open sesame "),
                                   std::string("open\0sesame", 11), std::string(1000, 'x')}) {
    EXPECT_FALSE(hash.matches(wrong));
  }
}

TEST_F(PasswordCheckTest, ChangedPasswordAppliesToLaterChecks) {
  ask(1, "open sesame");
  EXPECT_EQ(run(), std::vector{Answer::kRight});
  check->setHash(PasswordHash::of("xyzzy", kCheap));
  ask(2, "open sesame");
  ask(3, "xyzzy");
  std::vector<Answer> both = run();
  std::ranges::sort(both);
  EXPECT_EQ(both, (std::vector{Answer::kRight, Answer::kWrong}));
}

TEST(PasswordHash, LongPasswordsAreNotTruncated) {
  const std::string longest(kMaxPassword, 'x');
  const PasswordHash hash = PasswordHash::of(longest, kCheap);
  EXPECT_TRUE(hash.matches(longest));
  EXPECT_FALSE(hash.matches(longest + "y"));
  EXPECT_THROW(PasswordHash::of(longest + "y", kCheap), PasswordError);
  EXPECT_THROW(PasswordHash::of("", kCheap), PasswordError);
}

TEST(PasswordHash, EachHasItsOwnSalt) {
  EXPECT_NE(PasswordHash::of("open sesame", kCheap).text(), PasswordHash::of("open sesame", kCheap).text());
}

TEST(PasswordHash, TextIsAPasswordOrAHash) {
  const PasswordHash plain = PasswordHash::fromText("open sesame\r\n");
  EXPECT_EQ(plain.text().substr(0, 31), "$argon2id$v=19$m=65536,t=3,p=1$");
  EXPECT_TRUE(plain.matches("open sesame"));
  const PasswordHash hash = PasswordHash::fromText(PasswordHash::of("open sesame", kCheap).text() + "\n");
  EXPECT_TRUE(hash.matches("open sesame"));
  EXPECT_THROW(PasswordHash::fromText("$argon2id$v=19$m=65536,t=3,p=1$nonsense"), PasswordError);
  EXPECT_THROW(PasswordHash::fromText("\n"), PasswordError);
}

TEST_F(PasswordCheckTest, AnswersRightAndWrongAsynchronously) {
  ask(1, "open sesame");
  ask(2, "open barley");
  EXPECT_TRUE(answers.empty());
  EXPECT_EQ(run(), (std::vector{Answer::kRight, Answer::kWrong}));
  EXPECT_EQ(check->counters().right, 1u);
  EXPECT_EQ(check->counters().wrong, 1u);
}

TEST_F(PasswordCheckTest, FiveWrongTriesBlockTheAddressForAMinute) {
  for (int i = 0; i < 5; ++i) {
    ask(1, "guess");
    EXPECT_EQ(run(), std::vector{Answer::kWrong});
  }
  ask(1, "open sesame");  // the right password, but after the limit
  ask(2, "open sesame");
  EXPECT_EQ(run(), (std::vector{Answer::kTooMany, Answer::kRight}));
  now += 60s;
  ask(1, "open sesame");
  EXPECT_EQ(run(), std::vector{Answer::kRight});
  EXPECT_EQ(check->counters().too_many, 1u);
}

TEST_F(PasswordCheckTest, SuccessfulTriesAreNotCounted) {
  for (int i = 0; i < 64; ++i) {  // a class behind one address
    ask(1, "open sesame");
    EXPECT_EQ(run(), std::vector{Answer::kRight});
  }
  EXPECT_EQ(check->remembered(), 0u);
}

TEST_F(PasswordCheckTest, ConcurrentTriesDoNotBypassTheLimit) {
  for (int i = 0; i < 7; ++i) ask(1, "guess");
  const auto all = run();
  EXPECT_EQ(std::ranges::count(all, Answer::kWrong), 5);
  EXPECT_EQ(std::ranges::count(all, Answer::kBusy), 2);
}

TEST_F(PasswordCheckTest, FloodBeyondTheQueueIsAnsweredBusy) {
  for (int i = 0; i < 100; ++i) ask(i, "open sesame");  // no answer yet, because the loop does not run
  const auto all = run();
  ASSERT_EQ(all.size(), 100u);
  EXPECT_EQ(std::ranges::count(all, Answer::kRight), 8);
  EXPECT_EQ(std::ranges::count(all, Answer::kBusy), 92);
  EXPECT_EQ(check->counters().busy, 92u);
}

// Retries would never succeed with a low ulimit -v.
TEST_F(PasswordCheckTest, TooLittleMemoryIsNotAnsweredBusy) {
  if (test::kSanitized) GTEST_SKIP() << "a sanitizer reserves its address space";
  check->setHash(PasswordHash::of("open sesame"));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  rlimit low = before;
  std::ifstream("/proc/self/statm") >> low.rlim_cur;  // in pages
  low.rlim_cur = low.rlim_cur * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{16} << 20);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &low), 0);
  ask(1, "open sesame");
  const auto all = run();
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_EQ(all, std::vector{Answer::kNoMemory});
  ask(1, "open sesame");
  EXPECT_EQ(run(), std::vector{Answer::kRight});
}

TEST_F(PasswordCheckTest, ImpossiblePasswordsAreNotComparedAndUseNoTries) {
  for (int i = 0; i < 100; ++i) ask(1, i % 2 == 0 ? std::string() : std::string(kMaxPassword + 1, 'x'));
  EXPECT_TRUE(answers.empty());
  EXPECT_EQ(run(), std::vector(100, Answer::kWrong));
  EXPECT_EQ(check->counters().malformed, 100u);
  EXPECT_EQ(check->counters().wrong, 0u);
  EXPECT_EQ(check->remembered(), 0u);
  ask(1, "open sesame");
  EXPECT_EQ(run(), std::vector{Answer::kRight}) << "it has all of its tries";
}

/// Attackers, each in its own network, who retry as soon as they have an answer.
TEST_F(PasswordCheckTest, EightyGuessingAddressesDoNotBlockNewPlayers) {
  const auto network = [](int i) {
    return AddressPrefix::of(asio::ip::address_v4(0x0A000001u + static_cast<unsigned>(i) * 256));
  };
  bool over = false;
  std::uint64_t guesses = 0;
  std::function<void(int)> attack = [&](int i) {
    ask(network(i), "guess", [&, i](Answer) {
      ++guesses;
      if (!over) attack(i);
    });
  };
  for (int i = 0; i < 80; ++i) attack(i);
  context.restart();
  while (check->counters().wrong < 100) context.run_one();
  EXPECT_GT(check->counters().busy, 100u) << "the places are taken";
  for (int newcomer = 0; newcomer < 20; ++newcomer) {
    const std::uint64_t before = check->counters().wrong;
    std::optional<Answer> answer;
    ask(network(1000 + newcomer), "open sesame", [&](Answer a) { answer = a; });
    while (!answer) context.run_one();
    EXPECT_EQ(*answer, Answer::kRight);
    EXPECT_LE(check->counters().wrong - before, 1u) << "it waits for the guess that is being made";
  }
  // A player who joins together with the attackers is one of 81, and retries when refused.
  now += 60s;
  ask(network(2000), "open sesame", [&](Answer a) { EXPECT_EQ(a, Answer::kRight); });
  over = true;
  context.run();
  EXPECT_GT(guesses, 300u);
}

TEST_F(PasswordCheckTest, PrefixesWithPlayersAreCheckedFirst) {
  std::vector<int> order;
  for (int i = 0; i < 9; ++i) {
    check->check(AddressPrefix::of(asio::ip::address_v4(0x0A000001u + static_cast<unsigned>(i) * 256)),
                 i == 8, "open sesame", now, [&, i](Answer answer) {
                   if (answer == Answer::kRight) order.push_back(i);
                 });
  }
  context.run();
  EXPECT_EQ(order, (std::vector{0, 8, 1, 2, 3, 4, 5, 6})) << "after the one that was begun; one was too many";
}

TEST_F(PasswordCheckTest, DestructionInACallbackStopsLaterCallbacks) {
  int calls = 0;
  for (int i = 0; i < 3; ++i) {
    check->check(prefix(i), false, "open sesame", now, [&, marker = std::string(100, 'm')](Answer) {
      check.reset();
      calls += marker.size() == 100;
    });
  }
  context.run();
  EXPECT_EQ(calls, 1);
}

TEST_F(PasswordCheckTest, CallbacksDieOnTheOwnersThread) {
  struct Canary {
    std::thread::id home;
    ~Canary() { EXPECT_EQ(std::this_thread::get_id(), home); }
  };
  for (int i = 0; i < 8; ++i) {
    check->check(prefix(i), false, "open sesame", now,
                 [canary = std::make_shared<Canary>(Canary{home})](Answer) {});
  }
  context.run_one();
  check.reset();
  context.run();
}

TEST(LoginRateLimit, AbandonedTriesAreNotCountedAsWrong) {
  LoginRateLimit limit(2, 60s, 100);
  for (int i = 1; i <= 1000; ++i) {
    EXPECT_EQ(limit.beginTry(prefix(1), Time{}), LoginRateLimit::Answer::kAllowed);
    limit.finishTry(prefix(1), true, Time{});
  }
  EXPECT_EQ(limit.wrong(prefix(1), Time{}), 0);
  EXPECT_EQ(limit.size(), 0u) << "and evict none that were";
}

TEST(LoginRateLimit, RemembersWrongTriesOf16384NetworksForAnHour) {
  const PasswordCheck::Limits limits;
  LoginRateLimit limit(limits.wrong_per_window, limits.window, limits.prefixes);
  const Time now{};
  const auto fail = [&](const AddressPrefix& from) {
    limit.beginTry(from, now);
    limit.finishTry(from, false, now);
  };
  fail(prefix(1));
  fail(prefix(2));
  for (int i = 1; i < 16'384; ++i) fail(prefix(256 * i));
  EXPECT_EQ(limit.wrong(prefix(3), now + 60min - 1ms), 2) << "of the network";
  EXPECT_EQ(limit.wrong(prefix(3), now + 60min), 0);
  fail(prefix(256 * 16'384));
  EXPECT_EQ(limit.wrong(prefix(3), now), 0) << "the table is full";
  EXPECT_EQ(limit.wrong(prefix(256), now), 1);
}

TEST(LoginRateLimit, WindowBeginsWithTheFirstTry) {
  LoginRateLimit limit(2, 60s, 100);
  Time now{};
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(limit.beginTry(prefix(1), now), LoginRateLimit::Answer::kAllowed);
    limit.finishTry(prefix(1), false, now);
    now += 30s;
  }
  EXPECT_EQ(limit.beginTry(prefix(1), now - 1ms), LoginRateLimit::Answer::kTooMany);
  EXPECT_EQ(limit.beginTry(prefix(1), now), LoginRateLimit::Answer::kAllowed);
}

}  // namespace
}  // namespace naiad
