// Small files that are replaced as a whole, if requested readable by their owner alone; and a user's folders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// Returns the content; nullopt if the file does not exist. Throws std::system_error if it cannot be read,
/// has more than `most` bytes or is not a regular file. (Reading a pipe could block.) The functions below
/// throw std::system_error, too.
std::optional<std::string> readSmallFile(const std::filesystem::path& path, std::size_t most);

/// Replace or make the file, mode 0600, so that a reader finds either the old or the new one, after a crash
/// too.
void replaceFile(const std::filesystem::path& path, std::string_view content);

/// Replace or make a file that others may read (0644, less what the umask takes), in one step as well. A
/// symbolic link is replaced, not followed. Throws if there is something that is no regular file.
void publishFile(const std::filesystem::path& path, std::string_view content);

/// As replaceFile(), but false, and nothing changed, if there is one already.
bool makeFile(const std::filesystem::path& path, std::string_view content);

/// Throws if there is something of this name that is neither a regular file nor leads to one.
void requireRegular(const std::filesystem::path& path);

/// True if group or others may read or write it.
bool openToOthers(const std::filesystem::path& path);

/// While it lives, no other process or thread holds one on the same path (made if missing, 0600). Waits for
/// it.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& path);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_;
};

/// Where a user's files of one kind lie (XDG Base Directory Specification 0.8).
/// $variable/naiad if that is an absolute path, else $HOME/fallback/naiad; nothing if HOME is not set either.
/// ("XDG_CONFIG_HOME", ".config"), ("XDG_DATA_HOME", ".local/share").
std::optional<std::filesystem::path> userDirectory(const char* variable, const char* fallback);

}  // namespace naiad
