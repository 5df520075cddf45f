// The file of a control socket.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <utility>

namespace naiad {

/// A listening socket in the file system (AF_UNIX), mode 0660. It is moved to its path when it is ready,
/// under a lock on the folder, so only one of several servers that start at once gets the path.
class ControlFile {
 public:
  /// Creates the folder (0750) if necessary. Replaces a socket on which no process listens any more. Throws
  /// ListenError (TcpListener.h), for example if the path is in use or is another kind of file.
  explicit ControlFile(std::filesystem::path path);
  /// Removes the file if it is still this socket's. Closes the descriptor, except after releaseDescriptor().
  ~ControlFile();
  ControlFile(const ControlFile&) = delete;
  ControlFile& operator=(const ControlFile&) = delete;

  const std::filesystem::path& path() const { return m_path; }
  /// Returns the listening socket, which the caller must close.
  int releaseDescriptor() { return std::exchange(m_descriptor, -1); }

 private:
  void listenAt(const std::filesystem::path& path);
  void moveTo(const std::filesystem::path& from);

  std::filesystem::path m_path;
  int m_descriptor = -1;
  std::pair<dev_t, ino_t> m_identity;
};

/// Removes sockets of killed servers in this folder: those that have a name as from controlPath() and on
/// which no process listens.
void removeStaleControls(const std::filesystem::path& folder);

}  // namespace naiad
