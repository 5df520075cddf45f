// Where a running client keeps what a later one needs to resume its session if it is killed: one file for
// each client, locked while it runs, so that a second terminal cannot take the session of the first.
//
// Files are 0600 in a directory of the user's own. A damaged file, or one that others can read, is not
// used but reported: the player then joins as a new one. Nothing here throws.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "client/trust/TokenStore.h"

namespace naiad {

/// Not thread-safe; any number of processes on one directory.
class SessionFile : public TokenStore {
 public:
  /// The time in the file is brought up to date this often.
  static constexpr std::chrono::seconds kRefresh{2};

  /// $XDG_STATE_HOME/naiad/sessions, or the same in ~/.local/state; nothing if the environment names neither.
  static std::optional<std::filesystem::path> defaultDirectory();

  /// Take over the newest file in the directory whose client does not run any more and played at `server`
  /// (ServerAddress::canonicalText()), under `name` if one is given. Files past their grace are removed.
  /// The directory is made with the first save().
  SessionFile(std::filesystem::path directory, std::string server, const std::optional<std::string>& name,
              Time now);
  /// The file stays; a client that leaves in order removes it.
  ~SessionFile() override;
  SessionFile(const SessionFile&) = delete;
  SessionFile& operator=(const SessionFile&) = delete;

  std::string tokenFor(const Fingerprint& key) const override;
  void save(SavedSession session, Time now) override;
  void refresh(Time now) override;
  void remove() override;

  /// Problems with files, a sentence each.
  const std::vector<std::string>& problems() const { return m_problems; }

 private:
  void findSession(const std::optional<std::string>& name, Time now);
  void consider(const std::filesystem::path& path, const std::optional<std::string>& name, Time now);
  std::optional<SavedSession> readOpen(int file, const std::filesystem::path& path);
  bool isDirectoryOurs();
  void makeOwn();
  void write(Time now);
  void closeFile();
  void complain(const std::filesystem::path& path, const std::string& what);

  std::filesystem::path m_directory;
  std::string m_server;
  std::filesystem::path m_path;
  int m_file = -1;     ///< locked; −1: none yet
  bool m_off = false;  ///< files do not work here
  std::optional<SavedSession> m_saved;
  std::vector<std::string> m_problems;
};

}  // namespace naiad
