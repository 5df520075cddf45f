#include "host/world/LandlockRules.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

namespace naiad {

namespace {

// The same numbers on all architectures.
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

/// Every right of a version, by the number of bits.
std::uint64_t rightsOf(int version) {
  if (version >= 5) return (kControlDevice << 1) - 1;
  if (version >= 3) return (kTruncate << 1) - 1;
  if (version == 2) return (kRefer << 1) - 1;
  return kRefer - 1;
}

struct Ruleset {
  std::uint64_t files = 0;
  std::uint64_t network = 0;  ///< since version 4: bind and connect, TCP
  std::uint64_t scoped = 0;   ///< since version 6: abstract Unix sockets, signals
};

struct [[gnu::packed]] PathBeneath {
  std::uint64_t access = 0;
  std::int32_t parent = -1;
};

std::size_t sizeOf(int version) {
  return (version >= 6 ? 3 : version >= 4 ? 2 : 1) * sizeof(std::uint64_t);
}

}  // namespace

int landlockVersion() {
  const long version = syscall(kCreateRuleset, nullptr, 0, kAskVersion);
  return version > 0 ? static_cast<int>(version) : 0;
}

LandlockRules::LandlockRules(int version) : m_handled(rightsOf(version)) {
  const Ruleset rules{m_handled, 3, 3};
  m_rules = static_cast<int>(syscall(kCreateRuleset, &rules, sizeOf(version), 0));
  if (m_rules < 0) m_error = errno;
}

LandlockRules::~LandlockRules() {
  if (m_rules >= 0) close(m_rules);
}

void LandlockRules::allow(const std::string& path, std::uint64_t access) const {
  PathBeneath rule{access & m_handled, open(path.c_str(), O_PATH | O_CLOEXEC)};
  if (rule.parent < 0) return;
  struct stat facts {};
  if (fstat(rule.parent, &facts) == 0 && !S_ISDIR(facts.st_mode)) rule.access &= kOfFiles;
  if (rule.access != 0) syscall(kAddRule, m_rules, kPathBeneath, &rule, 0);
  close(rule.parent);
}

void LandlockRules::allowReading(const std::string& path) {
  allow(path, kReading);
}

void LandlockRules::allowWriting(const std::string& path) {
  allow(path, kWriting);
}

void LandlockRules::allowAppending(const std::string& path) {
  allow(path, kWriteFile);
}

void LandlockRules::allowDevice(const std::string& path) {
  allow(path, kReadFile | kWriteFile | kControlDevice);
}

int LandlockRules::enforce() {
  if (m_error != 0) return m_error;
  return syscall(kRestrictSelf, m_rules, 0) == 0 ? 0 : errno;
}

}  // namespace naiad
