#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "host/world/OutputRelay.h"

namespace naiad {
namespace {

class OutputRelayTest : public testing::Test {
 protected:
  OutputRelayTest() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(pipe2(ends, O_CLOEXEC | O_NONBLOCK), 0);
    m_end = ends[1];
    relay.emplace(ends[0], [this](const std::string& line) { lines.push_back(line); });
  }
  ~OutputRelayTest() override { close(m_end); }
  /// Writes to the pipe. False once it is full.
  bool print(const std::string& text) const {
    return write(m_end, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  }

  std::vector<std::string> lines;
  std::optional<OutputRelay> relay;
  OutputRelay::Clock::time_point now = OutputRelay::Clock::now();

 private:
  int m_end = -1;
};

TEST_F(OutputRelayTest, RelaysCompleteLinesAndTheRestAtTheEnd) {
  print("one\ntw");
  relay->update(now);
  EXPECT_EQ(lines, std::vector<std::string>{"one"});
  print("o\n\nthree");
  relay->update(now);
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two", ""}));
  relay->finish(now);
  EXPECT_EQ(lines.back(), "three");
}

TEST_F(OutputRelayTest, LongLinesAreCut) {
  for (int i = 0; i < 4; ++i) print(std::string(OutputRelay::kMaxLine, 'x'));
  print("\nshort\n");
  relay->update(now);
  EXPECT_EQ(lines, (std::vector<std::string>{std::string(OutputRelay::kMaxLine, 'x'), "short"}));
}

TEST_F(OutputRelayTest, AFloodIsReadInPiecesLimitedAndCounted) {
  constexpr std::size_t kBurst = static_cast<std::size_t>(OutputRelay::kRate.burst);
  std::size_t printed = 0;
  for (int tick = 0; tick < 20; ++tick) {
    while (print("flood!\n")) ++printed;
    relay->update(now);
    EXPECT_TRUE(print("flood!\n")) << "the world goes on";
    ++printed;
  }
  relay->update(now);
  EXPECT_EQ(lines.size(), kBurst);
  now += std::chrono::seconds(1);
  print("later\n");
  relay->update(now);
  ASSERT_EQ(lines.size(), kBurst + 2);
  EXPECT_EQ(lines[kBurst], std::to_string(printed - kBurst) + " lines dropped (too many at once)");
  EXPECT_EQ(lines.back(), "later");
}

TEST_F(OutputRelayTest, OneUpdateReadsNoMoreThanItsShare) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(pipe2(ends, O_CLOEXEC | O_NONBLOCK), 0);
  if (fcntl(ends[0], F_SETPIPE_SZ, 4 * OutputRelay::kMaxRead) < 0) {
    close(ends[0]);
    close(ends[1]);
    GTEST_SKIP() << "no pipe may be that large";
  }
  OutputRelay large(ends[0], {});
  const std::string all(4 * OutputRelay::kMaxRead, 'x');
  EXPECT_EQ(write(ends[1], all.data(), all.size()), static_cast<ssize_t>(all.size()));
  large.update(now);
  EXPECT_LE(write(ends[1], all.data(), all.size()), static_cast<ssize_t>(OutputRelay::kMaxRead));
  close(ends[1]);
}

}  // namespace
}  // namespace naiad
