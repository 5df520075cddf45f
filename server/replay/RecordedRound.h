// The file of a recorded round, and the game with which it is replayed.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/journal/DfrReader.h"
#include "host/world/WorldLauncher.h"

namespace naiad {

/// Error of a round that cannot be read or replayed. what() is a sentence.
class RoundError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class RecordedRound {
 public:
  /// Reads the whole file. Throws RoundError.
  explicit RecordedRound(const std::filesystem::path& path);

  const DfrHeader& header() const { return m_header; }
  const DfrFacts& facts() const { return m_facts; }
  /// Returns a fact; empty if the file does not have it.
  std::string fact(const std::string& name) const;
  /// Returns a reader at the beginning of the file. This object must outlive the reader.
  std::unique_ptr<DfrReader> read() const;
  /// Returns warnings about the recording, as sentences, for example that its clocks were real.
  std::vector<std::string> warnings() const;

 private:
  std::string m_bytes;
  DfrHeader m_header;
  DfrFacts m_facts;
};

/// Finds the game of a round and starts its worlds, in a folder of their own that the destructor removes.
class ReplayEnvironment {
 public:
  /// `game`: a name or path from the user. If empty, uses the installed game that the file names, if its
  /// module is unchanged. Throws RoundError or std::system_error.
  ReplayEnvironment(const RecordedRound& round, const std::string& game);
  ~ReplayEnvironment();
  ReplayEnvironment(const ReplayEnvironment&) = delete;
  ReplayEnvironment& operator=(const ReplayEnvironment&) = delete;

  const WorldLauncher& launcher() const { return *m_launcher; }
  WorldStartOptions order() const;
  /// Returns sentences on how the game and this machine differ from the recorded ones.
  const std::vector<std::string>& warnings() const { return m_warnings; }

 private:
  std::string findModule(const std::string& game);
  void findDifferences();

  const RecordedRound& m_round;
  std::filesystem::path m_folder;
  std::vector<std::string> m_warnings;
  std::shared_ptr<const WorldLauncher> m_launcher;
};

}  // namespace naiad
