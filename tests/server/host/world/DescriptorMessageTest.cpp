#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <span>
#include <utility>

#include "host/world/DescriptorMessage.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kWord = 0x1234abcd;

std::size_t openDescriptors() {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

ino_t fileOf(int descriptor) {
  struct stat facts {};
  return fstat(descriptor, &facts) == 0 ? facts.st_ino : 0;
}

class DescriptorMessageTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
    for (int& one : files) {
      one = memfd_create("test", 0);  // without close-on-exec
      ASSERT_GE(one, 0);
    }
    open_before = openDescriptors();
  }
  void TearDown() override {
    for (const int one : files) close(one);
    for (const int one : ends) close(one);
  }
  std::span<const int> first(std::size_t count) const { return std::span(files).first(count); }
  bool send(std::size_t count) { return sendDescriptors(ends[0], &kWord, sizeof kWord, first(count)); }

  int ends[2] = {-1, -1};
  std::array<int, kMaxPassed> files{};
  std::size_t open_before = 0;
};

TEST_F(DescriptorMessageTest, DescriptorsArriveInOrderWithTheBytes) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{5}, kMaxPassed}) {
    ASSERT_TRUE(send(count)) << count;
    std::array<int, kMaxPassed> room{};
    std::uint32_t word = 0;
    ASSERT_EQ(receiveDescriptors(ends[1], &word, sizeof word, room), static_cast<int>(count));
    EXPECT_EQ(word, kWord);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(fileOf(room[i]), fileOf(files[i])) << i;
      EXPECT_NE(room[i], files[i]);
      EXPECT_EQ(fcntl(room[i], F_GETFD), FD_CLOEXEC) << "no program gets it by chance";
      close(room[i]);
    }
  }
  EXPECT_EQ(openDescriptors(), open_before);
}

TEST_F(DescriptorMessageTest, ExcessDescriptorsAreClosed) {
  for (const std::size_t count : {std::size_t{2}, std::size_t{3}, kMaxPassed}) {
    ASSERT_TRUE(send(count));
    int one = -1;
    std::uint32_t word = 0;
    EXPECT_EQ(receiveDescriptors(ends[1], &word, sizeof word, {&one, 1}), -1) << count;
    EXPECT_EQ(openDescriptors(), open_before) << count;
  }
}

TEST_F(DescriptorMessageTest, DescriptorsOfAMessageOfWrongLengthAreClosed) {
  std::array<int, kMaxPassed> room{};
  for (const std::size_t size : {sizeof kWord - 1, sizeof kWord + 1}) {
    ASSERT_TRUE(send(2));
    std::array<char, sizeof kWord + 1> bytes{};
    EXPECT_EQ(receiveDescriptors(ends[1], bytes.data(), size, room), -1) << size;
    EXPECT_EQ(openDescriptors(), open_before) << size;
  }
}

TEST_F(DescriptorMessageTest, MessageWithoutDescriptorsIsReceived) {
  ASSERT_EQ(::send(ends[0], &kWord, sizeof kWord, 0), static_cast<ssize_t>(sizeof kWord));
  std::array<int, kMaxPassed> room{};
  std::uint32_t word = 0;
  EXPECT_EQ(receiveDescriptors(ends[1], &word, sizeof word, room), 0);
  EXPECT_EQ(word, kWord);
}

TEST_F(DescriptorMessageTest, EmptyOrClosedSocketFailsWithoutASignal) {
  std::array<int, kMaxPassed> room{};
  std::uint32_t word = 0;
  EXPECT_EQ(receiveDescriptors(ends[1], &word, sizeof word, room, MSG_DONTWAIT), -1);
  close(std::exchange(ends[0], -1));
  EXPECT_EQ(receiveDescriptors(ends[1], &word, sizeof word, room), -1);
  EXPECT_FALSE(sendDescriptors(ends[1], &kWord, sizeof kWord, first(1))) << "and no signal ends this process";
}

}  // namespace
}  // namespace naiad
