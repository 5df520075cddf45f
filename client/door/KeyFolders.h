// Where a door keeps what belongs to one visitor: a folder for each key that they proved to have, so that
// they are known again. In it are their name, and what dfclient keeps to come back to a session.
//
// Keys cost nothing, so there is a limit on folders; those that were not used for a month make room.
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

/// A visitor's folder, of which one process at a time has the use.
class VisitorFolder {
 public:
  static constexpr std::size_t kMaxFolders = 10'000;

  /// Of the key of this name, in `folder`: made if it is missing, 0700. Null if there are too many already.
  /// Throws std::system_error.
  static std::unique_ptr<VisitorFolder> open(const std::filesystem::path& folder, const std::string& name,
                                             std::size_t max_folders = kMaxFolders);
  /// One that goes with this object, for visitors without a key.
  static std::unique_ptr<VisitorFolder> makeTemporary(const std::filesystem::path& folder);
  ~VisitorFolder();
  VisitorFolder(const VisitorFolder&) = delete;
  VisitorFolder& operator=(const VisitorFolder&) = delete;

  const std::filesystem::path& path() const { return m_path; }
  /// Have the use of it, while this lives. False: another process has it.
  bool take();
  /// That process, as it said in take(); 0 if that is not known.
  pid_t holder() const;
  /// The name that they played under; empty if there is none.
  std::string name() const;
  void keepName(const std::string& name) const;

 private:
  explicit VisitorFolder(std::filesystem::path path, bool temporary)
      : m_path(std::move(path)), m_temporary(temporary) {}

  std::filesystem::path m_path;
  bool m_temporary;
  int m_lock = -1;
};

}  // namespace naiad
