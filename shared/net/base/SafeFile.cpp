#include "shared/net/base/SafeFile.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <system_error>
#include <utility>

namespace naiad {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error = errno) {
  throw std::system_error(error, std::generic_category(), path.string());
}

/// Throws for a path that is not a regular file: reading a pipe could block, and a device may never end.
[[noreturn]] void refuseKind(const fs::path& path) {
  throw std::system_error(EINVAL, std::generic_category(),
                          path.string() + " is not a regular file, but a folder, a pipe or a device");
}

class File {
 public:
  File(int file, fs::path path) : file_(file), path_(std::move(path)) {
    if (file_ < 0) fail(path_);
  }
  ~File() {
    if (file_ >= 0) ::close(file_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t size = ::write(file_, bytes.data(), bytes.size());
      if (size < 0 && errno != EINTR) fail(path_);
      if (size > 0) bytes.remove_prefix(static_cast<std::size_t>(size));
    }
  }
  std::size_t read(std::span<char> into) const {
    for (;;) {
      const ssize_t size = ::read(file_, into.data(), into.size());
      if (size >= 0) return static_cast<std::size_t>(size);
      if (errno != EINTR) fail(path_);
    }
  }
  void sync() const {
    if (::fsync(file_) != 0) fail(path_);
  }
  struct stat facts() const {
    struct stat facts {};
    if (::fstat(file_, &facts) != 0) fail(path_);
    return facts;
  }
  int release() { return std::exchange(file_, -1); }
  /// Returns the first `most` bytes; all, if there are fewer.
  std::string readUpTo(std::size_t most) const {
    std::string content;
    std::array<char, 65'536> piece;
    while (content.size() < most) {
      const std::size_t size = read(std::span(piece).first(std::min(piece.size(), most - content.size())));
      if (size == 0) break;
      content.append(piece.data(), size);
    }
    return content;
  }
  /// Returns the content, which has at most `most` bytes.
  std::string readAll(std::size_t most) const {
    std::string content = readUpTo(most + 1);
    if (content.size() > most) fail(path_, EFBIG);
    return content;
  }

 private:
  int file_;
  fs::path path_;
};

/// Throws unless a file with these facts is trusted.
void checkTrusted(const fs::path& path, const struct stat& facts, Links links) {
  const mode_t writers = links == Links::kFollowed ? S_IWOTH : S_IWGRP | S_IWOTH;
  const bool is_own = facts.st_uid == ::geteuid() || facts.st_uid == 0;
  if (!S_ISREG(facts.st_mode) && !S_ISLNK(facts.st_mode)) refuseKind(path);
  if (S_ISREG(facts.st_mode) && is_own && (facts.st_mode & writers) == 0) return;
  throw std::system_error(EPERM, std::generic_category(),
                          path.string() + (S_ISLNK(facts.st_mode) ? " is a symbolic link"
                                           : is_own               ? " can be written by other users"
                                                                  : " belongs to another user"));
}

std::string randomSuffix() {
  unsigned number = 0;
  if (::getrandom(&number, sizeof number, 0) != sizeof number) number = static_cast<unsigned>(::getpid());
  char text[10];
  std::snprintf(text, sizeof text, ".%08x", number);
  return text;
}

/// kYes: the file survives a system crash, because it is synced.
enum class Durable { kNo, kYes };

/// A new file next to `path` with a unique name. The destructor deletes it unless it was renamed.
class Draft {
 public:
  Draft(const fs::path& path, std::string_view content, mode_t mode, Durable durable)
      : name_(path.string() + randomSuffix()) {
    constexpr int kNew = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
    const File file(::open(name_.c_str(), kNew, mode), name_);
    try {
      file.write(content);
      if (durable == Durable::kYes) file.sync();
    } catch (...) {
      ::unlink(name_.c_str());
      throw;
    }
  }
  ~Draft() { ::unlink(name_.c_str()); }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  const char* name() const { return name_.c_str(); }

 private:
  std::string name_;
};

/// Syncs the parent folder, so that the new name survives a system crash.
void syncDirectoryOf(const fs::path& path) {
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  File(::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC), parent).sync();
}

}  // namespace

std::optional<std::filesystem::path> userDirectory(const char* variable, const char* fallback) {
  // The XDG specification says to ignore relative paths.
  const char* const chosen = std::getenv(variable);
  if (chosen && *chosen == '/') return std::filesystem::path(chosen) / "naiad";
  const char* const home = std::getenv("HOME");
  if (home && *home == '/') return std::filesystem::path(home) / fallback / "naiad";
  return std::nullopt;
}

std::optional<std::string> readSmallFile(const fs::path& path, std::size_t most) {
  const int opened = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (opened < 0 && errno == ENOENT) return std::nullopt;
  if (opened < 0 && errno == ENXIO) refuseKind(path);
  const File file(opened, path);
  if (!S_ISREG(file.facts().st_mode)) refuseKind(path);
  return file.readAll(most);
}

// Checks the file before it opens it, too, because opening a pipe or a device may have an effect.
int openTrusted(const fs::path& path, int access, Links links) {
  const bool follows = links == Links::kFollowed;
  struct stat facts {};
  if (::fstatat(AT_FDCWD, path.c_str(), &facts, follows ? 0 : AT_SYMLINK_NOFOLLOW) == 0)
    checkTrusted(path, facts, links);
  constexpr int kWithoutWaiting = O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  File file(::open(path.c_str(), access | kWithoutWaiting | (follows ? 0 : O_NOFOLLOW)), path);
  checkTrusted(path, file.facts(), links);
  return file.release();
}

std::optional<std::string> readTrusted(const fs::path& path, std::size_t most, Links links) {
  try {
    return File(openTrusted(path, O_RDONLY, links), path).readAll(most);
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::no_such_file_or_directory) return std::nullopt;
    throw;
  }
}

std::string readTrustedStart(const fs::path& path, std::size_t bytes) {
  return File(openTrusted(path, O_RDONLY), path).readUpTo(bytes);
}

void requireTrusted(const fs::path& path) {
  struct stat facts {};
  if (::lstat(path.c_str(), &facts) == 0) checkTrusted(path, facts, Links::kRefused);
}

void replaceFile(const fs::path& path, std::string_view content) {
  const Draft draft(path, content, 0600, Durable::kYes);
  if (::rename(draft.name(), path.c_str()) != 0) fail(path);
  syncDirectoryOf(path);
}

void publishFile(const fs::path& path, std::string_view content) {
  requireRegular(path);
  const Draft draft(path, content, 0644, Durable::kNo);
  if (::rename(draft.name(), path.c_str()) != 0) fail(path);
}

bool makeFile(const fs::path& path, std::string_view content) {
  const Draft draft(path, content, 0600, Durable::kYes);
  if (::link(draft.name(), path.c_str()) != 0) {
    if (errno == EEXIST) return false;
    fail(path);
  }
  syncDirectoryOf(path);
  return true;
}

void requireRegular(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) refuseKind(path);
}

bool isOpenToOthers(const fs::path& path) {
  struct stat facts {};
  if (::stat(path.c_str(), &facts) != 0) fail(path);
  return (facts.st_mode & (S_IRWXG | S_IRWXO)) != 0;
}

FileLock::FileLock(const fs::path& path)
    : file_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600)) {
  if (file_ < 0) fail(path);
  while (::flock(file_, LOCK_EX) != 0) {
    if (errno == EINTR) continue;
    const int error = errno;
    ::close(file_);
    fail(path, error);
  }
}

FileLock::~FileLock() {
  ::close(file_);
}

}  // namespace naiad
