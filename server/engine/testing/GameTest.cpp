#include "engine/testing/GameTest.h"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Runner.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

/// Runs a game's main() on a thread of its own, in turns with the test's thread: one of the two always waits
/// for the other. So a test can be written from top to bottom, although main() does not return before the
/// game is over.
class GameThread : private Runner {
 public:
  /// Runs `game_main` with `world` as the current one, until it calls GM.run() or ends.
  GameThread(World& world, std::function<int()> game_main) : m_world(world) {
    world.setRunner(this);
    m_thread = std::thread([this, game_main = std::move(game_main)] {
      const World::Scope scope(m_world);
      try {
        game_main();
      } catch (const std::exception& error) {
        m_fault = error.what();
      } catch (...) {
        m_fault = "an exception of unknown type";
      }
      const std::lock_guard lock(m_mutex);
      m_main_ended = true;
      m_games_turn = false;
      m_turned.notify_all();
    });
    std::unique_lock lock(m_mutex);
    m_turned.wait(lock, [this] { return !m_games_turn; });
  }
  /// Makes GM.run() return whenever main() calls it, and waits for the end of main().
  ~GameThread() override {
    m_ending = true;
    if (m_in_run) finishRun();
    m_thread.join();
    m_world.setRunner(nullptr);
  }

  /// True while main() waits in GM.run().
  bool isRunning() const { return m_in_run; }
  /// True if main() ever called GM.run().
  bool hasRun() const { return m_has_run; }
  /// Lets GM.run() return, and main() continue to its next GM.run() or its end.
  void finishRun() {
    std::unique_lock lock(m_mutex);
    m_in_run = false;
    switchTo(true, lock);
  }
  /// Returns the text of the exception that main() threw; empty if it threw none.
  const std::string& fault() const { return m_fault; }

 private:
  void run(World& world) override {
    if (m_ending) return;
    if (m_has_run) world.setGameOver(false);  // as in a program, where the game follows the title
    std::unique_lock lock(m_mutex);
    m_in_run = m_has_run = true;
    switchTo(false, lock);
  }
  /// Lets the other thread run until it hands back control, or until main() ends. `game` is true for the
  /// game's thread, false for the test's.
  void switchTo(bool game, std::unique_lock<std::mutex>& lock) {
    m_games_turn = game;
    m_turned.notify_all();
    m_turned.wait(lock, [&] { return m_games_turn != game || (game && m_main_ended); });
  }

  World& m_world;
  std::mutex m_mutex;
  std::condition_variable m_turned;
  bool m_games_turn = true;
  bool m_in_run = false;
  bool m_has_run = false;
  bool m_main_ended = false;
  bool m_ending = false;
  std::string m_fault;
  std::thread m_thread;  // last: it uses the members above
};

namespace fs = std::filesystem;

/// Returns the path of a copy that no other process uses. The caller has to remove it.
fs::path copyOf(const fs::path& module) {
  std::string name = (fs::temp_directory_path() / (module.stem().string() + "-XXXXXX.so")).string();
  const int file = mkstemps(name.data(), 3);
  if (file < 0) throw std::runtime_error("Cannot create a copy of the game: " + name);
  close(file);
  fs::copy_file(module, name, fs::copy_options::overwrite_existing);
  return name;
}

void* load(const fs::path& module) {
  static std::set<fs::path> s_loaded;
  if (s_loaded.insert(module).second) return dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  const fs::path copy = copyOf(module);
  void* p_handle = dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL);
  std::error_code none;
  fs::remove(copy, none);
  return p_handle;
}

/// A game's module, loaded for one test.
class TestedModule {
 public:
  /// Loads the module: the first time in this process from its file, later from a temporary copy, because
  /// loading a file again gives the same module, with the variables of the previous game. Throws
  /// std::runtime_error.
  explicit TestedModule(const std::string& path) {
    const fs::path module = fs::absolute(path).lexically_normal();
    if (!fs::exists(module))
      throw std::runtime_error("The game " + module.string() + " does not exist: build it first.");
    void* p_handle = load(module);
    if (p_handle == nullptr) throw std::runtime_error(std::string("Cannot load the game: ") + dlerror());
    m_main = reinterpret_cast<Main>(dlsym(p_handle, "main"));
    if (m_main == nullptr) throw std::runtime_error("The game " + module.string() + " has no main().");
    m_name = module.stem().string();
    const fs::path folder = module.parent_path();
    m_folders = {(folder / m_name).string(), folder.string(), folder.parent_path().string()};
  }

  /// Runs the game's main(). The module stays loaded, because static Objects' destructors may still run.
  int main() const {
    std::string name = m_name;
    char* arguments[] = {name.data(), nullptr};
    return m_main(1, arguments);
  }
  /// Returns the folders in which to look for sprites and sounds: the folder of the game's name next to the
  /// module, the module's folder, and the folder above it.
  const std::vector<std::string>& folders() const { return m_folders; }

