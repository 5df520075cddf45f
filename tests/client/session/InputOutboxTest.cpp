#include <gtest/gtest.h>

#include "client/session/InputOutbox.h"

namespace naiad {
namespace {

std::vector<std::uint32_t> ids(const std::vector<Input>& inputs) {
  std::vector<std::uint32_t> found;
  for (const Input& input : inputs) found.push_back(input.id);
  return found;
}

TEST(InputOutbox, KeepsInputsUntilTheyAreAcknowledged) {
  InputOutbox outbox;
  EXPECT_TRUE(outbox.isEmpty());
  for (int i = 0; i < 4; ++i) outbox.add({});
  EXPECT_EQ(ids(outbox.all()), (std::vector<std::uint32_t>{1, 2, 3, 4}));
  EXPECT_EQ(outbox.removeUpTo(2)->id, 2u);
  EXPECT_FALSE(outbox.removeUpTo(2));
  EXPECT_FALSE(outbox.removeUpTo(1));
  EXPECT_EQ(ids(outbox.all()), (std::vector<std::uint32_t>{3, 4}));
}

TEST(InputOutbox, SendsEachInputOncePerStream) {
  InputOutbox outbox;
  outbox.add({});
  outbox.add({});
  EXPECT_EQ(ids(outbox.popForStream()), (std::vector<std::uint32_t>{1, 2}));
  outbox.add({});
  outbox.removeUpTo(1);
  EXPECT_EQ(ids(outbox.popForStream()), std::vector<std::uint32_t>{3});
  EXPECT_TRUE(outbox.popForStream().empty());
  outbox.restartStream();
  EXPECT_EQ(ids(outbox.popForStream()), (std::vector<std::uint32_t>{2, 3}));
}

TEST(InputOutbox, KeepsRoomForKeyReleases) {
  InputOutbox outbox;
  while (!outbox.isFull(false)) outbox.add({});
  EXPECT_EQ(outbox.all().size(), InputOutbox::kMax);
  EXPECT_FALSE(outbox.isFull(true));
  while (!outbox.isFull(true)) outbox.add({});
  EXPECT_EQ(outbox.all().size(), kMaxUpdateInputs);
}

}  // namespace
}  // namespace naiad
