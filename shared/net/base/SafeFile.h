// Small files that are replaced as a whole and may be private to their owner, and a user's folders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// Returns the content; nullopt if the file does not exist. Throws std::system_error if it cannot be read,
/// has more than `most` bytes or is not a regular file. (Reading a pipe could block.) The functions below
/// also throw std::system_error if they fail.
std::optional<std::string> readSmallFile(const std::filesystem::path& path, std::size_t most);

/// Creates or replaces the file, mode 0600. Readers see either the old or the new one, even after a crash.
void replaceFile(const std::filesystem::path& path, std::string_view content);

/// Like replaceFile(), but others may read the file (0644 minus the umask), and it is not synced: a system
/// crash may lose its content. A symbolic link is replaced, not followed. Throws like requireRegular(), too.
void publishFile(const std::filesystem::path& path, std::string_view content);

/// Like replaceFile(), but returns false and changes nothing if the file exists.
bool makeFile(const std::filesystem::path& path, std::string_view content);

/// Throws if the path exists and is neither a regular file nor a link to one.
void requireRegular(const std::filesystem::path& path);

// A trusted file is a regular file that belongs to this user or to root and that no other user can write. A
// server's state consists of trusted files, so that no other user can change what it plays and remembers.

/// kFollowed: the host provides the file, which may be a symbolic link, and its group may write it.
enum class Links { kRefused, kFollowed };

/// Opens an existing trusted file, without waiting. Returns a descriptor, which the caller closes. `access`:
/// O_RDONLY, O_WRONLY or O_RDWR. Throws if the file is missing, not trusted or cannot be opened.
int openTrusted(const std::filesystem::path& path, int access, Links links = Links::kRefused);

/// Like readSmallFile(), but throws if the file is not trusted.
std::optional<std::string> readTrusted(const std::filesystem::path& path, std::size_t most,
                                       Links links = Links::kRefused);

/// Returns the first `bytes` bytes of a trusted file; all, if it has fewer.
std::string readTrustedStart(const std::filesystem::path& path, std::size_t bytes);

/// Throws if the path exists and is not a trusted file. For libraries that open files by name.
void requireTrusted(const std::filesystem::path& path);

/// True if the file's group or other users have any right to the file.
bool isOpenToOthers(const std::filesystem::path& path);

/// A lock on a file (created if missing, 0600), which excludes other FileLocks in all processes and threads
/// while this object lives. The constructor waits until it gets the lock.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_;
};

/// Returns the folder for a user's files of one kind (XDG Base Directory Specification 0.8): $variable/naiad
/// if that is an absolute path, else $HOME/fallback/naiad; nullopt if HOME is not an absolute path either.
/// The arguments are, for example, ("XDG_CONFIG_HOME", ".config") or ("XDG_DATA_HOME", ".local/share").
std::optional<std::filesystem::path> userDirectory(const char* variable, const char* fallback);

}  // namespace naiad
