#include "host/journal/JournalSink.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <vector>

#include "host/journal/Dfr.h"
#include "shared/values/LittleEndian.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void failJournal(const std::string& path) {
  throw std::system_error(errno, std::generic_category(), path);
}

/// Rounds' files by age, oldest first. Of others in the folder none is touched.
std::vector<fs::path> filesByAge(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".dfr" || !entry.is_regular_file(error)) continue;
    const auto time = entry.last_write_time(error);
    if (!error) found.emplace_back(time, entry.path());
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> paths;
  paths.reserve(found.size());
  for (auto& [time, path] : found) paths.push_back(std::move(path));
  return paths;
}

void removeOldest(const fs::path& folder, std::size_t kept) {
  const std::vector<fs::path> files = filesByAge(folder);
  std::error_code ignored;
  for (std::size_t i = 0; i + kept < files.size(); ++i) fs::remove(files[i], ignored);
}

}  // namespace

JournalFileSink::JournalFileSink(std::string path, std::size_t size) : m_path(std::move(path)) {
  const int file = ::open(m_path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
  const bool good = file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0 &&
                    ftruncate(file, static_cast<off_t>(size)) == 0 && lseek(file, 0, SEEK_END) >= 0;
  if (!good) {
    const int error = errno;
    if (file >= 0) close(file);
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
  removeOldest(folder, kMaxFiles);
}

void JournalFileSink::write(std::string_view bytes) {
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
