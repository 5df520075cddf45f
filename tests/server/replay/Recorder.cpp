#include "tests/server/replay/Recorder.h"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <vector>

#include "host/journal/DfrReader.h"
#include "host/rounds/RoundJournals.h"
#include "host/rounds/WorldFactory.h"
#include "host/settings/GameModule.h"
#include "shared/values/SplitMix64.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;
using Input = df::InputQueue::Input;

/// Random keys, clicks, joins and leaves.
class RandomInputs {
 public:
  RandomInputs(std::uint64_t seed, std::size_t most) : m_random(seed), m_most(most) {}

  void play(Round& world) {
    if (m_players.empty() || (m_players.size() < m_most && m_random.below(60) == 0)) {
      m_players.push_back(++m_last);
      world.addInput({.kind = df::InputQueue::kJoin,
                      .player = m_last,
                      .name = "bot" + std::to_string(m_last),
                      .color = static_cast<df::Color>(df::RED + m_last % 7)});
    } else if (m_players.size() > 1 && m_random.below(200) == 0) {
      world.addInput({.kind = df::InputQueue::kLeave, .player = m_players.front()});
      m_players.erase(m_players.begin());
    }
    for (const std::uint32_t player : m_players) press(world, player);
  }
  bool isEmpty() const { return m_players.empty(); }

 private:
  void press(Round& world, std::uint32_t player) {
    static constexpr df::Keyboard::Key kKeys[] = {
        df::Keyboard::SPACE,   df::Keyboard::W,      df::Keyboard::A,         df::Keyboard::S,
        df::Keyboard::D,       df::Keyboard::P,      df::Keyboard::LEFTARROW, df::Keyboard::RIGHTARROW,
        df::Keyboard::UPARROW, df::Keyboard::RETURN, df::Keyboard::DOWNARROW, df::Keyboard::N};
    if (m_random.below(4) == 0) {
      Input key{.kind = df::InputQueue::kKey, .player = player};
      key.key = kKeys[m_random.below(12)];
      key.key_action = static_cast<df::EventKeyboardAction>(m_random.below(3));
      world.addInput(key);
    }
    if (m_random.below(16) == 0) {
      Input mouse{.kind = df::InputQueue::kMouse, .player = player};
      mouse.mouse_action = static_cast<df::EventMouseAction>(m_random.below(3));
      mouse.button = df::Mouse::LEFT;
      mouse.x = static_cast<int>(m_random.below(80));
      mouse.y = static_cast<int>(m_random.below(24));
      world.addInput(mouse);
    }
  }

  SplitMix64 m_random;
  std::size_t m_most;
  std::uint32_t m_last = 0;
  std::vector<std::uint32_t> m_players;
};

/// Waits for a complete file. On a busy disk that may take longer than a server waits for it when it ends.
fs::path waitForFile(const fs::path& folder) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < end) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string bytes{std::istreambuf_iterator<char>(file), {}};
      DfrReader reader(bytes);
      while (reader.next()) continue;
      if (reader.end() == DfrEnd::kDone) return entry.path();
    }
    std::this_thread::yield();
  }
  throw std::runtime_error("the round is not written");
}

}  // namespace

fs::path Recorder::record(const Recording& what) {
  const std::string module = GameModule::find(what.game).string();
  const fs::path rounds = m_folder / ("seed-" + std::to_string(what.seed));
  HostOptions options;
  options.journal = rounds.string();
  options.seed = static_cast<std::int64_t>(what.seed);
  const auto launcher = launchReplay(options, module, NAIAD_BINARY_DIR "/dfserver", m_folder.string(), {});
  {
    const auto journals =
        RoundJournals::open(options, GameModule::nameOf(module), module, [](const LogEvent& /*event*/) {});
    asio::io_context home;
    const auto world = startWorlds(
        launcher, [](const LogEvent& /*event*/) {}, journals)(home);
    bool done = false;
    world->setOnTick([&done] { done = true; });
    RandomInputs inputs(what.seed, what.players);
    serveRound(home, *world, [&world] { return world->isReady(); });
    for (std::uint32_t i = 0; i < what.ticks && world->isReady(); ++i) {
      if (what.players > 0) inputs.play(*world);
      done = false;
      world->tick(!inputs.isEmpty(), false);
      serveRound(home, *world, [&done] { return done; });
    }
  }
  return waitForFile(rounds);
}

}  // namespace naiad