 private:
  using Main = int (*)(int, char**);
  std::string m_name;
  std::vector<std::string> m_folders;
  Main m_main = nullptr;
};

constexpr std::size_t kShownLogLines = 5;
constexpr Color kColors[] = {RED, GREEN, YELLOW, CYAN, MAGENTA, WHITE, BLUE};

int g_right = 0;  // expectations of all GameTests that were met
int g_wrong = 0;
int g_alive = 0;

/// Fails the test if the game calls exit(), which would end the test with the game's own exit code, mostly 0.
void refuseExit() {
  if (g_alive == 0) return;
  std::fputs("GameTest: the game called exit() during the test\n", stderr);
  std::fflush(nullptr);
  _exit(1);
}

void countAlive() {
  static const bool registered = std::atexit(refuseExit) == 0;
  if (registered) ++g_alive;
}

}  // namespace

/// A world and the game that runs in it.
class GameTest::Game {
 public:
  Game(std::optional<TestedModule> module, int (*p_main)(), std::uint64_t seed)
      : m_module(std::move(module)) {
    m_world.log().setSink([this](const std::string& line) { m_log.push_back(line); });
    m_world.setSeed(seed);
    m_world.store().setWatched(true);
    m_world.input().setGameOverLeaves(false);
    if (m_module) {
      for (const std::string& folder : m_module->folders()) m_world.extras().resources.addFolder(folder);
    }
    countAlive();
    m_thread.emplace(m_world, [this, p_main] { return m_module ? m_module->main() : p_main(); });
    m_scope.emplace(m_world);
    if (m_thread->hasRun()) return;
    const std::string fault = m_thread->fault();
    end();
    throw std::runtime_error(fault.empty() ? "The game's main() ended without having called GM.run()."
                                           : "The game's main() threw before GM.run(): " + fault);
  }
  ~Game() { end(); }

  World& world() { return m_world; }
  bool isRunning() const { return m_thread->isRunning(); }
  const std::vector<std::string>& log() const { return m_log; }
  int played(const std::string& label) const {
    const auto it = m_played.find(label);
    return it == m_played.end() ? 0 : it->second;
  }
  int ticks() const { return m_ticks; }
  std::uint32_t first() const { return m_first; }
  std::uint32_t joined(std::uint32_t player) {
    if (m_first == 0) m_first = player;
    return player;
  }

  /// Runs one tick. Returns false, without a tick, if the game is over.
  bool tick() {
    if (!isRunning()) return false;
    m_world.tick();
    ++m_ticks;
    for (const SoundPlayed& sound : m_world.picture().view().sounds) {
      if (sound.what == SoundPlayed::kPlay) ++m_played[sound.label];
    }
    if (m_world.isGameOver()) m_thread->finishRun();
    return true;
  }

 private:
  void end() {
    if (!m_thread) return;
    m_thread.reset();
    m_scope.reset();
    --g_alive;
  }

  std::optional<TestedModule> m_module;
  std::vector<std::string> m_log;
  std::map<std::string, int> m_played;
  int m_ticks = 0;
  std::uint32_t m_first = 0;
  World m_world;
  std::optional<World::Scope> m_scope;
  std::optional<GameThread> m_thread;
};

GameTest::GameTest(const std::string& module, std::uint64_t seed)
    : m_p_game(std::make_unique<Game>(TestedModule(module), nullptr, seed)) {}

GameTest::GameTest(int (*p_main)(), std::uint64_t seed)
    : m_p_game(std::make_unique<Game>(std::nullopt, p_main, seed)) {}

GameTest::~GameTest() = default;

std::uint32_t GameTest::join(const std::string& name) {
  World& world = m_p_game->world();
  const std::size_t number = world.views().getPlayers().size() + 1;
  const Color color = kColors[(number - 1) % std::size(kColors)];
  const std::uint32_t player =
      world.input().join(name.empty() ? "player " + std::to_string(number) : name, color);
  m_p_game->tick();
  return m_p_game->joined(player);
}

void GameTest::leave(std::uint32_t player) {
  m_p_game->world().input().leave(player != 0 ? player : m_p_game->first());
  m_p_game->tick();
}

int GameTest::tick(int count) {
  int passed = 0;
  while (passed < count && m_p_game->tick()) ++passed;
  return passed;
}

bool GameTest::tickUntil(const std::function<bool()>& holds, int most) {
  for (int i = 0; i < most; ++i) {
    if (holds()) return true;
    if (!m_p_game->tick()) break;
  }
  return holds();
}

int GameTest::getTicks() const {
  return m_p_game->ticks();
}

