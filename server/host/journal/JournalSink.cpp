#include "host/journal/JournalSink.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "host/journal/Dfr.h"
#include "shared/net/base/SafeFile.h"
#include "shared/values/LittleEndian.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void failJournal(const std::string& path) {
  throw std::system_error(errno, std::generic_category(), path);
}

struct RoundFile {
  fs::file_time_type written_at;
  std::uintmax_t size = 0;
  fs::path path;
};

/// Returns the `.dfr` files of a folder, oldest first.
std::vector<RoundFile> filesByAge(const fs::path& folder) {
  std::vector<RoundFile> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code ignored;
    if (entry.path().extension() != ".dfr" || !entry.is_regular_file(ignored)) continue;
    RoundFile file{entry.last_write_time(error), entry.file_size(ignored), entry.path()};
    if (!error && !ignored) files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end(), [](const RoundFile& a, const RoundFile& b) {
    return std::tie(a.written_at, a.path) < std::tie(b.written_at, b.path);
  });
  return files;
}

/// True if this or another server is writing the file.
bool isBeingWritten(const fs::path& path) {
  try {
    const int file = openTrusted(path, O_RDONLY);
    const bool locked = flock(file, LOCK_SH | LOCK_NB) != 0;
    close(file);
    return locked;
  } catch (const std::system_error&) {
    return true;  // it may not be our file: count it as being written
  }
}

}  // namespace

void removeOldRounds(const std::string& folder, std::size_t max_files, std::uintmax_t max_bytes) {
  const std::vector<RoundFile> files = filesByAge(folder);
  std::size_t count = files.size();
  std::uintmax_t bytes = 0;
  for (const RoundFile& file : files) bytes += file.size;
  for (const RoundFile& file : files) {
    if (count <= max_files && bytes <= max_bytes) return;
    std::error_code error;
    if (isBeingWritten(file.path) || !fs::remove(file.path, error)) continue;
    --count;
    bytes -= file.size;
  }
}

JournalFileSink::JournalFileSink(std::string path, std::size_t size) : m_path(std::move(path)), m_size(size) {
  const int file = openTrusted(m_path, O_WRONLY);
  const bool good = flock(file, LOCK_EX | LOCK_NB) == 0 && ftruncate(file, static_cast<off_t>(size)) == 0 &&
                    lseek(file, 0, SEEK_END) >= 0;
  if (!good) {
    const int error = errno;
    close(file);
    throw std::system_error(error, std::generic_category(), m_path);
  }
  m_file = file;
}

JournalFileSink::~JournalFileSink() {
  if (m_file >= 0) close(m_file);
}

void JournalFileSink::open() {
  const fs::path folder = fs::path(m_path).parent_path();
  if (!folder.empty() && mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) failJournal(folder.string());
  m_file = ::open(m_path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (m_file < 0 || flock(m_file, LOCK_EX | LOCK_NB) != 0) failJournal(m_path);
  removeOldRounds(folder.string(), kMaxFiles, kMaxFolder);
}

void JournalFileSink::write(std::string_view bytes) {
  if (bytes.size() > kMaxRoundFile - std::min(m_size, kMaxRoundFile))
    throw std::system_error(EFBIG, std::generic_category(), m_path);
  m_size += bytes.size();
  if (m_file < 0) open();
  while (!bytes.empty()) {
    const ssize_t count = ::write(m_file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failJournal(m_path);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void JournalFileSink::sync() {
  if (m_file >= 0 && fdatasync(m_file) != 0) failJournal(m_path);
}

void JournalFileSink::setFlags(std::uint16_t flags) {
  char bytes[sizeof flags];
  storeLittleEndian(flags, bytes);
  if (m_file < 0 || pwrite(m_file, bytes, sizeof bytes, kDfrFlagsAt) != sizeof bytes) failJournal(m_path);
}

}  // namespace naiad
