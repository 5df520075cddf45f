// Writes the file and facts of each round of a server's worlds, and recovers a killed server's round.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/journal/DeterminismCheck.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/UnfinishedRound.h"
#include "host/rounds/Round.h"
#include "host/settings/HostOptions.h"
#include "host/world/Determinism.h"
#include "host/world/WorldProcess.h"
#include "shared/program/LineLog.h"

namespace naiad {

// Help for the authors of games that crashed.

/// Returns the command "dfreplay FILE --until TICK --debug", with --game if `game` is not the name of an
/// installed game, or names another one than `module` (both as of GameModule).
std::string debugCommand(const std::string& file, std::uint32_t tick, const std::string& game,
                         const std::filesystem::path& module);

/// Returns `text` as one word of a shell command, quoted if necessary.
std::string shellWord(const std::string& text);

/// Rounds that the previous program of this process left open for this one: the uuid of each, and the hash of
/// the module that replayed it with equal answers.
using HandedOverRounds = std::map<std::string, std::string>;

/// Returns the rounds that the previous program announced by RoundJournals::exportHandedOverRounds(), once.
HandedOverRounds importHandedOverRounds();

/// State shared by the journals of a server's rooms (openRoomJournals).
struct SharedJournals {
  std::shared_ptr<JournalWriter> writer = std::make_shared<JournalWriter>();
  std::set<std::string> checked = {};  ///< games of which a DeterminismCheck has begun
  HandedOverRounds kept = importHandedOverRounds();
};

class RoundJournals {
 public:
  /// Null if the options disable journals. `module`: the game's path; empty if this program is the game.
  static std::shared_ptr<RoundJournals> open(const HostOptions& options, const std::string& game,
                                             const std::string& module, const LogLine& log);

  using NewWorld = std::function<std::unique_ptr<WorldProcess>()>;

  /// `p_shared`: state shared with the journals of other rooms; null: there are no others.
  RoundJournals(const HostOptions& options, std::string game, const std::string& module, LogLine log,
                std::shared_ptr<SharedJournals> p_shared = nullptr);

  /// Returns the options for a world of a new round.
  WorldStartOptions makeStartOptions() const;
  /// Returns the options for a world that resumes a killed server's round; nullopt if there is no such round.
  std::optional<WorldStartOptions> resumeOptions() const;
  /// Returns the resumed round, whose `world` first gets the recorded turns; null if it cannot be recorded
  /// or too many attempts failed. `another` starts a world that takes over from one that crashed or hangs.
  std::unique_ptr<Round> resumeRound(std::unique_ptr<WorldProcess> world, NewWorld another);
  /// Returns a new round of `world`, recorded unless the log says that this fails. `again` starts a second
  /// world from `order`, with which the first round of each game is compared. `another` starts a world that
  /// takes over from one that crashed or hangs.
  std::unique_ptr<Round> recordWorld(std::unique_ptr<WorldProcess> world, const WorldStartOptions& order,
                                     DeterminismCheck::NewWorld again = {}, NewWorld another = {});

  // Handover of the round to another program (RoundHandover.h).

  /// A round that is being played and recorded.
  struct CurrentRound {
    std::string uuid;
    std::string file;
    std::uint64_t start_nanos = 0;  ///< start time, since 1970 in UTC
  };
  /// Returns the current round; nullopt if none is being recorded.
  std::optional<CurrentRound> currentRound() const;
  /// Returns why rounds of this game cannot be handed over, as the rest of a sentence; empty if they can.
  std::string handoverBlocker() const;
  /// Returns the path of the game's module; empty: the game is a program of its own.
  const std::string& module() const { return m_module; }
  /// Waits until everything added is on the disk, at most `most`. Returns true if it is. Any thread.
  bool sync(std::chrono::milliseconds most) { return m_shared->writer->drain(most); }
  /// Leaves the journal as a killed server would. From now on nothing is recorded.
  void suspend();
  /// Announces `rounds`, in the environment, to the program that this process runs next. The module with a
  /// round's hash (hashOfModule) has replayed the round with equal answers, so it may resume it.
  static void exportHandedOverRounds(const HandedOverRounds& rounds);

 private:
  bool isHandedOver(const UnfinishedRound& round) const;
  void beginWriting(const std::shared_ptr<Journal>& journal, const std::string& file);
  void findRound(const HostOptions& options);
  std::string pathOf(const DfrHeader& header) const;
  std::shared_ptr<Journal> resumeJournal(UnfinishedRound& round) const;
  Round::JournalBinding makeBinding(const std::string& path, const WorldProcess& world) const;

  const std::string m_folder;
  const bool m_of_room;  ///< true: the folder is a room's, in that of --journal
  const std::string m_game;
  const std::string m_module;  ///< the module's path; empty: the game is a program
  const std::int64_t m_seed;
  const std::uint64_t m_frame_nanos;
  const std::size_t m_ring;
  DfrFacts m_facts;
  LogLine m_log;
  std::weak_ptr<Journal> m_current;
  std::string m_current_file;
  bool m_is_private = false;  ///< each player has a round of their own; no copies: too many processes
  bool m_recovers = true;
  /// False once a round of this game was found not to be repeatable.
  std::shared_ptr<bool> m_is_deterministic = std::make_shared<bool>(true);
  std::unique_ptr<UnfinishedRound> m_open;  ///< the round to resume
  std::shared_ptr<SharedJournals> m_shared;
};

/// Returns the round in which a server with this folder was killed, if this server can resume it: game,
/// settings and port are as in `expected`; otherwise null. Adds a line to `said` for each file that cannot be
/// read and each open round of this port that is not resumed, up to the newest round of this game, and for
/// ticks that the resumed round has lost. `kept`: rounds that another version of the game may have begun.
std::unique_ptr<UnfinishedRound> findUnfinishedRound(const std::string& folder, const DfrFacts& expected,
                                                     std::uint64_t frame_nanos,
                                                     std::vector<std::string>& said,
                                                     const HandedOverRounds& kept = {});

/// Returns the hash of a file by which a round identifies its game; empty if the file cannot be read.
std::string hashOfModule(const std::string& path);

/// Returns the kernel version and the build ids of libraries, on which memory addresses depend.
DfrFacts factsOfMachine();

/// Maximum size of the game's settings, in bytes; a longer file is not recorded.
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
inline constexpr const char* kFactPort = "port";            ///< the server's port
inline constexpr const char* kFactFirstTick =
    "first_tick";  ///< number of the round's first tick in the server's log
inline constexpr const char* kFactRepeatable = "repeatable";  ///< "no": a second world answered differently
inline constexpr const char* kFactAttempts =
    "attempts";  ///< number of attempts to resume the round, and number of its turns at the last one
inline constexpr const char* kFactFile = "file ";  ///< a file's name follows; the fact is its hash
inline constexpr const char* kFactVariable =
    "variable ";  ///< a variable's name follows; the fact is its value

}  // namespace naiad
