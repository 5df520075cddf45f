#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/auth/LoginRateLimit.h"
#include "host/auth/PasswordCheck.h"
#include "host/auth/PasswordQueue.h"
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

/// Returns a prefix in a network of its own.
AddressPrefix network(int number) {
  return AddressPrefix::of(asio::ip::address_v4(0x0A000001u + static_cast<unsigned>(number) * 256));
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
    check->check(network(i), i == 8, "open sesame", now, [&, i](Answer answer) {
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

AddressPrefix of(const std::string& text) {
  return AddressPrefix::of(asio::ip::make_address(text));
}

class PasswordQueueTest : public testing::Test {
 protected:
  /// Adds an entry. Returns the id of the entry that was dropped; 0: none.
  PasswordQueue::Id add(const std::string& from, bool known = false, int wrong = 0) {
    return queue.add({++newest, of(from), known, wrong}, now).value_or(0);
  }
  std::vector<PasswordQueue::Id> takeAll() {
    std::vector<PasswordQueue::Id> all;
    while (const auto next = queue.popNext()) all.push_back(*next);
    return all;
  }
  using Ids = std::vector<PasswordQueue::Id>;

  PasswordQueue queue{4, 100};
  PasswordQueue::Id newest = 0;
  PasswordQueue::Time now{};
};

TEST_F(PasswordQueueTest, EqualEntriesAreServedInArrivalOrder) {
  for (int i = 1; i <= 4; ++i) EXPECT_EQ(add("198.51." + std::to_string(i) + ".1"), 0u);
  EXPECT_EQ(add("198.51.5.1"), 5u) << "there is no place";
  EXPECT_EQ(takeAll(), (Ids{1, 2, 3, 4}));
  EXPECT_FALSE(queue.popNext());
  EXPECT_EQ(queue.size(), 0u);
}

TEST_F(PasswordQueueTest, MostCrowdedAddressLosesItsNewestEntry) {
  add("198.51.1.1");
  add("198.51.2.1");
  add("198.51.2.1");
  add("198.51.3.1");
  EXPECT_EQ(add("198.51.4.1"), 3u);
  EXPECT_EQ(add("198.51.1.1"), 6u) << "its second";
  EXPECT_EQ(takeAll(), (Ids{1, 2, 4, 5}));
}

TEST_F(PasswordQueueTest, AddressesOfOneNetworkCountTogether) {
  for (int i = 1; i <= 4; ++i) add("198.51.100." + std::to_string(i));
  EXPECT_EQ(add("192.0.2.1"), 4u);
  EXPECT_EQ(queue.popNext(), 5u) << "it shares with no other one";
}

TEST_F(PasswordQueueTest, NetworksOfOneCustomerCountTogether) {
  for (const char* from : {"2001:db8:1:101::1", "2001:db8:1:102::1", "2001:db8:1:200::1", "2001:db8:2::1"}) {
    add(from);
  }
  EXPECT_EQ(add("2001:db8:3::1"), 2u) << "the newest of the /56, in the /48";
  EXPECT_EQ(add("2001:db8:4::1"), 3u) << "the newest of the /48";
  EXPECT_EQ(takeAll(), (Ids{1, 4, 5, 6}));
}

TEST_F(PasswordQueueTest, PrefixesWithPlayersAreServedFirst) {
  for (int i = 1; i <= 3; ++i) add("198.51." + std::to_string(i) + ".1");
  add("192.0.2.1", true, 3);
  EXPECT_EQ(add("192.0.2.1", true), 3u) << "however crowded they are";
  EXPECT_EQ(takeAll(), (Ids{5, 4, 1, 2}));
}

TEST_F(PasswordQueueTest, LongestWaitWithoutAPauseIsServedFirst) {
  for (const auto pause : {2'000ms, 10'000ms, 10'001ms}) {
    now += 1h;
    for (int i = 1; i <= 4; ++i) add("198.51." + std::to_string(i) + ".1");
    add("192.0.2.1");  // is dropped
    now += pause;
    queue.popNext();
    queue.popNext();
    add("198.51.5.1");
    const PasswordQueue::Id latest = newest;
    add("198.51.6.1");
    EXPECT_EQ(add("192.0.2.99"), latest + (pause <= 10s ? 1 : 2)) << pause.count() << " ms";
    takeAll();
  }
}

TEST_F(PasswordQueueTest, NetworkWaitsAgainAfterItsTurn) {
  for (const char* from : {"192.0.2.1", "192.0.2.2", "198.51.1.1"}) add(from);
  now += 5s;
  EXPECT_EQ(takeAll(), (Ids{3, 1, 2})) << "the crowded network is last";
  add("198.51.2.1");
  add("192.0.2.1");
  EXPECT_EQ(takeAll(), (Ids{4, 5})) << "in order of arrival";
  for (const char* from : {"192.0.2.1", "192.0.2.2"}) add(from);
  now += 1s;
  EXPECT_EQ(queue.popNext(), 6u);
  add("198.51.3.1");
  EXPECT_EQ(takeAll(), (Ids{8, 7})) << "a guess waits for the next turn of its network";
}

TEST_F(PasswordQueueTest, PauseBeginsWhenAGuessIsDropped) {
  for (int i = 1; i <= 4; ++i) add("198.51." + std::to_string(i) + ".1", i > 1);
  now += 9s;
  EXPECT_EQ(add("192.0.2.1", true), 1u) << "it has waited in the queue";
  takeAll();
  now += 9s;
  add("192.0.2.9");
  add("198.51.1.1");
  EXPECT_EQ(takeAll(), (Ids{7, 6}));
}

TEST_F(PasswordQueueTest, WrongGuessesCostWaitingTime) {
  add("198.51.1.1", false, 2);
  add("198.51.2.1", false, 1);
  now += 10s;
  add("198.51.3.1");
  add("198.51.4.1", false, 1'000'000);
  EXPECT_EQ(add("192.0.2.1"), 4u);
  EXPECT_EQ(takeAll(), (Ids{2, 3, 5, 1}));
}

TEST_F(PasswordQueueTest, NetworkThatGuessedLongestAgoIsForgotten) {
  add("192.0.2.1");
  for (int i = 0; i < 120; ++i) add("10.0." + std::to_string(i) + ".1", true);
  now += 1s;
  takeAll();
  add("10.1.0.1");
  add("192.0.2.1");
  EXPECT_EQ(takeAll(), (Ids{122, 123})) << "both begin to wait";
}

// Attackers that occupy the queue, and honest players that retry like clients, with a simulated clock.

constexpr std::chrono::milliseconds kCompareTime{100};  ///< time to compare a guess
constexpr std::chrono::milliseconds kConnectTime{300};
constexpr std::chrono::milliseconds kFirstBackoff{250};  ///< Connection::kFirstBackoff
constexpr std::chrono::milliseconds kMaxBackoff{2000};
constexpr std::chrono::seconds kTypingTime{12};  ///< longer than PasswordQueue::kMaxPause
constexpr int kPlayers = 40;

struct Attack {
  std::string name;
  int clients;
  Time::duration interval;       ///< interval of the guesses of one client
  std::chrono::minutes warm_up;  ///< time until the players come
  bool is_one_network = false;   ///< all clients in one IPv6 /48, each with its own /64
};

class Siege {
 public:
  explicit Siege(const Attack& attack) : m_attack(attack) {
    for (int i = 0; i < attack.clients; ++i) schedule(i, i * attack.interval / attack.clients);
    for (int i = 0; i < kPlayers; ++i) schedule(attack.clients + i, attack.warm_up + i * 50ms);
  }
  /// Runs until 3 minutes after the players came.
  void run() {
    while (m_now < Time{} + m_attack.warm_up + 3min) {
      const auto [at, client] = *m_events.begin();
      m_events.erase(m_events.begin());
      m_now = at;
      client == kWorker ? finishComparison() : guess(client);
    }
  }
  /// Number of players that entered within a minute after their first right guess.
  int entered() const {
    return static_cast<int>(
        std::ranges::count_if(m_players, [](const Player& one) { return one.wait <= 60s; }));
  }

 private:
  static constexpr int kWorker = -1;

  struct Player {
    std::chrono::milliseconds backoff = kFirstBackoff;
    bool mistypes = false;     ///< the next guess is wrong
    Time since = Time::max();  ///< the first right guess
    Time::duration wait = Time::duration::max();
  };
  struct Guess {
    int client;
    Time at;
  };

  void schedule(int client, Time::duration delay) { m_events.emplace(m_now + delay, client); }
  bool isPlayer(int client) const { return client >= m_attack.clients; }
  AddressPrefix prefixOf(int client) const {
    if (isPlayer(client) || !m_attack.is_one_network) return network(client);
    return AddressPrefix(AddressPrefix::Bytes{0x20, 0x01, 0x0d, 0xb8, 0, 0,
                                              static_cast<std::uint8_t>(client >> 8),
                                              static_cast<std::uint8_t>(client)});
  }

  void guess(int client) {
    const AddressPrefix from = prefixOf(client);
    if (!isPlayer(client)) schedule(client, m_attack.interval);
    if (isPlayer(client) && !player(client).mistypes)
      player(client).since = std::min(player(client).since, m_now);
    if (m_limit.beginTry(from, m_now) != LoginRateLimit::Answer::kAllowed) return refuse(client);
    m_guesses[++m_newest] = {client, m_now};
    const auto dropped = m_queue.add({m_newest, from, false, m_limit.wrong(from, m_now)}, m_now);
    if (!m_comparing) compareNext();
    if (!dropped) return;
    const Guess lost = m_guesses.extract(*dropped).mapped();
    m_limit.finishTry(prefixOf(lost.client), true, lost.at);
    refuse(lost.client);
  }
  void compareNext() {
    m_comparing = m_queue.popNext();
    if (m_comparing) schedule(kWorker, kCompareTime);
  }
  void finishComparison() {
    const Guess done = m_guesses.extract(*m_comparing).mapped();
    const bool right = isPlayer(done.client) && !player(done.client).mistypes;
    m_limit.finishTry(prefixOf(done.client), right, done.at);
    compareNext();
    if (!isPlayer(done.client)) return;
    EXPECT_LT(m_now - done.at, 4s) << "the server refuses hellos that wait for longer";
    Player& one = player(done.client);
    if (right) {
      one.wait = m_now - one.since;
    } else {
      one.mistypes = false;
      one.backoff = kFirstBackoff;
      schedule(done.client, kTypingTime);
    }
  }
  void refuse(int client) {
    if (!isPlayer(client)) return;
    Player& one = player(client);
    schedule(client, one.backoff + kConnectTime);
    one.backoff = std::min(2 * one.backoff, kMaxBackoff);
  }
  Player& player(int client) { return m_players[static_cast<std::size_t>(client - m_attack.clients)]; }
  static std::vector<Player> players() {
    std::vector<Player> all(kPlayers);
    for (std::size_t i = 0; i < all.size(); ++i) all[i].mistypes = i % 4 == 0;
    return all;
  }

  const Attack m_attack;
  const PasswordCheck::Limits m_limits;
  LoginRateLimit m_limit{m_limits.wrong_per_window, m_limits.window, m_limits.prefixes};
  PasswordQueue m_queue{m_limits.queue - 1, m_limits.prefixes};
  Time m_now{};
  std::multimap<Time, int> m_events;  ///< guesses of clients, and the end of a comparison
  std::map<PasswordQueue::Id, Guess> m_guesses;
  PasswordQueue::Id m_newest = 0;
  std::optional<PasswordQueue::Id> m_comparing;
  std::vector<Player> m_players = players();
};

TEST(PasswordSiege, RetryingPlayersEnterWithinAMinute) {
  for (const Attack& attack : {Attack{"networks that knock once a minute", 2000, 60s, 4min},
                               Attack{"networks that knock every 11 s", 2000, 11s, 4min},
                               Attack{"networks that knock every 2 minutes", 20'000, 120s, 4min},
                               Attack{"networks that never pause", 2000, 9s, 20min},
                               Attack{"one network of 4,000 clients", 4000, 9s, 4min, true}}) {
    Siege siege(attack);
    siege.run();
    EXPECT_EQ(siege.entered(), kPlayers) << attack.name;
  }
}

}  // namespace
}  // namespace naiad
