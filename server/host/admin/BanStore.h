// The file of bans: an SQLite database in the server's state folder.
#pragma once

#include <filesystem>
#include <vector>

#include "host/admin/Ban.h"
#include "host/store/StateFile.h"

namespace naiad {

/// The file is there and cannot be used. what() is one sentence for people.
using BanFileError = StateFileError;

/// One thread at a time. Servers with the same folder share the file; each reads what others wrote when it
/// loads.
class BanStore {
 public:
  /// Nothing is opened or made yet.
  explicit BanStore(std::filesystem::path file);

  /// All bans, without numbers. None if there is no file. Throws BanFileError for one that cannot be read, is
  /// damaged, or is no file of bans: it is left as it is, and whoever is banned must not come in meanwhile.
  std::vector<Ban> load();
  /// Add the ban, in place of one of the same target. The file and its folder are made if need be (0600).
  /// Waits for the disk. Throws BanFileError.
  void save(const Ban& ban);
  /// Take it out, if it is there. Throws BanFileError.
  void erase(const Ban& ban);

 private:
  StateFile m_file;
};

}  // namespace naiad
