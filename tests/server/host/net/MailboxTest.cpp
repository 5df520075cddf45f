#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "host/net/Mailbox.h"

namespace naiad {
namespace {

TEST(MailboxTest, KeepsOrderAndBytes) {
  Mailbox<int> box;
  Batch<int> in;
  Batch<int> out;
  int header = 0;
  std::string_view bytes;
  EXPECT_FALSE(out.read(header, bytes));
  in.add(1, "one");
  in.add(2);
  box.push(in);
  EXPECT_TRUE(in.empty());
  in.add(3, std::string(1000, 'x'));
  EXPECT_GT(in.size(), 1000u);
  box.push(in);
  EXPECT_GT(box.size(), 1000u);
  box.popAll(out);
  EXPECT_EQ(box.size(), 0u);
  ASSERT_TRUE(out.read(header, bytes));
  EXPECT_EQ(header, 1);
  EXPECT_EQ(bytes, "one");
  ASSERT_TRUE(out.read(header, bytes));
  EXPECT_EQ(header, 2);
  EXPECT_EQ(bytes, "");
  ASSERT_TRUE(out.read(header, bytes));
  EXPECT_EQ(header, 3);
  EXPECT_EQ(bytes, std::string(1000, 'x'));
  EXPECT_FALSE(out.read(header, bytes));
  EXPECT_TRUE(out.empty());
}

TEST(MailboxTest, NothingIsLostBetweenTwoThreads) {
  constexpr int kCount = 200'000;
  Mailbox<int> box;
  std::thread writer([&] {
    Batch<int> batch;
    for (int i = 0; i < kCount; ++i) {
      batch.add(i, std::to_string(i));
      if (i % 7 == 0) box.push(batch);
    }
    box.push(batch);
  });
  Batch<int> batch;
  int next = 0;
  while (next < kCount) {
    int header = 0;
    std::string_view bytes;
    while (batch.read(header, bytes)) {
      ASSERT_EQ(header, next);
      ASSERT_EQ(bytes, std::to_string(next));
      ++next;
    }
    box.popAll(batch);
  }
  writer.join();
  EXPECT_EQ(box.size(), 0u);
}

}  // namespace
}  // namespace naiad
