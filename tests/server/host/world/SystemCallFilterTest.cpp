// The filter alone, in child processes of the tests; without Landlock it has more to do. Also the detection
// of features that the kernel lacks or the host forbids.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "host/world/Sandbox.h"
#include "host/world/SystemCallFilter.h"

namespace naiad {
namespace {

class SystemCallFilterTest : public testing::Test {
 protected:
  void SetUp() override {
    if (findSandboxSupport().filter == 0) GTEST_SKIP() << "this kernel has no seccomp";
  }
  /// Runs `act` in a process with the filter. Returns its wait status; it exits with the result of `act`.
  static int run(FilterScene scene, const std::function<int()>& act) {
    const pid_t child = fork();
    if (child == 0) {
      scene.self = getpid();
      scene.traces_itself = true;  // because a sanitizer may be in use
      prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
      _exit(installSystemCallFilter(makeSystemCallFilter(scene)) != 0 ? 99 : act());
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
  }
  /// Returns 0 if all calls failed with EPERM, else the number (from 1) of the first that did not.
  static int firstAllowed(const std::vector<std::function<long()>>& calls) {
    for (std::size_t i = 0; i < calls.size(); ++i) {
      if (calls[i]() != -1 || errno != EPERM) return static_cast<int>(i) + 1;
    }
    return 0;
  }
};

TEST_F(SystemCallFilterTest, WithoutLandlockNoOtherProcessIsSignalled) {
  const pid_t other = getpid();
  const int status = run({}, [other] {
    return firstAllowed({[other] { return kill(other, 0); }, [] { return kill(-1, 0); },
                         [] { return kill(1, 0); }, [other] { return kill(-other, 0); },
                         [other] { return syscall(SYS_tkill, other, 0); },
                         [other] { return syscall(SYS_tgkill, other, other, 0); },
                         [] { return fcntl(STDIN_FILENO, F_SETOWN, 1); }});
  });
  EXPECT_EQ(status, 0) << WEXITSTATUS(status);
}

TEST_F(SystemCallFilterTest, CrashKeepsItsSignal) {
  const int aborted = run({}, []() -> int { abort(); });
  EXPECT_TRUE(WIFSIGNALED(aborted) && WTERMSIG(aborted) == SIGABRT) << aborted;
  const int killed = run({}, [] { return kill(getpid(), SIGTERM); });
  EXPECT_TRUE(WIFSIGNALED(killed) && WTERMSIG(killed) == SIGTERM) << killed;
}

TEST_F(SystemCallFilterTest, WithoutLandlockNoReadableFileIsEmptied) {
  const std::string path = testing::TempDir() + "naiad-filter-" + std::to_string(getpid());
  const int file = open(path.c_str(), O_WRONLY | O_CREAT, 0600);
  ASSERT_EQ(write(file, "text", 4), 4);
  close(file);
  const int status = run({}, [&path] {
    return firstAllowed(
        {[&] { return open(path.c_str(), O_RDONLY | O_TRUNC); }, [&] { return truncate(path.c_str(), 0); }});
  });
  EXPECT_EQ(status, 0) << WEXITSTATUS(status);
  struct stat facts {};
  EXPECT_EQ(stat(path.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_size, 4);
  const int written = run({}, [&path] { return open(path.c_str(), O_WRONLY | O_TRUNC) >= 0 ? 0 : 1; });
  EXPECT_EQ(written, 0) << "whether this may be written, Landlock decides";
  unlink(path.c_str());
}

TEST_F(SystemCallFilterTest, X32SystemCallsAreRefused) {
#ifdef __x86_64__
  const int status = run({}, [] { return firstAllowed({[] { return syscall(0x4000'0000 + SYS_getpid); }}); });
  EXPECT_EQ(status, 0) << WEXITSTATUS(status);
#else
  GTEST_SKIP() << "it has none";
#endif
}

TEST_F(SystemCallFilterTest, NewerSystemCallsFailWithEnosys) {
  const int status = run({}, [] {
    for (const long call : {435L, 437L, 463L, 1000L}) {  // clone3 and openat2 have older replacements
      if (syscall(call, 0, 0, 0, 0) != -1 || errno != ENOSYS) return static_cast<int>(call % 200);
    }
    return 0;
  });
  EXPECT_EQ(status, 0) << WEXITSTATUS(status);
}

TEST(Sandbox, SaysWhatTheKernelLacks) {
  EXPECT_EQ(missingSandboxFeatures({7, 1}), "");
  EXPECT_NE(missingSandboxFeatures({0, 1}).find("Landlock"), std::string::npos);
  EXPECT_NE(missingSandboxFeatures({1, 0}).find("system call filter"), std::string::npos);
  EXPECT_NE(missingSandboxFeatures({0, 0}).find("Landlock"), std::string::npos);
  EXPECT_NE(missingSandboxFeatures({0, 0}).find("system call filter"), std::string::npos);
}

// Like a systemd service whose allowed system calls do not include Landlock's and seccomp().
TEST(Sandbox, UsesOnlyTheFilterIfLandlockIsForbidden) {
  if (findSandboxSupport().filter == 0) GTEST_SKIP() << "this kernel has no seccomp";
  const pid_t child = fork();
  if (child == 0) {
    std::vector<sock_filter> forbidding{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
    for (const unsigned call : {444u, 445u, 446u, unsigned{__NR_seccomp}}) {
      forbidding.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1));
      forbidding.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS));
    }
    forbidding.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (installSystemCallFilter(forbidding) != 0) _exit(99);
    const SandboxSupport support = findSandboxSupport();
    if (support.landlock != 0 || support.filter != 1) _exit(1);
    _exit(enterSandbox({}, support) == 0 ? 0 : 2);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0) << WEXITSTATUS(status);
}

}  // namespace
}  // namespace naiad
