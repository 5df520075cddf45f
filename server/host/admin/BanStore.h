// The file of bans: an SQLite database in the server's state folder.
#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/admin/Ban.h"

struct sqlite3;

namespace naiad {

/// The file is there and cannot be used. what() is one sentence for people.
class BanFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One thread at a time. Servers with the same folder share the file; each reads what others wrote when it
/// loads.
class BanStore {
 public:
  /// Nothing is opened or made yet.
  explicit BanStore(std::filesystem::path file);
  ~BanStore();
  BanStore(const BanStore&) = delete;
  BanStore& operator=(const BanStore&) = delete;

  /// All bans, without numbers. None if there is no file. Throws BanFileError for one that cannot be read, is
  /// damaged, or is no file of bans: it is left as it is, and whoever is banned must not come in meanwhile.
  std::vector<Ban> load();
  /// Add the ban, in place of one of the same target. The file and its folder are made if need be (0600).
  /// Waits for the disk. Throws BanFileError.
  void save(const Ban& ban);
  /// Take it out, if it is there. Throws BanFileError.
  void erase(const Ban& ban);

 private:
  struct Close {
    void operator()(sqlite3* p_database) const;
  };
  void make();
  void open();
  void openAt(const std::filesystem::path& path);
  void check();
  void run(const char* p_statements);
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path m_file;
  std::unique_ptr<sqlite3, Close> m_database;
};

}  // namespace naiad
