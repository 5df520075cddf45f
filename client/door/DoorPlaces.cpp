#include "client/door/DoorPlaces.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxAddress = 64;  // bytes of "[IPv6]:PORT"

/// An open file; closed at the end, and unlocked with that.
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

  /// What holders of the place wrote; their address.
  std::string read() const {
    std::array<char, kMaxAddress> text{};
    const ssize_t size = ::pread(m_file, text.data(), text.size(), 0);
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
  }
  void write(const std::string& text) const {
    const bool written = ::ftruncate(m_file, 0) == 0 &&
                         ::pwrite(m_file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
    if (!written) throw std::system_error(errno, std::generic_category(), "a place of the door");
  }

 private:
  int m_file;
};

}  // namespace

DoorPlace::Taken DoorPlace::take(const fs::path& folder, const std::string& visitor, const Limits& limits) {
  fs::create_directories(folder);
  fs::permissions(folder, fs::perms::owner_all);
  const auto prefix = AddressPrefix::ofEndpoint(visitor);
  const FileLock one_at_a_time(folder / "lock");
  std::optional<Open> free;
  int of_prefix = 0;
  for (int i = 0; i < limits.in_all; ++i) {
    Open place(folder / std::to_string(i));
    if (!place.lock()) {
      of_prefix += AddressPrefix::ofEndpoint(place.read()) == prefix ? 1 : 0;
    } else if (!free) {
      free.emplace(std::move(place));
    }
  }
  if (of_prefix >= limits.per_prefix) return {nullptr, Refusal::kFullForPrefix};
  if (!free) return {nullptr, Refusal::kFull};
  free->write(visitor);
  return {std::unique_ptr<DoorPlace>(new DoorPlace(free->release())), Refusal::kNone};
}

DoorPlace::~DoorPlace() {
  ::close(m_file);
}

}  // namespace naiad
