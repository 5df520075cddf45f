// The score file: an SQLite database in the server's state folder, with the tables of all its games.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/store/StateFile.h"

namespace naiad {

/// A row of a table, identified by `round`, `tick` and `number`.
struct ScoreRow {
  std::string table;
  std::string name;  ///< name of the player
  std::int64_t points = 0;
  std::int64_t at = 0;         ///< seconds since 1970
  std::string round;           ///< RoundName::id
  std::uint32_t tick = 0;      ///< tick of the round in which the score was added
  int number = 0;              ///< number of scores added before it in that tick
  std::string recording = {};  ///< file name of the round's recording; empty: none
};

/// The tables of one game. For one thread at a time. Servers with a common folder share the file.
class ScoreStore {
 public:
  static constexpr std::size_t kMaxRows = 10'000;  ///< maximum rows of a table; the lowest scores are dropped

  /// Does not open or create the file yet.
  ScoreStore(std::filesystem::path file, std::string game);

  // The following functions throw StateFileError.

  /// Returns the best `count` rows of a table, best first, or of each table, by name, if `table` is empty.
  /// Returns none if the file does not exist.
  std::vector<ScoreRow> best(const std::string& table, std::size_t count);
  /// Adds all rows or none. Ignores rows already there. Creates the file if necessary. Waits for the disk.
  void save(const std::vector<ScoreRow>& rows);

 private:
  std::vector<std::string> tables();
  void insert(const std::vector<ScoreRow>& rows);
  void trim(const std::string& table);

  StateFile m_file;
  std::string m_game;
};

}  // namespace naiad
