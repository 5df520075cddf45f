#include "client/trust/SessionFile.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "shared/net/base/SafeFile.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "session-";
constexpr int kMaxLooked = 1000;

std::string describe(int error) {
  return std::generic_category().message(error);
}

bool isOthersToo(const struct stat& facts) {
  return facts.st_uid != geteuid() || (facts.st_mode & (S_IRWXG | S_IRWXO)) != 0;
}

}  // namespace

std::optional<fs::path> SessionFile::defaultDirectory() {
  const auto directory = userDirectory("XDG_STATE_HOME", ".local/state");
  return directory ? std::optional(*directory / "sessions") : std::nullopt;
}

SessionFile::SessionFile(fs::path directory, std::string server, const std::optional<std::string>& name,
                         Time now)
    : m_directory(std::move(directory)), m_server(std::move(server)) {
  std::error_code error;
  if (!fs::exists(m_directory, error) || !isDirectoryOurs()) return;
  try {
    findSession(name, now);
  } catch (const std::system_error& failure) {
    addProblem(m_directory, std::string("cannot be used: ") + failure.what());
  }
}

SessionFile::~SessionFile() {
  closeFile();
}

// Takes the directory's lock, because a new file is not locked for a moment after its creation.
void SessionFile::findSession(const std::optional<std::string>& name, Time now) {
  const FileLock lock(m_directory / "lock");
  int looked = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(m_directory)) {
    if (!entry.path().filename().string().starts_with(kPrefix)) continue;
    if (++looked > kMaxLooked) break;
    consider(entry.path(), name, now);
  }
}

void SessionFile::consider(const fs::path& path, const std::optional<std::string>& name, Time now) {
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0) {
    if (errno != ENOENT) addProblem(path, "is ignored: " + describe(errno));
    return;
  }
  const bool running = ::flock(file, LOCK_EX | LOCK_NB) != 0;
  auto saved = running ? std::nullopt : readOpen(file, path);
  const bool over = saved && !saved->isWithinGrace(now);
  if (over) ::unlink(path.c_str());
  const bool wanted = saved && !over && saved->server == m_server && (!name || saved->name == *name) &&
                      (!m_saved || saved->alive > m_saved->alive);
  if (!wanted) {
    ::close(file);
    return;
  }
  closeFile();
  m_file = file;
  m_path = path;
  m_saved = std::move(saved);
}

std::optional<SavedSession> SessionFile::readOpen(int file, const fs::path& path) {
  struct stat facts {};
  if (::fstat(file, &facts) != 0 || facts.st_nlink == 0) return std::nullopt;
  if (!S_ISREG(facts.st_mode) || isOthersToo(facts)) {
    addProblem(path, "is ignored: expected a regular file of yours with mode 0600");
    return std::nullopt;
  }
  std::array<char, kSavedSessionSize + 1> bytes{};
  const ssize_t size = ::pread(file, bytes.data(), bytes.size(), 0);
  auto saved = size < 0 ? std::nullopt : readSavedSession({bytes.data(), static_cast<std::size_t>(size)});
  if (!saved) {
    ::unlink(path.c_str());
    addProblem(path, "was damaged and has been removed");
  }
  return saved;
}

bool SessionFile::isDirectoryOurs() {
  struct stat facts {};
  if (::lstat(m_directory.c_str(), &facts) != 0) {
    addProblem(m_directory, "cannot be used: " + describe(errno));
  } else if (!S_ISDIR(facts.st_mode) || isOthersToo(facts)) {
    addProblem(m_directory, "cannot be used: expected a directory of yours with mode 0700");
  } else {
    return true;
  }
  m_off = true;
  return false;
}

std::string SessionFile::tokenFor(const Fingerprint& key) const {
  return m_saved && m_saved->key == key ? m_saved->token : std::string();
}

void SessionFile::save(SavedSession session, Time now) {
  if (m_off) return;
  if (session.token.empty()) return remove();
  session.server = m_server;
  m_saved = std::move(session);
  try {
    if (m_file < 0) makeOwn();
    if (m_file >= 0) write(now);
  } catch (const std::system_error& failure) {
    addProblem(m_directory, std::string("cannot be used: ") + failure.what());
    m_off = true;
  }
}

void SessionFile::makeOwn() {
  fs::create_directories(m_directory.parent_path());
  ::mkdir(m_directory.c_str(), S_IRWXU);
  if (!isDirectoryOurs()) return;
  const FileLock lock(m_directory / "lock");
  std::string name = m_directory / (std::string(kPrefix) + "XXXXXX");
  m_file = ::mkostemp(name.data(), O_CLOEXEC);  // mode 0600
  if (m_file < 0 || ::flock(m_file, LOCK_EX | LOCK_NB) != 0) {
    throw std::system_error(errno, std::generic_category(), name);
  }
  m_path = name;
}

void SessionFile::refresh(Time now) {
  if (m_off || m_file < 0 || !m_saved) return;
  if (now >= m_saved->alive && now - m_saved->alive < kRefresh) return;
  write(now);
}

// Writes in place, because this file is locked, and all at once, because the process may die at any time.
void SessionFile::write(Time now) {
  m_saved->alive = now;
  const auto text = writeSavedSession(*m_saved);
  if (text && ::pwrite(m_file, text->data(), text->size(), 0) == static_cast<ssize_t>(text->size())) return;
  addProblem(m_path, text ? "cannot be written: " + describe(errno) : "would be too long");
  remove();
  m_off = true;
}

void SessionFile::remove() {
  if (m_file >= 0) ::unlink(m_path.c_str());
  closeFile();
  m_saved.reset();
}

void SessionFile::closeFile() {
  if (m_file >= 0) ::close(m_file);
  m_file = -1;
}

void SessionFile::addProblem(const fs::path& path, const std::string& what) {
  m_problems.push_back(path.string() + " " + what + ".");
}

}  // namespace naiad
