#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/auth/PasswordQueue.h"

namespace naiad {
namespace {

AddressPrefix of(const std::string& text) {
  return AddressPrefix::of(asio::ip::make_address(text));
}

class PasswordQueueTest : public testing::Test {
 protected:
  /// Adds an entry. Returns the id of the entry that was dropped; 0: none.
  PasswordQueue::Id add(const std::string& from, bool known = false, int wrong = 0, int busy = 0) {
    return queue.add({++newest, of(from), known, wrong, busy}).value_or(0);
  }
  std::vector<PasswordQueue::Id> takeAll() {
    std::vector<PasswordQueue::Id> all;
    while (const auto next = queue.popNext()) all.push_back(*next);
    return all;
  }
  using Ids = std::vector<PasswordQueue::Id>;

  PasswordQueue queue{4};
  PasswordQueue::Id newest = 0;
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
  add("192.0.2.1", true, 3, 3);
  EXPECT_EQ(add("192.0.2.1", true), 3u) << "however crowded they are";
  EXPECT_EQ(takeAll(), (Ids{5, 4, 1, 2}));
}

TEST_F(PasswordQueueTest, PrefixesWithWrongOrRefusedTriesAreServedLast) {
  add("198.51.1.1", false, 2);
  add("198.51.2.1", false, 0, 5);
  add("198.51.3.1", false, 1);
  add("198.51.4.1", false, 0, 2);
  EXPECT_EQ(add("192.0.2.1"), 1u);
  EXPECT_EQ(add("192.0.2.2", false, 4), 6u) << "a network of two";
  EXPECT_EQ(takeAll(), (Ids{5, 4, 2, 3}));
}

}  // namespace
}  // namespace naiad
