// Runs a game's main() on a thread of its own, in turns with the thread that made it: one of the two always
// waits for the other. So a test can be written from top to bottom, though main() does not return before the
// game is over.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "engine/world/Runner.h"
#include "engine/world/World.h"

namespace df {

class GameThread : private Runner {
 public:
  /// Run `game_main` with `world` as the current one, until it calls GM.run() or ends.
  GameThread(World& world, std::function<int()> game_main);
  /// Have every run() return, and wait for the end of main().
  ~GameThread() override;
  GameThread(const GameThread&) = delete;
  GameThread& operator=(const GameThread&) = delete;

  /// Does main() wait in GM.run()?
  bool isRunning() const { return m_in_run; }
  /// Did it get there at all?
  bool hasRun() const { return m_has_run; }
  /// Let GM.run() return, and main() go on to its next GM.run() or its end.
  void finishRun();
  /// What main() threw; empty if nothing.
  const std::string& fault() const { return m_fault; }

 private:
  void run(World& world) override;
  /// Let the other side go on, until it hands back.
  void handTo(bool game, std::unique_lock<std::mutex>& lock);

  World& m_world;
  std::mutex m_mutex;
  std::condition_variable m_turned;
  bool m_games_turn = true;
  bool m_in_run = false;
  bool m_has_run = false;
  bool m_main_ended = false;
  bool m_ending = false;
  std::string m_fault;
  std::thread m_thread;  // last: it uses what stands above
};

}  // namespace df
