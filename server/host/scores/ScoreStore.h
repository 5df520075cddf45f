// The file of scores: an SQLite database in the server's state folder, with the tables of all its games.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/store/StateFile.h"

namespace naiad {

/// A row of a table. `round`, `tick` and `number` name it: no other row has the same.
struct ScoreRow {
  std::string table;
  std::string name;  ///< of the player
  std::int64_t points = 0;
  std::int64_t at = 0;         ///< seconds since 1970
  std::string round;           ///< RoundName::id
  std::uint32_t tick = 0;      ///< of the round in which it was added
  int number = 0;              ///< how many were added before it in that tick
  std::string recording = {};  ///< the name of the round's; empty: there is none
};

/// One thread at a time. Servers with the same folder share the file.
class ScoreStore {
 public:
  static constexpr std::size_t kMaxRows = 10'000;  ///< of a table; the least go

  /// Nothing is opened or made yet. `game`: whose tables they are.
  ScoreStore(std::filesystem::path file, std::string game);

  // These throw StateFileError.

  /// The best rows of a table, best first; of all tables, by name, if `table` is empty. None if there is no
  /// file.
  std::vector<ScoreRow> best(const std::string& table, std::size_t count);
  /// Add the rows, all or none of them. What is there already stays as it is. Makes the file if need be, and
  /// waits for the disk.
  void save(const std::vector<ScoreRow>& rows);

 private:
  std::vector<std::string> tables();
  void insert(const std::vector<ScoreRow>& rows);
  void trim(const std::string& table);

  StateFile m_file;
  std::string m_game;
};

}  // namespace naiad
