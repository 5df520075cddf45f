// The journals of a server's worlds: what is said of each round beside its turns, and where its file is.
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

#include "host/journal/JournalWriter.h"
#include "host/journal/OpenRound.h"
#include "host/journal/RepeatCheck.h"
#include "host/rounds/Round.h"
#include "host/settings/HostOptions.h"
#include "host/world/Repeatable.h"
#include "host/world/WorldProcess.h"
#include "shared/program/LineLog.h"

namespace naiad {

// How an author sees where a game of theirs died.

/// What to type in a shell: "dfreplay FILE --until TICK --debug", with --game where `game` is the name of no
/// installed game, or of another one than `module` (both as of GameModule).
std::string debugCommand(const std::string& file, std::uint32_t tick, const std::string& game,
                         const std::filesystem::path& module);

/// One word of a shell's line.
std::string shellWord(const std::string& text);

/// Rounds that a program which this process ran before has left open for this one: the uuid of each, and the
/// hash of the module that has executed it again, to the same answers.
using KeptRounds = std::map<std::string, std::string>;

/// What Journals::announceKept() has said, once.
KeptRounds takeKeptRounds();

/// What the journals of a server's rooms have in common (openRoomJournals).
struct SharedJournals {
  std::shared_ptr<JournalWriter> writer = std::make_shared<JournalWriter>();
  std::set<std::string> checked = {};  ///< games of which a round has been held against another, or is
  KeptRounds kept = takeKeptRounds();
};

class Journals {
 public:
  /// Null if the options want none. `module`: the game's path; empty for a game that is this program itself.
  static std::shared_ptr<Journals> open(const HostOptions& options, const std::string& game,
                                        const std::string& module, const LogLine& log);

  using NewWorld = std::function<std::unique_ptr<WorldProcess>()>;

  /// `p_shared`: with the journals of other rooms; null: there are none.
  Journals(const HostOptions& options, std::string game, const std::string& module, LogLine log,
           std::shared_ptr<SharedJournals> p_shared = nullptr);

  /// For the next world.
  WorldOrder makeOrder() const;
  /// For the world that goes on with the round of a server that was killed; nothing: there is no such round,
  /// or it has been begun.
  std::optional<WorldOrder> orderOfOpenRound() const;
  /// The highest id that a player of that round ever had (OpenRound::highestPlayer()); 0: there is no such
  /// round.
  std::uint32_t highestPlayer() const;
  /// The round of that world, which first gets the turns of the one before; null: it cannot be written down.
  std::unique_ptr<Round> goOn(std::unique_ptr<WorldProcess> world, NewWorld another);
  /// The round of that world, written down. If they cannot be, the log says so, and it plays without. `again`
  /// starts another one from the same order: the first round of this server is held against it. `another`
  /// starts one that takes over from a world that crashed or hangs.
  std::unique_ptr<Round> keep(std::unique_ptr<WorldProcess> world, const WorldOrder& order,
                              RepeatCheck::NewWorld again = {}, NewWorld another = {});

  // For a program that goes on with the round in this one's place (RoundHandover.h).

  /// A round that is being played and written down.
  struct CurrentRound {
    std::string uuid;
    std::string file;
    std::uint64_t start_nanos = 0;  ///< since 1970
  };
  /// Nothing: none is.
  std::optional<CurrentRound> currentRound() const;
  /// Why its rounds cannot go on elsewhere, as the rest of a sentence; empty: they can, if there are any.
  std::string whyNotKept() const;
  /// The path of the game's module; empty: it is a program of its own.
  const std::string& module() const { return m_module; }
  /// Wait until all that was added is on the disk, or for so long. Return whether it is. From any thread.
  bool sync(std::chrono::milliseconds most) { return m_shared->writer->drain(most); }
  /// Its journal is left as by a server that was killed. From now on nothing is written down.
  void leaveOpen();
  /// Say in the environment of the program that this process runs next that these rounds were executed again
  /// by modules with these hashes (hashOfModule), and were the same: what those were before does not count.
  static void announceKept(const KeptRounds& rounds);

 private:
  bool isKept(const OpenRound& round) const;
  void noteCurrent(const std::shared_ptr<Journal>& journal, const std::string& file);
  void findRound(const HostOptions& options);
  std::string pathOf(const DfrHeader& header) const;
  std::shared_ptr<Journal> goOnWriting(OpenRound& round) const;
  Round::Book makeBook(const std::string& path, const WorldProcess& world) const;

  const std::string m_folder;
  const bool m_of_room;  ///< the folder is a room's, in that of --journal
  const std::string m_game;
  const std::string m_module;  ///< path; empty: a game that is a program
  const std::int64_t m_seed;
  const std::uint64_t m_frame_nanos;
  const std::size_t m_ring;
  const bool m_copies;  ///< of worlds: three processes for each are too many where each player has one
  DfrFacts m_facts;
  LogLine m_log;
  std::weak_ptr<Journal> m_current;
  std::string m_current_file;
  bool m_is_private = false;  ///< each player has a round of their own
  bool m_recovers = true;
  std::shared_ptr<bool> m_repeats = std::make_shared<bool>(true);  ///< the current round, as far as is known
  std::unique_ptr<OpenRound> m_open;                               ///< to go on with
  std::shared_ptr<SharedJournals> m_shared;
};

/// The round that a server of this folder was killed in, if this one can go on with it: the same game with
/// the same settings, on the same port, by `expected` facts. Else null, and `said` has why, if there is one.
/// `kept`: rounds for which the game may be another version than it was.
std::unique_ptr<OpenRound> findOpenRound(const std::string& folder, const DfrFacts& expected,
                                         std::uint64_t frame_nanos, std::string& said,
                                         const KeptRounds& kept = {});

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
inline constexpr const char* kFactAddresses = "addresses";    ///< "fixed" or "random"
inline constexpr const char* kFactClocks = "clocks";          ///< "repeatable" or "real"
inline constexpr const char* kFactSettings = "settings";      ///< the text of df-config.txt
inline constexpr const char* kFactPort = "port";              ///< that players joined by
inline constexpr const char* kFactFirstTick = "first_tick";   ///< by which the server's log and players count
inline constexpr const char* kFactRepeatable = "repeatable";  ///< "no": a second world answered otherwise
inline constexpr const char* kFactAttempts = "attempts";      ///< to go on with it, and behind how many turns
inline constexpr const char* kFactFile = "file ";          ///< and its name: the hash of a file that was read
inline constexpr const char* kFactVariable = "variable ";  ///< and its name: its value

}  // namespace naiad
