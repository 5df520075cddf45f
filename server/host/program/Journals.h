// The journals of a server's worlds: what is said of each round beside its turns, and where its file is.
#pragma once

#include <memory>
#include <string>

#include "host/journal/JournaledWorld.h"
#include "host/program/HostOptions.h"
#include "host/world/WorldOrder.h"
#include "host/world/WorldProcess.h"
#include "shared/program/LineLog.h"

namespace naiad {

class Journals {
 public:
  /// Null if the options want none. `module`: the game's path; empty for a game that is this program itself.
  static std::shared_ptr<Journals> open(const HostOptions& options, const std::string& game,
                                        const std::string& module, const LogLine& log);

  Journals(const HostOptions& options, std::string game, const std::string& module, LogLine log);

  /// For the next world.
  WorldOrder makeOrder() const;
  /// That world, its turns written down. If they cannot be, the log says so, and it plays without. `again`
  /// starts another one from the same order: the first round of this server is held against it.
  std::unique_ptr<WorldPort> keep(std::unique_ptr<WorldProcess> world, const WorldOrder& order,
                                  RepeatCheck::NewWorld again = {});

 private:
  std::string pathOf(const DfrHeader& header) const;

  const std::string m_folder;
  const std::string m_game;
  const std::int64_t m_seed;
  const std::uint64_t m_frame_nanos;
  const std::size_t m_ring;
  DfrFacts m_facts;
  LogLine m_log;
  bool m_checked = false;  ///< a round has been, or is
  std::shared_ptr<JournalWriter> m_writer = std::make_shared<JournalWriter>();
};

/// The hash of a file by which a round says which game it was; empty if it cannot be read.
std::string hashOfModule(const std::string& path);

/// "name=hash" of build ids: this library's, and those of the C library and the kernel, which decide where
/// memory lies.
DfrFacts factsOfMachine();

/// The text of the game's settings, if there is such a file and it is of a sensible length.
inline constexpr std::size_t kMaxSettings = kMaxDfrValue;

// Names of facts.
inline constexpr const char* kFactGame = "game";
inline constexpr const char* kFactModule = "module_sha256";  ///< missing: the game was a program
inline constexpr const char* kFactVersion = "naiad";
inline constexpr const char* kFactPlayers = "players";
inline constexpr const char* kFactGameOver = "on_game_over";
inline constexpr const char* kFactAddresses = "addresses";  ///< "fixed" or "random"
inline constexpr const char* kFactClocks = "clocks";        ///< "repeatable" or "real"
inline constexpr const char* kFactSettings = "settings";    ///< the text of df-config.txt
inline constexpr const char* kFactFile = "file ";          ///< and its name: the hash of a file that was read
inline constexpr const char* kFactVariable = "variable ";  ///< and its name: its value

}  // namespace naiad
