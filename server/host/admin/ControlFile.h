// The file of a control socket.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <utility>

namespace naiad {

/// A socket that listens at a path of the file system (AF_UNIX), mode 0660. The file comes into its place
/// when it is complete, and under a lock on the folder: of several servers that begin at once one gets the
/// path.
class ControlFile {
 public:
  /// Makes the folder, with mode 0750, if it is not there. A socket on which nobody listens any more is
  /// replaced; one that is in use, and anything else, is not. Throws ListenError (TcpListener.h).
  explicit ControlFile(std::filesystem::path path);
  /// Removes the file, unless it is no longer this one. Closes the descriptor unless it was taken.
  ~ControlFile();
  ControlFile(const ControlFile&) = delete;
  ControlFile& operator=(const ControlFile&) = delete;

  const std::filesystem::path& path() const { return m_path; }
  /// The listening socket; the caller closes it.
  int takeDescriptor() { return std::exchange(m_descriptor, -1); }

 private:
  void listenAt(const std::filesystem::path& path);
  void moveTo(const std::filesystem::path& from);

  std::filesystem::path m_path;
  int m_descriptor = -1;
  std::pair<dev_t, ino_t> m_identity;
};

/// Remove the sockets in this folder that are named as by controlPath() and on which nobody listens: their
/// servers were killed.
void removeStaleControls(const std::filesystem::path& folder);

}  // namespace naiad
