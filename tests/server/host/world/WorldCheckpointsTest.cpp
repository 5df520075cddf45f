// WorldCheckpoints with sockets in place of a world and its copies.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "host/world/DescriptorMessage.h"
#include "host/world/WorldCheckpoints.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

class WorldCheckpointsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kThreadSanitized) GTEST_SKIP() << "its runtime gives what is forked a thread";
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends), 0);
    world = ends[1];
    copies.emplace(ends[0]);
    process = fork();
    if (process == 0) pause();  // waits to be killed
  }
  void TearDown() override {
    if (process > 0) {
      kill(process, SIGKILL);
      waitpid(process, nullptr, 0);
    }
    for (const int socket : sockets) close(socket);
    if (world >= 0) close(world);
  }
  /// Receives the socket that is sent to the world; -1 if none was sent.
  int receiveRequest() {
    char byte = 0;
    int number = -1;
    if (receiveDescriptors(world, &byte, 1, {&number, 1}, MSG_DONTWAIT) != 1) return -1;
    sockets.push_back(number);
    return number;
  }
  /// Orders a copy, which reports itself as process `number` (0: no report). Returns its socket.
  int make(std::int32_t number, std::uint32_t tick) {
    EXPECT_TRUE(copies->request(process));
    const int socket = receiveRequest();
    copies->add({tick, ViewReader(), {}});
    if (number != 0) {
      EXPECT_EQ(send(socket, &number, sizeof number, 0), static_cast<ssize_t>(sizeof number));
    }
    copies->update();
    return socket;
  }
  static bool isClosed(int socket) {
    char byte = 0;
    return recv(socket, &byte, 1, MSG_DONTWAIT) == 0;
  }

  int world = -1;
  pid_t process = -1;  ///< stands for the world; has one thread
  std::vector<int> sockets;
  std::optional<WorldCheckpoints> copies;
};

TEST_F(WorldCheckpointsTest, NewestTwoReportedCheckpointsAreKept) {
  const int first = make(11, 10);
  const int second = make(12, 20);
  const int third = make(0, 30);
  EXPECT_FALSE(isClosed(first)) << "the third may never come";
  const std::int32_t number = 13;
  ASSERT_EQ(send(third, &number, sizeof number, 0), static_cast<ssize_t>(sizeof number));
  copies->update();
  EXPECT_TRUE(isClosed(first));
  EXPECT_EQ(copies->processes(), (std::vector<pid_t>{12, 13}));
  const auto newest = copies->popNewest();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->process, 13);
  EXPECT_EQ(newest->state.next_tick, 30u);
  close(newest->socket);
  EXPECT_FALSE(isClosed(second));
}

TEST_F(WorldCheckpointsTest, EndedOrUnreportedCheckpointIsNotUsed) {
  make(11, 10);
  const int second = make(12, 20);
  make(0, 30);
  shutdown(second, SHUT_RDWR);
  const auto newest = copies->popNewest();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->process, 11);
  close(newest->socket);
  EXPECT_FALSE(copies->popNewest());
}

TEST_F(WorldCheckpointsTest, CheckpointThatSpeaksTooEarlyIsNotUsed) {
  const int copy = make(11, 10);
  ASSERT_EQ(send(copy, "x", 1, 0), 1);
  EXPECT_FALSE(copies->popNewest());
}

TEST_F(WorldCheckpointsTest, RepeatedFailuresTurnCheckpointsOff) {
  for (int i = 0; i < WorldCheckpoints::kMaxFailures; ++i) make(0, 10);
  EXPECT_FALSE(copies->request(process));
  EXPECT_FALSE(copies->isOn());
  EXPECT_EQ(copies->popProblem(), "creating them fails");
  EXPECT_FALSE(copies->popProblem());
  for (const int socket : sockets) EXPECT_TRUE(isClosed(socket));
}

TEST_F(WorldCheckpointsTest, UnansweredTurnGivesNoCheckpoint) {
  ASSERT_TRUE(copies->request(process));
  const int socket = receiveRequest();
  EXPECT_FALSE(copies->popNewest());
  EXPECT_TRUE(isClosed(socket));
}

TEST_F(WorldCheckpointsTest, CheckpointsEndWithTheirOwner) {
  const int first = make(11, 10);
  const int second = make(12, 20);
  copies.reset();
  EXPECT_TRUE(isClosed(first));
  EXPECT_TRUE(isClosed(second));
}

TEST(WorldCheckpoints, CheckpointsAreOffWithoutAnOrderSocket) {
  WorldCheckpoints none(-1);
  EXPECT_FALSE(none.isOn());
  EXPECT_FALSE(none.request(getpid()));
  EXPECT_FALSE(none.popProblem());
}

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
  /// Receives kWord with at most as many descriptors as there is room for. Returns their number; −1 on
  /// failure.
  int receive(std::span<int> places, int flags = 0) {
    word = 0;
    return receiveDescriptors(ends[1], &word, sizeof word, places, flags);
  }

  int ends[2] = {-1, -1};
  std::uint32_t word = 0;
  std::array<int, kMaxPassed> room{};
  std::array<int, kMaxPassed> files{};
  std::size_t open_before = 0;
};

TEST_F(DescriptorMessageTest, DescriptorsArriveInOrderWithTheBytes) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{5}, kMaxPassed}) {
    ASSERT_TRUE(send(count)) << count;
    ASSERT_EQ(receive(room), static_cast<int>(count));
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
    EXPECT_EQ(receive(std::span(room).first(1)), -1) << count;
    EXPECT_EQ(openDescriptors(), open_before) << count;
  }
}

TEST_F(DescriptorMessageTest, DescriptorsOfAMessageOfWrongLengthAreClosed) {
  for (const std::size_t size : {sizeof kWord - 1, sizeof kWord + 1}) {
    ASSERT_TRUE(send(2));
    std::array<char, sizeof kWord + 1> bytes{};
    EXPECT_EQ(receiveDescriptors(ends[1], bytes.data(), size, room), -1) << size;
    EXPECT_EQ(openDescriptors(), open_before) << size;
  }
}

TEST_F(DescriptorMessageTest, MessageWithoutDescriptorsIsReceived) {
  ASSERT_EQ(::send(ends[0], &kWord, sizeof kWord, 0), static_cast<ssize_t>(sizeof kWord));
  EXPECT_EQ(receive(room), 0);
  EXPECT_EQ(word, kWord);
}

TEST_F(DescriptorMessageTest, EmptyOrClosedSocketFailsWithoutASignal) {
  EXPECT_EQ(receive(room, MSG_DONTWAIT), -1);
  close(std::exchange(ends[0], -1));
  EXPECT_EQ(receive(room), -1);
  EXPECT_FALSE(sendDescriptors(ends[1], &kWord, sizeof kWord, first(1))) << "and no signal ends this process";
}

}  // namespace
}  // namespace naiad
