// The scene as a game for dfserver. The crowd consists of Objects, which the engine moves between their
// decisions.
//
// Environment: NAIAD_SCENE_TRUTH names the file for the Truth, NAIAD_SCENE_SEED the crowd. Both are needed.
#include <cassert>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "../Monotonic.h"
#include "../SharedFile.h"
#include "Controls.h"
#include "Crowd.h"
#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "Status.h"
#include "Truth.h"
#include "WorldManager.h"

namespace {

using namespace bench::path;

constexpr std::uint32_t kCounterText = 0;
constexpr std::uint32_t kEchoText = 1;

double cells(int units) {
  return static_cast<double>(units) / kUnits;
}

/// A walker of the crowd.
class Figure : public df::Object {
 public:
  /// Places the Object where the walker was `moves` moves ago.
  Figure(const Walker& walker, int moves) {
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(cells(walker.x - moves * walker.vx), cells(walker.y - moves * walker.vy)));
    follow(walker);
  }
  /// Adopts the walker's decisions of this tick; the world does the move.
  void follow(const Walker& walker) {
    if (walker.ch != m_walker.ch) setStaticLook();  // makes the engine call draw() again
    if (walker.vx != m_walker.vx || walker.vy != m_walker.vy) {
      setVelocity(df::Vector(cells(walker.vx), cells(walker.vy)));
    }
    m_walker = walker;
  }
  /// True if the world has moved this Object like the crowd its walker. Call before the next decision.
  bool isInStep() const { return getPosition() == df::Vector(cells(m_walker.x), cells(m_walker.y)); }

  int draw() override {
    return DM.drawCh(getPosition(), m_walker.ch, static_cast<df::Color>(m_walker.color));
  }

 private:
  Walker m_walker;
};

/// Moved by the player with the arrow keys: right, down, left, up, and so on.
class Marker : public df::Object {
 public:
  Marker() {
    setSolidness(df::SPECTRAL);
    setAltitude(df::MAX_ALTITUDE);
    setPosition(df::Vector(kMarkerColumn, kMarkerRow));
  }
  void step(df::Keyboard::Key key) {
    using namespace df::Keyboard;
    const int x = (key == RIGHTARROW) - (key == LEFTARROW);
    const int y = (key == DOWNARROW) - (key == UPARROW);
    WM.moveObject(this, getPosition() + df::Vector(x, y));
  }
  int draw() override { return DM.drawCh(getPosition(), '@', df::WHITE); }
};

/// Returns Marker::step as declared controls, with which a client need not wait for the server.
df::Controls markerControls() {
  using namespace df::Keyboard;
  return df::Controls()
      .onKey(RIGHTARROW)
      .step(1, 0)
      .onKey(DOWNARROW)
      .step(0, 1)
      .onKey(LEFTARROW)
      .step(-1, 0)
      .onKey(UPARROW)
      .step(0, -1);
}

/// Runs the crowd and handles keys.
class Director : public df::Object {
 public:
  Director(Truth& truth, std::uint64_t seed) : m_truth(truth), m_crowd(seed) {
    setSolidness(df::SPECTRAL);
    setVisible(false);
    for (const Walker& walker : m_crowd.walkers()) m_figures[walker.id] = new Figure(walker, 0);
    registerInterest(df::STEP_EVENT);
    registerInterest(df::JOIN_EVENT);
    registerInterest(df::LEAVE_EVENT);
    registerInterest(df::KEYBOARD_EVENT);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::STEP_EVENT) step();
    if (const auto* p_join = dynamic_cast<const df::EventJoin*>(p_e)) join(WM.getPlayer(p_join->getPlayer()));
    if (const auto* p_leave = dynamic_cast<const df::EventLeave*>(p_e)) {
      WM.markForDelete(WM.getPlayer(p_leave->getPlayer())->getObject());
    }
    if (const auto* p_key = dynamic_cast<const df::EventKeyboard*>(p_e)) press(*p_key);
    return 1;
  }

 private:
  void step() {
    const Nanoseconds start = monotonicNow();
    m_crowd.tick();
    m_truth.publish(m_crowd.ticks(), start, drawScene(m_crowd));
    std::map<std::uint32_t, Figure*> alive;
    for (const Walker& walker : m_crowd.walkers()) alive[walker.id] = figureOf(walker);
    for (const auto& [id, p_figure] : m_figures) {
      if (!alive.contains(id)) WM.markForDelete(p_figure);
    }
    m_figures.swap(alive);
    for (df::Player* p_player : WM.getPlayers()) {
      p_player->setText(kCounterText, df::Vector(0, kStatusRow), counterText(m_crowd.ticks()));
    }
  }

  Figure* figureOf(const Walker& walker) {
    const auto it = m_figures.find(walker.id);
    if (it == m_figures.end()) return new Figure(walker, 1);  // the tick's move is still to come
    assert(it->second->isInStep());
    it->second->follow(walker);
    return it->second;
  }

  static void join(df::Player* p_player) {
    p_player->setObject(new Marker);
    p_player->setControls(markerControls());
    p_player->setText(kEchoText, df::Vector(kEchoColumn, kStatusRow), std::string(1, kNoKey));
  }

  static void press(const df::EventKeyboard& key) {
    df::Player* p_player = WM.getPlayer(key.getPlayer());
    if (p_player == nullptr || key.getKeyboardAction() != df::KEY_PRESSED) return;
    using namespace df::Keyboard;
    if (key.getKey() >= A && key.getKey() <= Z) {
      const char letter = static_cast<char>('a' + (key.getKey() - A));
      p_player->setText(kEchoText, df::Vector(kEchoColumn, kStatusRow), std::string(1, letter));
      return;
    }
    if (key.isHandled()) return;
    if (auto* p_marker = dynamic_cast<Marker*>(p_player->getObject())) p_marker->step(key.getKey());
  }

  Truth& m_truth;
  Crowd m_crowd;
  std::map<std::uint32_t, Figure*> m_figures;
};

const char* need(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr) std::fprintf(stderr, "scene: %s is not set\n", name);
  return value;
}

}  // namespace

int main() {
  const char* file = need("NAIAD_SCENE_TRUTH");
  const char* seed = need("NAIAD_SCENE_SEED");
  if (file == nullptr || seed == nullptr || GM.startUp()) return 1;
  const auto truth = SharedFile<Truth>::create(file);
  new Director(*truth, std::strtoull(seed, nullptr, 10));
  GM.run();
  GM.shutDown();
  return 0;
}
