// A world as seen by the owner of its round (Round.h): it gets a turn for each tick, and returns a WorldView.
//
// There are two kinds: the world of this process (WorldInProcess.h), which ticks during the call, and one in
// a process of its own (WorldProcess.h), which answers later, and may crash or hang.
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

/// The end of a world and its reason.
struct WorldEnd {
  enum Why : std::uint8_t {
    kGameOver,      ///< the game ended, or its process exited normally
    kCrashed,       ///< its process ended by a signal or with an error code, or could not be started
    kHung,          ///< it did not start or answer in time
    kBroken,        ///< it sent a malformed or unexpected frame, or got too many inputs in a tick
    kNotRecovered,  ///< the round of a killed server could not be replayed
    kForeign,       ///< it has another build than the host: its files were upgraded
  } why = kGameOver;
  std::string text = {};  ///< reason for the log and for players, like "crashed (SIGABRT)"
  int exit_code = 0;      ///< the exit code of a kCrashed world, unless a signal ended it
  /// Time of a failure, for the log: "in tick 17, while Ship handled EventStep" or "after tick 17"; empty
  /// before the first tick.
  std::string when = {};
  std::vector<std::string> last_lines = {};  ///< last lines of the game's log before a failure; escaped
};

class WorldPort {
 public:
  virtual ~WorldPort() = default;

  /// Sets a function called at the end of every tick: from tick(), or later from the host's event loop.
  void setOnTick(std::function<void()> on_tick) { m_on_tick = std::move(on_tick); }

  /// True if a tick may begin.
  virtual bool isReady() const = 0;
  /// Begins a tick. In the first view after turns without a view, every Object counts as changed.
  virtual void tick(const SentTurn& turn) = 0;
  /// Returns the number of the next tick to begin, in the numbers of view().
  virtual std::uint32_t nextTick() const = 0;
  /// Returns the tick number minus the world's own count of ticks. Call before the world's first tick.
  virtual std::uint32_t ticksBefore() const { return nextTick() - 1; }
  /// Returns how many ticks may be in progress at once after the world's first tick has ended. Until then,
  /// the caller may begin only one.
  virtual std::uint32_t turnsAhead() const { return 1; }

  // Results of the last tick.

  /// Returns the changes of the tick, if it was watched. Valid until the next tick begins.
  virtual const df::WorldView& view() const = 0;
  /// Returns the other results, which callers may move out. Of moves to other rooms, only the length of
  /// the room's name is checked: the player may be in another world, and the room may not exist.
  WorldAnswer& answer() { return m_answer; }
  const WorldAnswer& answer() const { return m_answer; }
  /// Passes on the models published for the tick, for games that use lag compensation.
  virtual void onPublished(const Publisher& /*publisher*/) {}

  // The world's end.

  /// Checks the world's process. Call once in each tick of the host, ready or not; `tick` is its number.
  virtual void checkProcess(std::uint32_t /*tick*/) {}
  /// Returns how the world ended; nullopt while it lives.
  virtual std::optional<WorldEnd> end() const { return {}; }
  /// Begins to end the world; end() returns a value when it has ended. `rest`: the turn that is not played. A
  /// world in this process, which may outlive its round, gets the inputs of `rest` in its next tick.
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
