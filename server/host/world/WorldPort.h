// The world that a room plays in, as the host sees it: inputs down, tick by tick a WorldView up.
//
// Two kinds: the world of this process (WorldInProcess.h), which ticks while it is called, and one in a
// process of its own (WorldProcess.h), which answers later, and may crash or hang.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/world/InputQueue.h"
#include "engine/world/RoomTable.h"
#include "engine/world/ScoreTables.h"
#include "engine/world/WorldView.h"
#include "host/world/KeptSession.h"
#include "shared/values/Canvas.h"

namespace naiad {

class Publisher;

/// How a world ended.
struct WorldEnd {
  enum Why : std::uint8_t {
    kGameOver,      ///< the game said so, or its process ended in order
    kCrashed,       ///< a signal or an error code
    kHung,          ///< it did not answer in time
    kBroken,        ///< it sent a malformed frame
    kNotRecovered,  ///< a round of a server that was killed could not be executed again
    kForeign,       ///< it is of another build than the host, which was upgraded meanwhile
  } why = kGameOver;
  std::string text = {};  ///< for the log and for players, like "crashed (SIGABRT)"
  int exit_code = 0;      ///< of kCrashed, unless it was a signal
  /// For the log, of a failure: "in tick 17, while Ship handled EventStep", "after tick 17"; empty before the
  /// first.
  std::string when = {};
  std::vector<std::string> last_lines = {};  ///< of the game's log, of a failure; escaped
};

/// A round that is written down.
struct RoundName {
  std::string id;    ///< 32 hexadecimal digits that no other round has; empty: it is not written down
  std::string file;  ///< its recording, from the folder of --journal
};

/// Another world goes on in place of one that died.
struct TakeOver {
  bool by_copy = false;     ///< else it has executed the whole round
  std::uint32_t ticks = 0;  ///< that it has executed again
};

class WorldPort {
 public:
  virtual ~WorldPort() = default;

  /// Called at the end of every tick: from tick(), or later from the host's event loop.
  void setOnTick(std::function<void()> on_tick) { m_on_tick = std::move(on_tick); }

  // Input, in the order it came. It counts from nextTick() on.

  /// Return the player's id: that of the input, but for a join the next free one if the world has had that
  /// one.
  virtual std::uint32_t addInput(df::InputQueue::Input input) = 0;
  /// From the next tick on only this player's input comes; 0: all players'.
  virtual void setHeard(std::uint32_t player) = 0;
  /// The game is to be over at the end of the next tick.
  virtual void endGame() = 0;

  // Ticks.

  /// May a tick begin?
  virtual bool isReady() const = 0;
  /// Where `truth` is asked for, only this player's picture is; 0: all of them are.
  virtual void setPictured(std::uint32_t /*player*/) {}
  /// Hash what the next tick answers; after it answerHash() and, if `state`, stateHash() say the result. For
  /// journals.
  virtual void setChecked(bool /*state*/) {}
  /// A hash of all that the last tick answered; 0: there is none.
  virtual std::uint64_t answerHash() const { return 0; }
  /// df::hashState() after the last tick, if setChecked() asked for it before.
  virtual std::optional<std::uint64_t> stateHash() const { return std::nullopt; }
  /// Begin one. `watched`: view() is wanted; the first time with every Object as changed. `truth`:
  /// renderPlayer() is, too.
  virtual void tick(bool watched, bool truth) = 0;
  /// The number of the next tick to begin, by which view() counts.
  virtual std::uint32_t nextTick() const = 0;
  /// What the last watched tick changed. Valid until the next one begins.
  virtual const df::WorldView& view() const = 0;
  /// These models have been published for the last tick: for games that use lag compensation.
  virtual void notePublished(const Publisher& publisher) = 0;
  /// The players who wanted to leave since the last call.
  virtual std::vector<std::uint32_t> takeLeavers() = 0;
  /// The scores that the game added in the last tick, in that order.
  virtual std::vector<df::AddedScore> takeScores() = 0;
  /// What the game asked for in the last tick: players to be moved to other rooms. Only lengths are checked:
  /// a player may be in another world, and a room may not exist.
  virtual std::vector<df::SentPlayer> takeSent() { return {}; }
  virtual bool isGameOver() const = 0;
  /// What this player sees, as the engine drew it in the last tick.
  virtual df::Canvas renderPlayer(std::uint32_t player) const = 0;

  virtual RoundName roundName() const { return {}; }

  // A round of a server that was killed, which is executed again until it is where it was.

  /// So many ticks may be begun before the first of them has ended, once the world has ended one.
  virtual std::uint32_t turnsAhead() const { return 1; }
  /// How far that is, in percent; nothing: there is no such round, or its sessions have been taken.
  virtual std::optional<int> recovering() const { return std::nullopt; }
  /// Once, when recovering() has come to its end: the sessions that its players had.
  virtual std::optional<std::vector<KeptSession>> takeSessions() { return std::nullopt; }
  /// A player's session is so from now on: for journals, before its client can know.
  virtual void noteSession(const KeptSession& /*session*/) {}

  // Its end.

  /// Look after the world's process. Once in each tick of the host, ready or not; `tick` is its number.
  virtual void checkProcess(std::uint32_t /*tick*/) {}
  /// How it ended; nothing while it lives.
  virtual std::optional<WorldEnd> end() const { return std::nullopt; }
  /// A line for the log, once: the tick does not end.
  virtual std::optional<std::string> takeWarning() { return std::nullopt; }
  /// Let it come to its end; end() says when it has.
  virtual void close() {}

  // Copies of a world's process: one goes on where the world has crashed or hangs.

  /// Keep a copy of the world as it is after the next tick, beside the one before. False: there will be none.
  virtual bool keepCopy() { return false; }
  /// Why there are none any more, once, in words.
  virtual std::optional<std::string> takeCopyProblem() { return std::nullopt; }
  /// That its process has taken, of all processors; 0: unknown.
  virtual std::chrono::nanoseconds cpuTime() const { return {}; }
  /// After end(): the newest copy is the world from now on, as it was after its tick: return how many it has
  /// had since the world's first. What it prints is dropped until endRepetition(). Nothing: there is none
  /// left, and no process of the world is.
  virtual std::optional<std::uint32_t> goOnWithCopy() { return std::nullopt; }
  virtual void endRepetition() {}
  /// It is not to go on: it ends as one that crashed.
  virtual void giveUp(const std::string& /*why*/) {}
  /// Once, when another world has taken over from one that died.
  virtual std::optional<TakeOver> takeTakeOver() { return std::nullopt; }

 protected:
  void reportTick() {
    if (m_on_tick) m_on_tick();
  }

 private:
  std::function<void()> m_on_tick;
};

}  // namespace naiad
