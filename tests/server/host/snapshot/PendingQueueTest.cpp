#include <gtest/gtest.h>

#include <vector>

#include "DirectSender.h"
#include "host/snapshot/SnapshotBuilder.h"

namespace naiad {
namespace {

/// A row of pending objects through the middle of a view of 80 by 24 cells.
class PendingQueueTest : public testing::Test {
 protected:
  PendingQueueTest() {
    view.boundary = {test::cellsAt(0, 0), test::cellsAt(80, 24)};
    view.players.emplace_back();
    for (std::uint32_t slot = 0; slot < 8; ++slot) {
      df::ObjectFacts facts;
      facts.key = {slot, 1};
      facts.position = test::cellsAt(10 * slot, 12);
      view.changed.push_back(facts);
    }
    view.tick = 1;
    publisher.update(view);
    replica.state.applyTick(publisher, view.players[0]);
    for (std::uint32_t slot = 0; slot < 8; ++slot) replica.objects.addObject(slot, 1, 1);
  }
  std::vector<std::uint32_t> order(std::size_t limit) {
    std::vector<std::uint32_t> ids;
    for (queue.fill(replica, publisher, limit); !queue.empty(); queue.pop()) ids.push_back(queue.front());
    return ids;
  }

  df::WorldView view;
  Publisher publisher;
  ClientReplica replica;
  PendingQueue queue;
};

TEST_F(PendingQueueTest, ObjectsThatAllFitAreOrderedById) {
  EXPECT_EQ(order(kMaxSnapshot), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(PendingQueueTest, LimitedQueueIsSortedByDistanceFromTheMiddle) {
  EXPECT_EQ(order(100), (std::vector<std::uint32_t>{4, 3, 5, 2, 6, 1, 7, 0}));
}

TEST_F(PendingQueueTest, DeathsAndTheFollowedObjectComeFirst) {
  view.players[0].followed = {7, 1};
  replica.state.applyTick(publisher, view.players[0]);
  replica.objects.markSent(0, 1, publisher.find(0)->state, publisher.find(0)->state.motion, 1);
  replica.objects.trimPending();
  replica.objects.removeObject(0, 1);
  const std::vector<std::uint32_t> ids = order(100);
  EXPECT_EQ(std::vector<std::uint32_t>(ids.begin(), ids.begin() + 3), (std::vector<std::uint32_t>{0, 7, 4}));
}

TEST_F(PendingQueueTest, DeferredObjectsComeBackFirst) {
  queue.fill(replica, publisher, kMaxSnapshot);
  queue.defer();
  queue.defer();
  EXPECT_EQ(queue.front(), 2u);
  queue.restoreDeferred();
  EXPECT_EQ(queue.front(), 0u);
  queue.pop();
  EXPECT_EQ(queue.front(), 1u);
}

}  // namespace
}  // namespace naiad
