#include <gtest/gtest.h>
#include <signal.h>

#include <optional>

#include "client/ui/EarlySignalWatcher.h"

namespace naiad {
namespace {

class EarlySignalWatcherTest : public testing::Test {
 protected:
  static bool isDefault(int signal) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    return action.sa_handler == SIG_DFL;
  }

  asio::io_context context;
  int got = 0;
  std::optional<EarlySignalWatcher> signals{std::in_place, context, [this](int signal) { got = signal; }};
};

TEST_F(EarlySignalWatcherTest, FirstSignalIsReportedAndRestoresDefaultHandlers) {
  ASSERT_FALSE(isDefault(SIGTERM));
  raise(SIGTERM);
  while (got == 0) context.run_one();
  EXPECT_EQ(got, SIGTERM);
  EXPECT_TRUE(isDefault(SIGTERM) && isDefault(SIGINT) && isDefault(SIGHUP));
}

TEST_F(EarlySignalWatcherTest, SignalQueuedAtDestructionIsStillReported) {
  asio::signal_set probe(context, SIGINT);  // the newest set reports first; the watcher's report is queued
  int next = 0;
  bool gone = false;
  probe.async_wait([&](const std::error_code&, int) {
    probe.clear();
    EXPECT_EQ(got, 0);
    signals.emplace(context, [&next](int signal) { next = signal; });  // in the storage of the old object
    gone = true;
  });
  raise(SIGINT);
  while (!gone) context.run_one();
  context.poll();
  EXPECT_EQ(got, SIGINT);
  EXPECT_EQ(next, 0);
  EXPECT_FALSE(isDefault(SIGINT)) << "the report used what was gone";
}

TEST_F(EarlySignalWatcherTest, WithoutASignalDestructionRestoresDefaultHandlers) {
  signals.reset();
  EXPECT_TRUE(isDefault(SIGTERM) && isDefault(SIGINT) && isDefault(SIGHUP));
  context.run();
  EXPECT_EQ(got, 0);
}

}  // namespace
}  // namespace naiad