bool GameTest::isOver() const {
  return !m_p_game->isRunning();
}

void GameTest::addStoredScore(const std::string& table, const std::string& name, std::int64_t points) {
  m_p_game->world().input().push(
      {.kind = InputQueue::kScore, .player = 0, .name = name, .table = table, .points = points});
}

void GameTest::setRoom(const GameRoom& room) {
  m_p_game->world().input().push({.kind = InputQueue::kRoom, .player = 0, .room = room});
}

std::string GameTest::sentTo(std::uint32_t player) const {
  const std::uint32_t wanted = player != 0 ? player : m_p_game->first();
  for (const RoomTransfer& sent : m_p_game->world().extras().rooms.sent()) {
    if (sent.player == wanted) return sent.room;
  }
  return {};
}

void GameTest::press(Keyboard::Key key, std::uint32_t player) {
  down(key, player);
  up(key, player);
  tick();
}

void GameTest::hold(Keyboard::Key key, int ticks, std::uint32_t player) {
  down(key, player);
  tick();
  for (int i = 1; i < ticks; ++i) {
    m_p_game->world().input().key(player != 0 ? player : m_p_game->first(), key, KEY_DOWN);
    tick();
  }
  up(key, player);
}

void GameTest::down(Keyboard::Key key, std::uint32_t player) {
  m_p_game->world().input().key(player != 0 ? player : m_p_game->first(), key, KEY_PRESSED);
}

void GameTest::up(Keyboard::Key key, std::uint32_t player) {
  m_p_game->world().input().key(player != 0 ? player : m_p_game->first(), key, KEY_RELEASED);
}

void GameTest::click(int x, int y, Mouse::Button button, std::uint32_t player) {
  m_p_game->world().input().mouse(player != 0 ? player : m_p_game->first(), CLICKED, button, x, y);
  tick();
}

void GameTest::moveMouse(int x, int y, std::uint32_t player) {
  const std::uint32_t whose = player != 0 ? player : m_p_game->first();
  m_p_game->world().input().mouse(whose, MOVED, Mouse::UNDEFINED_MOUSE_BUTTON, x, y);
  tick();
}

std::string GameTest::picture(std::uint32_t player) const {
  return canvas(player).text();
}

Canvas GameTest::canvas(std::uint32_t player) const {
  return m_p_game->world().picture().renderPlayer(player != 0 ? player : m_p_game->first());
}

bool GameTest::shows(const std::string& text, std::uint32_t player) const {
  return count(text, player) > 0;
}

int GameTest::count(const std::string& text, std::uint32_t player) const {
  if (text.empty()) return 0;
  const std::string all = picture(player);
  int found = 0;
  for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + text.size()))
    ++found;
  return found;
}

char32_t GameTest::at(int x, int y, std::uint32_t player) const {
  return canvas(player).at(x, y).ch;
}

Color GameTest::colorAt(int x, int y, std::uint32_t player) const {
  return canvas(player).at(x, y).color;
}

int GameTest::objects(const std::string& type) const {
  return m_p_game->world().objects().objectsOfType(type).getCount();
}

Object* GameTest::find(const std::string& type) const {
  const ObjectList found = m_p_game->world().objects().objectsOfType(type);
  return found.isEmpty() ? nullptr : found[0];
}

int GameTest::score(std::uint32_t player) const {
  const Player* p_player = m_p_game->world().views().player(player != 0 ? player : m_p_game->first());
  return p_player != nullptr ? p_player->getScore() : 0;
}

int GameTest::played(const std::string& label) const {
  return m_p_game->played(label);
}

const std::vector<std::string>& GameTest::log() const {
  return m_p_game->log();
}

bool GameTest::expect(bool holds, const std::string& what, const char* p_file, int line) {
  if (holds) {
    ++g_right;
    return true;
  }
  ++g_wrong;
  std::fprintf(stderr, "%s:%d: check failed: %s\nThe picture after tick %d:\n%s", p_file, line, what.c_str(),
               getTicks(), picture().c_str());
  const std::vector<std::string>& lines = log();
  for (std::size_t i = lines.size() - std::min(lines.size(), kShownLogLines); i < lines.size(); ++i)
    std::fprintf(stderr, "log: %s\n", lines[i].c_str());
  return false;
}

bool GameTest::expectShows(const std::string& text, std::uint32_t player, const char* p_file, int line) {
  return expect(shows(text, player), "the picture shows \"" + text + "\"", p_file, line);
}

int GameTest::report() {
  if (g_right + g_wrong == 0) std::fputs("GameTest: the test checked nothing\n", stderr);
  std::printf("game test: %d passed, %d failed\n", g_right, g_wrong);
  return g_wrong == 0 && g_right > 0 ? 0 : 1;
}

}  // namespace df
