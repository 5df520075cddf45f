#include "host/admin/ControlFile.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "shared/admin/ControlPath.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

constexpr mode_t kControlMode = 0660;
constexpr auto kFolderMode = fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec;
constexpr int kBacklog = 16;

[[noreturn]] void failControl(const fs::path& path, const std::string& why, std::error_code code) {
  throw ListenError("Cannot listen for commands on " + path.string() + ": " + why + ".", code);
}

[[noreturn]] void failControl(const fs::path& path, int error) {
  const std::error_code code(error, std::generic_category());
  failControl(path, code.message(), code);
}

/// Locks a folder during its lifetime. If the folder cannot be locked, continues without a lock.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : m_descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (m_descriptor >= 0) ::flock(m_descriptor, LOCK_EX);
  }
  ~FolderLock() {
    if (m_descriptor >= 0) ::close(m_descriptor);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int m_descriptor;
};

int openSocket() {
  return ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
}

/// Precondition: the path fits in a sockaddr_un.
sockaddr_un addressOf(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  return address;
}

/// True if no process listens on the socket. Does not wait; a server with a full backlog counts as alive.
bool isDead(const fs::path& path) {
  const int descriptor = openSocket();
  if (descriptor < 0) return false;
  const sockaddr_un address = addressOf(path);
  const int result = ::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const bool refused = result != 0 && errno == ECONNREFUSED;
  ::close(descriptor);
  return refused;
}

std::pair<dev_t, ino_t> fileIdentity(const fs::path& path) {
  struct stat facts {};
  return ::lstat(path.c_str(), &facts) == 0 ? std::pair(facts.st_dev, facts.st_ino)
                                            : std::pair<dev_t, ino_t>();
}

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void makeFolder(const fs::path& path) {
  const fs::path folder = folderOf(path);
  std::error_code error;
  if (fs::exists(folder, error)) return;
  fs::create_directories(folder, error);
  if (!error) fs::permissions(folder, kFolderMode, error);
  if (error) failControl(path, error.message(), error);
}

}  // namespace

ControlFile::ControlFile(fs::path path) : m_path(std::move(path)) {
  const fs::path fresh = m_path.string() + ".new";
  if (fresh.string().size() >= sizeof(sockaddr_un::sun_path))
    failControl(m_path, "the path is longer than 103 bytes",
                std::make_error_code(std::errc::filename_too_long));
  makeFolder(m_path);
  const FolderLock lock(folderOf(m_path));
  ::unlink(fresh.c_str());
  try {
    listenAt(fresh);
    moveTo(fresh);
  } catch (const ListenError&) {
    ::unlink(fresh.c_str());
    if (m_descriptor >= 0) ::close(m_descriptor);
    throw;
  }
}

void ControlFile::listenAt(const fs::path& path) {
  m_descriptor = openSocket();
  const sockaddr_un address = addressOf(path);
  if (m_descriptor < 0 ||
      ::bind(m_descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(path.c_str(), kControlMode) != 0 || ::listen(m_descriptor, kBacklog) != 0)
    failControl(m_path, errno);
}

void ControlFile::moveTo(const fs::path& from) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(m_path, error);
  if (fs::exists(status) && status.type() != fs::file_type::socket)
    failControl(m_path, "the path exists and is not a socket", std::make_error_code(std::errc::file_exists));
  if (fs::exists(status) && !isDead(m_path))
    failControl(m_path, "another program is listening there",
                std::make_error_code(std::errc::address_in_use));
  m_identity = fileIdentity(from);
  if (::rename(from.c_str(), m_path.c_str()) != 0) failControl(m_path, errno);
}

ControlFile::~ControlFile() {
  if (m_descriptor >= 0) ::close(m_descriptor);
  const FolderLock lock(folderOf(m_path));
  if (fileIdentity(m_path) == m_identity) ::unlink(m_path.c_str());
}

void removeStaleControls(const fs::path& folder) {
  const FolderLock lock(folder);
  for (const fs::path& path : controlSockets(folder)) {
    if (path.string().size() < sizeof(sockaddr_un::sun_path) && isDead(path)) ::unlink(path.c_str());
  }
}

}  // namespace naiad
