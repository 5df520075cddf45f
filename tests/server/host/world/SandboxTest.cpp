// Detection of sandbox features that the kernel lacks or the host forbids.
#include <gtest/gtest.h>
#include <linux/audit.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <vector>

#include "host/world/Sandbox.h"
#include "host/world/SystemCallFilter.h"

namespace naiad {
namespace {

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
