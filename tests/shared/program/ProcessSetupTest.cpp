#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include "shared/program/ProcessSetup.h"

namespace naiad {
namespace {

/// Restores the action of SIGPIPE after each test.
class BrokenPipes : public testing::Test {
 protected:
  BrokenPipes() { sigaction(SIGPIPE, nullptr, &m_before); }
  ~BrokenPipes() override { sigaction(SIGPIPE, &m_before, nullptr); }

 private:
  struct sigaction m_before {};
};

TEST_F(BrokenPipes, WriteFailsButChildProcessesKeepTheDefault) {
  signal(SIGPIPE, SIG_DFL);
  ignoreBrokenPipes();
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  close(ends[0]);
  EXPECT_EQ(write(ends[1], "x", 1), -1);
  EXPECT_EQ(errno, EPIPE);
  close(ends[1]);
  const int status = std::system("kill -PIPE $$; exit 0");
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE) << status;
}

TEST_F(BrokenPipes, GameDefinedHandlerIsKept) {
  const auto handler = [](int) {};
  signal(SIGPIPE, handler);
  ignoreBrokenPipes();
  struct sigaction now {};
  sigaction(SIGPIPE, nullptr, &now);
  EXPECT_EQ(now.sa_handler, static_cast<void (*)(int)>(handler));
}

TEST(ErrorText, RefusedResourcesNameTheLimits) {
  const auto names_limits = [](const std::string& text) {
    return text.find("ulimit -v") != std::string::npos && text.find("ulimit -u") != std::string::npos;
  };
  const std::system_error no_thread(std::make_error_code(std::errc::resource_unavailable_try_again));
  EXPECT_TRUE(names_limits(errorText(no_thread))) << errorText(no_thread);
  EXPECT_TRUE(errorText(no_thread).starts_with(no_thread.what()));
  EXPECT_TRUE(names_limits(errorText(std::bad_alloc())));
  EXPECT_TRUE(names_limits(errorText(EAGAIN)));
  EXPECT_FALSE(names_limits(errorText(ENOENT)));
  EXPECT_EQ(errorText(std::runtime_error("No such game.")), "No such game.");
}

}  // namespace
}  // namespace naiad
