#include "host/world/Sandbox.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <linux/securebits.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "host/world/LandlockRules.h"
#include "host/world/SystemCallFilter.h"

namespace naiad {

namespace {

// A sanitizer's runtime reserves terabytes of addresses, reads /proc and traces its own process.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized =
    __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

constexpr rlim_t kMaxOpenFiles = 1024;
constexpr rlim_t kMaxFileSize = rlim_t{1} << 30;
/// Of the user, threads included: no fewer, for it counts all of the user's, not the world's.
constexpr rlim_t kMaxProcesses = 4096;

const char* const kSystemFiles[] = {"/etc/ld.so.cache",        "/etc/ld.so.preload",
                                    "/etc/localtime",          "/etc/timezone",
                                    "/etc/ssl/openssl.cnf",    "/etc/locale.alias",
                                    "/etc/terminfo",           "/etc/alternatives",
                                    "/sys/devices/system/cpu", "/proc/sys/vm/overcommit_memory"};
const char* const kDevices[] = {"/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom"};

/// Never more than it is.
void limit(decltype(RLIMIT_CORE) what, rlim_t most) {
  rlimit now{};
  if (getrlimit(what, &now) != 0) return;
  now.rlim_max = std::min(now.rlim_max, most);
  now.rlim_cur = std::min(now.rlim_cur, most);
  setrlimit(what, &now);
}

void limitResources(const Sandbox& sandbox) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_NOFILE, kMaxOpenFiles);
  limit(RLIMIT_FSIZE, kMaxFileSize);
  signal(SIGXFSZ, SIG_IGN);  // a log that is too long is an error for the one who writes, not its end
  limit(RLIMIT_NPROC, kMaxProcesses);
  if (sandbox.memory != 0 && !kSanitized) limit(RLIMIT_AS, sandbox.memory);
}

// For a server that root has started: nothing is left of it but the user's id.
void dropCapabilities() {
  __user_cap_header_struct asked{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct had[2] = {};
  if (syscall(SYS_capget, &asked, had) == 0 && had[0].permitted == 0 && had[1].permitted == 0) return;
  prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
  const __user_cap_data_struct none[2] = {};
  // Or root's next program would be given some again, and the kernel take that for a reason to randomise
  // addresses.
  prctl(PR_SET_SECUREBITS, SECBIT_NOROOT | SECBIT_NOROOT_LOCKED, 0, 0, 0);
  syscall(SYS_capset, &head, none);
}

void allowFiles(LandlockRules& rules, const Sandbox& sandbox) {
  for (const std::string& path : systemFolders()) rules.allowReading(path);
  for (const char* path : kSystemFiles) rules.allowReading(path);
  for (const char* path : kDevices) rules.allowDevice(path);
  if (kSanitized) rules.allowReading("/proc");
  for (const std::string& path : sandbox.readable) rules.allowReading(path);
  for (const std::string& path : sandbox.writable) rules.allowWriting(path);
  for (const std::string& path : sandbox.appendable) {
    if (const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640); file >= 0)
      close(file);
    rules.allowAppending(path);
  }
}

int filterCalls(int landlock) {
  FilterScene scene;
  scene.self = getpid();
  scene.signals_scoped = landlock >= kLandlockScopesSignals;
  scene.truncation_held = landlock >= kLandlockHoldsTruncation;
  scene.traces_itself = kSanitized;
  return installSystemCallFilter(makeSystemCallFilter(scene));
}

std::int32_t tryLandlock() {
  const int version = landlockVersion();
  return version > 0 && LandlockRules(version).enforce() == 0 ? version : 0;
}

std::int32_t tryFilter() {
  return filterCalls(0) == 0 ? 1 : 0;
}

/// What it finds in a process of its own; 0 if a host that forbids the call ends that process.
std::int32_t findInTrial(std::int32_t (*p_find)()) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return 0;
  const pid_t trial = fork();
  if (trial == 0) {
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    const std::int32_t found = p_find();
    _exit(write(ends[1], &found, sizeof found) == sizeof found ? 0 : 1);
  }
  close(ends[1]);
  std::int32_t found = 0;
  if (read(ends[0], &found, sizeof found) != sizeof found) found = 0;
  close(ends[0]);
  while (trial > 0 && waitpid(trial, nullptr, 0) < 0 && errno == EINTR) continue;
  return found;
}

}  // namespace

const std::vector<std::string>& systemFolders() {
  static const auto& folders =
      *new std::vector<std::string>{"/lib",         "/lib32",         "/lib64",           "/libx32",
                                    "/bin",         "/sbin",          "/usr/lib",         "/usr/lib32",
                                    "/usr/lib64",   "/usr/libx32",    "/usr/bin",         "/usr/sbin",
                                    "/usr/libexec", "/usr/share",     "/usr/local/lib",   "/usr/local/lib64",
                                    "/usr/games",   "/usr/local/bin", "/usr/local/share", "/nix/store",
                                    "/gnu/store"};
  return folders;
}

SandboxSupport findSandboxSupport() {
  return {findInTrial(tryLandlock), findInTrial(tryFilter), 0};
}

std::string sandboxGaps(const SandboxSupport& support) {
  const std::string files =
      "Landlock: games in processes of their own can open every file that this user can";
  const std::string calls = "filter of system calls: they can connect, and reach this user's other processes";
  if (support.landlock == 0 && support.filter == 0)
    return "this kernel has no " + files + "; and no " + calls;
  if (support.landlock == 0) return "this kernel has no " + files;
  if (support.filter == 0) return "this kernel has no " + calls;
  return {};
}

int enterSandbox(const Sandbox& sandbox, const SandboxSupport& support) {
  limitResources(sandbox);
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return errno;
  if (support.landlock > 0) {
    LandlockRules rules(support.landlock);
    allowFiles(rules, sandbox);
    if (const int error = rules.enforce(); error != 0) return error;
  }
  dropCapabilities();
  return support.filter != 0 ? filterCalls(support.landlock) : 0;
}

void hideProcess() {
  if (!kSanitized) prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
}

}  // namespace naiad
