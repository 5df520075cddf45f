// Stores a running client's session, so that a later client can resume it if this one is killed. Each client
// has a file, locked while it runs, so that a second terminal cannot take the session of the first.
//
// Files have mode 0600 in a directory that only the user can access. A file that others can access is
// reported and not used, and a damaged one is removed, too: the player joins as a new one. Nothing throws.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "client/trust/TokenStore.h"

namespace naiad {

/// Not thread-safe. Any number of processes may use one directory.
class SessionFile : public TokenStore {
 public:
  /// Interval at which the time in the file is updated.
  static constexpr std::chrono::seconds kRefresh{2};

  /// Returns naiad/sessions in $XDG_STATE_HOME or $HOME/.local/state; nullopt if neither variable is set.
  static std::optional<std::filesystem::path> defaultDirectory();

  /// Takes over the newest file of a client that no longer runs and played at `server`
  /// (ServerAddress::canonicalText()), under `name` if given. Removes such clients' files past their grace
  /// time. Examines at most 1000 files. The first save() creates the directory.
  SessionFile(std::filesystem::path directory, std::string server, const std::optional<std::string>& name,
              Time now);
  /// Keeps the file; a client that leaves on purpose calls remove().
  ~SessionFile() override;
  SessionFile(const SessionFile&) = delete;
  SessionFile& operator=(const SessionFile&) = delete;

  std::string tokenFor(const Fingerprint& key) const override;
  void save(SavedSession session, Time now) override;
  void refresh(Time now) override;
  void remove() override;

  /// Returns the problems with files, a sentence each.
  const std::vector<std::string>& problems() const { return m_problems; }

 private:
  void findSession(const std::optional<std::string>& name, Time now);
  void consider(const std::filesystem::path& path, const std::optional<std::string>& name, Time now);
  std::optional<SavedSession> readOpen(int file, const std::filesystem::path& path);
  bool isDirectoryOurs();
  void makeOwn();
  void write(Time now);
  void closeFile();
  void addProblem(const std::filesystem::path& path, const std::string& what);

  std::filesystem::path m_directory;
  std::string m_server;
  std::filesystem::path m_path;
  int m_file = -1;     ///< locked file; −1: none yet
  bool m_off = false;  ///< the directory or file cannot be used
  std::optional<SavedSession> m_saved;
  std::vector<std::string> m_problems;
};

}  // namespace naiad
