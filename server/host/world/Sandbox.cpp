#include "host/world/Sandbox.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <linux/securebits.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <string>

#include "host/world/SystemCallFilter.h"

namespace naiad {

namespace {

// Landlock restricts the files that a world's process can open. Its system calls are called by number (equal
// on all architectures), because the installed headers may be older than the kernel.
constexpr long kCreateRuleset = 444;
constexpr long kAddRule = 445;
constexpr long kRestrictSelf = 446;

constexpr unsigned kAskVersion = 1;
constexpr unsigned kPathBeneath = 1;

constexpr std::uint64_t kExecute = 1 << 0;
constexpr std::uint64_t kWriteFile = 1 << 1;
constexpr std::uint64_t kReadFile = 1 << 2;
constexpr std::uint64_t kReadDir = 1 << 3;
constexpr std::uint64_t kRemoveDir = 1 << 4;
constexpr std::uint64_t kRemoveFile = 1 << 5;
constexpr std::uint64_t kMakeDir = 1 << 7;
constexpr std::uint64_t kMakeRegular = 1 << 8;
constexpr std::uint64_t kRefer = 1 << 13;
constexpr std::uint64_t kTruncate = 1 << 14;
constexpr std::uint64_t kControlDevice = 1 << 15;

constexpr std::uint64_t kOfFiles = kExecute | kWriteFile | kReadFile | kTruncate | kControlDevice;
constexpr std::uint64_t kReading = kExecute | kReadFile | kReadDir;
constexpr std::uint64_t kWriting =
    kReading | kWriteFile | kRemoveDir | kRemoveFile | kMakeDir | kMakeRegular | kRefer | kTruncate;

/// Returns all rights on files that a version of Landlock has, as bits.
std::uint64_t rightsOf(int version) {
  if (version >= 5) return (kControlDevice << 1) - 1;
  if (version >= 3) return (kTruncate << 1) - 1;
  if (version == 2) return (kRefer << 1) - 1;
  return kRefer - 1;
}

struct Ruleset {
  std::uint64_t files = 0;
  std::uint64_t network = 0;  ///< since version 4: bind() and connect() with TCP
  std::uint64_t scoped = 0;   ///< since version 6: abstract Unix sockets, signals
};

struct [[gnu::packed]] PathBeneath {
  std::uint64_t access = 0;
  std::int32_t parent = -1;
};

std::size_t sizeOf(int version) {
  return (version >= 6 ? 3 : version >= 4 ? 2 : 1) * sizeof(std::uint64_t);
}

inline constexpr int kLandlockHoldsTruncation = 3;
inline constexpr int kLandlockScopesSignals = 6;

class LandlockRules {
 public:
  /// Allows nothing at first. `version`: the result of landlockVersion(), above 0.
  explicit LandlockRules(int version) : m_handled(rightsOf(version)) {
    const Ruleset rules{m_handled, 3, 3};
    m_rules = static_cast<int>(syscall(kCreateRuleset, &rules, sizeOf(version), 0));
    if (m_rules < 0) m_error = errno;
  }
  ~LandlockRules() {
    if (m_rules >= 0) close(m_rules);
  }
  LandlockRules(const LandlockRules&) = delete;
  LandlockRules& operator=(const LandlockRules&) = delete;

  // Each path is a file, or a folder with all its content. Paths that cannot be opened are ignored.

  /// Allows reading, listing and executing.
  void allowReading(const std::string& path) { allow(path, kReading); }
  /// Like allowReading(), and allows writing, moving, making and removing files and folders, but not making
  /// symbolic links, sockets, named pipes or devices.
  void allowWriting(const std::string& path) { allow(path, kWriting); }
  /// Allows writing into an existing file.
  void allowAppending(const std::string& path) { allow(path, kWriteFile); }
  /// Allows the use of a device file.
  void allowDevice(const std::string& path) { allow(path, kReadFile | kWriteFile | kControlDevice); }

  /// Enforces the rules for this thread and all that it starts, permanently. PR_SET_NO_NEW_PRIVS must be set.
  /// Returns errno, or 0.
  int enforce() {
    if (m_error != 0) return m_error;
    return syscall(kRestrictSelf, m_rules, 0) == 0 ? 0 : errno;
  }

 private:
  void allow(const std::string& path, std::uint64_t access) const {
    PathBeneath rule{access & m_handled, open(path.c_str(), O_PATH | O_CLOEXEC)};
    if (rule.parent < 0) return;
    struct stat facts {};
    if (fstat(rule.parent, &facts) == 0 && !S_ISDIR(facts.st_mode)) rule.access &= kOfFiles;
    if (rule.access != 0) syscall(kAddRule, m_rules, kPathBeneath, &rule, 0);
    close(rule.parent);
  }

  std::uint64_t m_handled = 0;  ///< rights that are refused unless a rule allows them
  int m_rules = -1;
  int m_error = 0;
};

/// Returns the kernel's version of Landlock; 0: none. Version 3 restricts truncate(), version 6 signals to
/// other processes.
int landlockVersion() {
  const long version = syscall(kCreateRuleset, nullptr, 0, kAskVersion);
  return version > 0 ? static_cast<int>(version) : 0;
}

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
/// Limit of processes and threads. A lower one could make worlds fail: all processes of the user count.
constexpr rlim_t kMaxProcesses = 4096;

const char* const kSystemFiles[] = {"/etc/ld.so.cache",        "/etc/ld.so.preload",
                                    "/etc/localtime",          "/etc/timezone",
                                    "/etc/ssl/openssl.cnf",    "/etc/locale.alias",
                                    "/etc/terminfo",           "/etc/alternatives",
                                    "/sys/devices/system/cpu", "/proc/sys/vm/overcommit_memory"};
const char* const kDevices[] = {"/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom"};

/// Lowers a limit; never raises it.
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
  signal(SIGXFSZ, SIG_IGN);  // so that writing too long a file fails, but does not end the process
  limit(RLIMIT_NPROC, kMaxProcesses);
  if (sandbox.memory != 0 && !kSanitized) limit(RLIMIT_AS, sandbox.memory);
}

// Drops all capabilities. If root has started the server, the world keeps only root's user id.
void dropCapabilities() {
  __user_cap_header_struct asked{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct had[2] = {};
  if (syscall(SYS_capget, &asked, had) == 0 && had[0].permitted == 0 && had[1].permitted == 0) return;
  prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
  const __user_cap_data_struct none[2] = {};
  // Without these bits, the next program that root executes would get capabilities again, and the kernel
  // would randomise its addresses.
  prctl(PR_SET_SECUREBITS, SECBIT_NOROOT | SECBIT_NOROOT_LOCKED, 0, 0, 0);
  syscall(SYS_capset, &head, none);
}

void allowFiles(LandlockRules& rules, const Sandbox& sandbox) {
  rules.allowReading("/proc/self/exe");  // works even if an upgrade has replaced this file
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

/// Returns the result of `p_find` in a process of its own; 0 if that fails or is killed for a forbidden call.
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

std::string missingSandboxFeatures(const SandboxSupport& support) {
  const std::string files = "Landlock: game processes can open every file that this user can";
  const std::string calls =
      "system call filter: game processes can open connections, and reach this user's other processes";
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

void makeUndumpable() {
  if (!kSanitized) prctl(PR_SET_DUMPABLE, 0, 0, 0, 0);
}

}  // namespace naiad
