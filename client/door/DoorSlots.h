// Visitors' folders of an ssh door, and the limits on concurrent visitors, in total and per address. For each
// visitor, a process holds a lock on a file, which the kernel releases when the process ends.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// Returns the folder name of the first key in `auth_info` (sshd's ExposeAuthInfo: lines "publickey TYPE
/// BASE64", at most 16,384 bytes): its line's SHA-256 in hexadecimal. Nullopt if too long or without a key.
std::optional<std::string> keyFolderName(std::string_view auth_info);

/// A visitor's folder, one for each SSH key: the name they played under and the files with which dfclient
/// resumes a session. So visitors are recognised on their next visit. One process at a time can lock it.
///
/// Anyone can make keys, so folders have a limit; when it is reached, those unused for 30 days are removed.
class VisitorFolder {
 public:
  static constexpr std::size_t kMaxFolders = 10'000;

  /// Opens the folder in `folder` for the key of this name, and creates it with mode 0700 if it does not
  /// exist. Returns null if it does not exist and `max_folders` are already in use. Throws std::system_error.
  static std::unique_ptr<VisitorFolder> open(const std::filesystem::path& folder, const std::string& name,
                                             std::size_t max_folders = kMaxFolders);
  /// Makes a folder for a visitor without a key. The destructor removes it.
  static std::unique_ptr<VisitorFolder> makeTemporary(const std::filesystem::path& folder);
  ~VisitorFolder();
  VisitorFolder(const VisitorFolder&) = delete;
  VisitorFolder& operator=(const VisitorFolder&) = delete;

  const std::filesystem::path& path() const { return m_path; }
  /// Locks the folder for the lifetime of this object. Returns false if another process has locked it.
  bool acquire();
  /// Returns the process that last locked the folder, as acquire() recorded it; 0 if unknown.
  pid_t holder() const;
  /// Returns the name that the visitor played under; empty for a new visitor.
  std::string name() const;
  /// Stores the name that name() returns. Throws std::system_error.
  void saveName(const std::string& name) const;

 private:
  explicit VisitorFolder(std::filesystem::path path, bool temporary)
      : m_path(std::move(path)), m_temporary(temporary) {}

  std::filesystem::path m_path;
  bool m_temporary;
  int m_lock = -1;
};

/// A visitor's place at the door, for this object's lifetime. Executed programs do not inherit the place.
class DoorSlot {
 public:
  struct Limits {
    int total = 64;
    int per_prefix = 8;  ///< maximum number of visitors from one IPv4 address or IPv6 /64
  };
  enum class Refusal { kNone, kFull, kFullForPrefix };
  struct AcquireResult {
    std::unique_ptr<DoorSlot> place;  ///< null: refused
    Refusal refusal = Refusal::kNone;
  };

  /// Takes a place for the visitor at this address, e.g. "192.0.2.7:50312" or "[2001:db8::7]:50312". Creates
  /// `folder` (0700) if it is missing. Waits briefly while others acquire places. Throws std::system_error.
  static AcquireResult acquire(const std::filesystem::path& folder, const std::string& visitor,
                               const Limits& limits);

  ~DoorSlot();
  DoorSlot(const DoorSlot&) = delete;
  DoorSlot& operator=(const DoorSlot&) = delete;

 private:
  explicit DoorSlot(int file) : m_file(file) {}
  int m_file;
};

}  // namespace naiad
