#include "client/door/DoorSlots.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <limits>
#include <system_error>
#include <utility>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/SafeFile.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxAuthInfo = 16'384;  // bytes; an RSA key of 16,384 bits takes about 3,000
constexpr std::chrono::hours kUnused{24 * 30};
constexpr const char* kLockFile = "lock";
constexpr const char* kNameFile = "name";

void removeUnused(const fs::path& folder) {
  std::error_code ignored;
  const auto now = fs::file_time_type::clock::now();
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const auto used = fs::last_write_time(entry.path(), ignored);
    if (!ignored && now - used > kUnused) fs::remove_all(entry.path(), ignored);
  }
}

std::size_t countOf(const fs::path& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder)) ++count;
  return count;
}

void makeFolder(const fs::path& path) {
  fs::create_directories(path);
  fs::permissions(path, fs::perms::owner_all);
}

constexpr std::size_t kMaxAddress = 64;  // maximum bytes of "[IPv6]:PORT"

/// An open file. The destructor closes it, which also unlocks it.
class Open {
 public:
  explicit Open(const fs::path& path)
      : m_file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600)) {
    if (m_file < 0) throw std::system_error(errno, std::generic_category(), path.string());
  }
  ~Open() {
    if (m_file >= 0) ::close(m_file);
  }
  Open(Open&& other) noexcept : m_file(std::exchange(other.m_file, -1)) {}
  Open& operator=(Open&&) = delete;

  bool lock() const { return ::flock(m_file, LOCK_EX | LOCK_NB) == 0; }
  int release() { return std::exchange(m_file, -1); }

  /// Returns the beginning of the text in the file.
  std::string read() const {
    std::array<char, kMaxAddress> text{};
    const ssize_t size = ::pread(m_file, text.data(), text.size(), 0);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
  }
  /// Replaces the text in the file. `what` says in an exception what failed.
  void write(const std::string& text, const std::string& what) const {
    const bool written = ::ftruncate(m_file, 0) == 0 &&
                         ::pwrite(m_file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
    if (!written) throw std::system_error(errno, std::generic_category(), what);
  }

 private:
  int m_file;
};

}  // namespace

std::optional<std::string> keyFolderName(std::string_view auth_info) {
  constexpr std::string_view kMethod = "publickey ";
  if (auth_info.size() > kMaxAuthInfo) return std::nullopt;
  while (!auth_info.empty()) {
    const std::size_t end = std::min(auth_info.find('\n'), auth_info.size());
    const std::string_view line = auth_info.substr(0, end);
    auth_info.remove_prefix(std::min(end + 1, auth_info.size()));
    if (!line.starts_with(kMethod) || line.size() == kMethod.size()) continue;
    std::array<unsigned char, 32> hash{};
    if (EVP_Digest(line.data(), line.size(), hash.data(), nullptr, EVP_sha256(), nullptr) != 1)
      return std::nullopt;
    return hexText(hash);
  }
  return std::nullopt;
}

std::unique_ptr<VisitorFolder> VisitorFolder::open(const fs::path& folder, const std::string& name,
                                                   std::size_t max_folders) {
  makeFolder(folder);
  const fs::path path = folder / name;
  if (!fs::exists(path) && countOf(folder) >= max_folders) {
    removeUnused(folder);
    if (countOf(folder) >= max_folders) return nullptr;
  }
  makeFolder(path);
  std::error_code ignored;
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
  return std::unique_ptr<VisitorFolder>(new VisitorFolder(path, false));
}

std::unique_ptr<VisitorFolder> VisitorFolder::makeTemporary(const fs::path& folder) {
  makeFolder(folder);
  std::string name = folder / "visitor-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
  return std::unique_ptr<VisitorFolder>(new VisitorFolder(name, true));
}

VisitorFolder::~VisitorFolder() {
  if (m_lock >= 0) ::close(m_lock);
  std::error_code ignored;
  if (m_temporary) fs::remove_all(m_path, ignored);
}

bool VisitorFolder::acquire() {
  const fs::path path = m_path / kLockFile;
  Open file(path);
  if (!file.lock()) return false;
  file.write(std::to_string(::getpid()) + "\n", path.string());
  m_lock = file.release();
  return true;
}

pid_t VisitorFolder::holder() const {
  const std::string text = readSmallFile(m_path / kLockFile, 32).value_or("");
  return readNumber<pid_t>(text.substr(0, text.find('\n')), 2, std::numeric_limits<pid_t>::max()).value_or(0);
}

std::string VisitorFolder::name() const {
  const std::string text = readSmallFile(m_path / kNameFile, 256).value_or("");
  return text.empty() ? "" : safeName(text);
}

void VisitorFolder::saveName(const std::string& name) const {
  replaceFile(m_path / kNameFile, name);
}

DoorSlot::AcquireResult DoorSlot::acquire(const fs::path& folder, const std::string& visitor,
                                          const Limits& limits) {
  makeFolder(folder);
  const auto prefix = AddressPrefix::ofEndpoint(visitor);
  const FileLock one_at_a_time(folder / "lock");
  std::optional<Open> free;
  int of_prefix = 0;
  for (int i = 0; i < limits.total; ++i) {
    Open place(folder / std::to_string(i));
    if (!place.lock()) {
      of_prefix += AddressPrefix::ofEndpoint(place.read()) == prefix ? 1 : 0;
    } else if (!free) {
      free.emplace(std::move(place));
    }
  }
  if (of_prefix >= limits.per_prefix) return {nullptr, Refusal::kFullForPrefix};
  if (!free) return {nullptr, Refusal::kFull};
  free->write(visitor, "cannot write to the folder \"places\" of --state");
  return {std::unique_ptr<DoorSlot>(new DoorSlot(free->release())), Refusal::kNone};
}

DoorSlot::~DoorSlot() {
  ::close(m_file);
}

}  // namespace naiad
