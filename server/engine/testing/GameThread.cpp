#include "engine/testing/GameThread.h"

#include <exception>
#include <utility>

namespace df {

GameThread::GameThread(World& world, std::function<int()> game_main) : m_world(world) {
  world.setRunner(this);
  m_thread = std::thread([this, game_main = std::move(game_main)] {
    const World::Scope scope(m_world);
    try {
      game_main();
    } catch (const std::exception& error) {
      m_fault = error.what();
    } catch (...) {
      m_fault = "something that is no std::exception";
    }
    const std::lock_guard lock(m_mutex);
    m_main_ended = true;
    m_games_turn = false;
    m_turned.notify_all();
  });
  std::unique_lock lock(m_mutex);
  m_turned.wait(lock, [this] { return !m_games_turn; });
}

GameThread::~GameThread() {
  m_ending = true;
  if (m_in_run) finishRun();
  m_thread.join();
  m_world.setRunner(nullptr);
}

void GameThread::handTo(bool game, std::unique_lock<std::mutex>& lock) {
  m_games_turn = game;
  m_turned.notify_all();
  m_turned.wait(lock, [&] { return m_games_turn != game || (game && m_main_ended); });
}

void GameThread::finishRun() {
  std::unique_lock lock(m_mutex);
  m_in_run = false;
  handTo(true, lock);
}

void GameThread::run(World& world) {
  if (m_ending) return;
  if (m_has_run) world.setGameOver(false);  // as in a program: after the title comes the game
  std::unique_lock lock(m_mutex);
  m_in_run = m_has_run = true;
  handTo(false, lock);
}

}  // namespace df
