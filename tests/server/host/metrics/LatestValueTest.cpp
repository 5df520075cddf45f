#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "host/ops/HostMetrics.h"

namespace naiad {
namespace {

TEST(LatestValue, IsTheNewestAndStaysUntilThereIsAnother) {
  LatestValue<int> value;
  EXPECT_EQ(value.readLatest(), nullptr);
  value.publish(std::make_unique<const int>(1));
  value.publish(std::make_unique<const int>(2));
  ASSERT_NE(value.readLatest(), nullptr);
  EXPECT_EQ(*value.readLatest(), 2);
  EXPECT_EQ(*value.readLatest(), 2);
  value.publish(std::make_unique<const int>(3));  // never taken: freed with `value`
}

struct Pair {
  int number = 0;
  int negative = 0;
};

TEST(LatestValue, ConcurrentReaderSeesWholeValuesInOrder) {
  constexpr int kLast = 20'000;
  LatestValue<Pair> value;
  std::thread writer([&value] {
    for (int i = 1; i <= kLast; ++i) value.publish(std::make_unique<const Pair>(Pair{i, -i}));
  });
  for (int newest = 0; newest < kLast;) {
    const Pair* p_pair = value.readLatest();
    if (p_pair == nullptr) continue;
    ASSERT_EQ(p_pair->number, -p_pair->negative);
    ASSERT_GE(p_pair->number, newest);
    newest = p_pair->number;
  }
  writer.join();
}

}  // namespace
}  // namespace naiad
