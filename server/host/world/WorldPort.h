// A world as the owner of its round sees it (Round.h): a turn down, tick by tick a WorldView up.
//
// Two kinds: the world of this process (WorldInProcess.h), which ticks while it is called, and one in a
// process of its own (WorldProcess.h), which answers later, and may crash or hang.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/world/TurnRecord.h"
#include "host/world/WorldMessages.h"

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

class WorldPort {
 public:
  virtual ~WorldPort() = default;

  /// Called at the end of every tick: from tick(), or later from the host's event loop.
  void setOnTick(std::function<void()> on_tick) { m_on_tick = std::move(on_tick); }

  /// May a tick begin?
  virtual bool isReady() const = 0;
  /// Begin one. The view that a watched turn asks for has every Object as changed the first time.
  virtual void tick(const SentTurn& turn) = 0;
  /// The number of the next tick to begin, by which view() counts.
  virtual std::uint32_t nextTick() const = 0;
  /// Before its first tick: the numbers by which it counts for itself are lower by so much.
  virtual std::uint32_t ticksBefore() const { return nextTick() - 1; }
  /// So many may be begun before the first of them has ended, once the world has ended one.
  virtual std::uint32_t turnsAhead() const { return 1; }

  // Of the last tick.

  /// What it changed, if it was watched. Valid until the next one begins.
  virtual const df::WorldView& view() const = 0;
  /// What else came of it; whoever takes something out has it. Of players to be moved to other rooms only
  /// lengths are checked: a player may be in another world, and a room may not exist.
  WorldAnswer& answer() { return m_answer; }
  const WorldAnswer& answer() const { return m_answer; }
  /// These models have been published for it: for games that use lag compensation.
  virtual void notePublished(const Publisher& /*publisher*/) {}

  // Its end.

  /// Look after the world's process. Once in each tick of the host, ready or not; `tick` is its number.
  virtual void checkProcess(std::uint32_t /*tick*/) {}
  /// How it ended; nothing while it lives.
  virtual std::optional<WorldEnd> end() const { return {}; }
  /// Ends the world; end() tells when it has ended. `rest`: the turn that will not be played. A world in this
  /// process, which may outlive its round, gets its inputs in its next tick.
  virtual void close(const WorldTurn& /*rest*/) {}

 protected:
  void reportTick() {
    if (m_on_tick) m_on_tick();
  }

  WorldAnswer m_answer;

 private:
  std::function<void()> m_on_tick;
};

}  // namespace naiad
