#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "host/auth/PasswordQueue.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

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

}  // namespace
}  // namespace naiad
