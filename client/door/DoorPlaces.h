// The folder that a door keeps for each visitor, and the limits on visitors at the same time, in all and per
// address. A visitor holds a locked file; the kernel unlocks it when the process ends.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// The name of the folder for the key that sshd says was used (ExposeAuthInfo: lines "publickey TYPE
/// BASE64"), 64 hexadecimal digits. Nothing if the text names no key.
std::optional<std::string> keyFolderName(std::string_view auth_info);

/// Where a door keeps what belongs to one visitor: a folder for each key that they proved to have, so that
/// they are known again. It holds their name and the files with which dfclient resumes a session. One
/// process at a time can lock it.
///
/// Keys cost nothing, so there is a limit on folders; those that were not used for a month make room.
class VisitorFolder {
 public:
  static constexpr std::size_t kMaxFolders = 10'000;

  /// Opens the folder in `folder` for the key of this name, and creates it with mode 0700 if it does not
  /// exist. Returns null if there are already `max_folders`. Throws std::system_error.
  static std::unique_ptr<VisitorFolder> open(const std::filesystem::path& folder, const std::string& name,
                                             std::size_t max_folders = kMaxFolders);
  /// One that goes with this object, for visitors without a key.
  static std::unique_ptr<VisitorFolder> makeTemporary(const std::filesystem::path& folder);
  ~VisitorFolder();
  VisitorFolder(const VisitorFolder&) = delete;
  VisitorFolder& operator=(const VisitorFolder&) = delete;

  /// Returns the path of this visitor's folder.
  const std::filesystem::path& path() const { return m_path; }
  /// Have the use of it, while this lives. False: another process has it.
  bool take();
  /// That process, as it said in take(); 0 if that is not known.
  pid_t holder() const;
  /// The name that they played under; empty if there is none.
  std::string name() const;
  /// Stores the name that name() returns. Throws std::system_error.
  void keepName(const std::string& name) const;

 private:
  explicit VisitorFolder(std::filesystem::path path, bool temporary)
      : m_path(std::move(path)), m_temporary(temporary) {}

  std::filesystem::path m_path;
  bool m_temporary;
  int m_lock = -1;
};

/// A place, held while it lives. Children do not hold it.
class DoorPlace {
 public:
  struct Limits {
    int in_all = 64;
    int per_prefix = 8;  ///< of these, from one IPv4 address or IPv6 /64
  };
  enum class Refusal { kNone, kFull, kFullForPrefix };
  struct Taken {
    std::unique_ptr<DoorPlace> place;  ///< null: refused
    Refusal refusal = Refusal::kNone;
  };

  /// Take one for a visitor at this address, "192.0.2.7:50312" or "[2001:db8::7]:50312". The folder is made
  /// if it is missing, 0700. Waits for other processes that take one in it at the same time, which is short.
  /// Throws std::system_error.
  static Taken take(const std::filesystem::path& folder, const std::string& visitor, const Limits& limits);

  ~DoorPlace();
  DoorPlace(const DoorPlace&) = delete;
  DoorPlace& operator=(const DoorPlace&) = delete;

 private:
  explicit DoorPlace(int file) : m_file(file) {}
  int m_file;
};

}  // namespace naiad
