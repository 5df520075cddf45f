#include "Figures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "../server/games/HostedGame.h"
#include "Player.h"
#include "engine/world/InputQueue.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Views.h"

/// The games' main() functions, compiled into this program under other names.
int breakout_main();
int lander_main();
int platformer_main();
int saucershoot_main();

namespace naiad {
namespace {

using df::Keyboard::Key;
using Keys = std::set<Key>;

constexpr int kSettle = 24;  // ticks after a pattern before positions are compared
constexpr int kMinute = 1800;

int (*mainOf(const std::string& game))() {
  if (game == "breakout") return breakout_main;
  if (game == "lander") return lander_main;
  if (game == "platformer") return platformer_main;
  return saucershoot_main;
}

void removeAll(df::World& world, const char* type) {
  const df::ObjectList list = world.objects().objectsOfType(type);
  for (int i = 0; i < list.getCount(); ++i) world.objects().markForDelete(list[i]);
}

/// Hosts the game and joins it. Calls `play` once the player's Object exists.
void withPlayer(const std::string& game, std::uint64_t seed,
                const std::function<void(df::World&, std::uint32_t)>& play) {
  const auto joined = [&](df::World& world) {
    const std::uint32_t ann = world.input().join("ann", df::RED);
    if (game == "saucershoot") tap(world, ann, df::Keyboard::P);
    tick(world, game == "platformer" ? 40 : 3);
    play(world, ann);
  };
  hostGame(mainOf(game), seed, joined, game);
}

df::Object* objectOf(df::World& world, std::uint32_t player) {
  return world.views().player(player)->getObject();
}

// --- scripted patterns

/// Keys held for this many ticks.
struct Stroke {
  Keys keys;
  int ticks;
};

struct Pattern {
  std::vector<Stroke> strokes;
  bool tap = false;
  int direction = 1;  ///< direction of the last key
};

const std::vector<Pattern>& patterns() {
  static const Keys kRight{Key::RIGHTARROW}, kLeft{Key::LEFTARROW};
  static const Keys kBoth{Key::RIGHTARROW, Key::SPACE};
  static const std::vector<Pattern> s_patterns = {
      {{{kRight, 3}}, true},
      {{{kRight, 3}, {{}, 9}, {kRight, 3}}, true},
      {{{kRight, 3}, {{}, 9}, {kLeft, 3}}, true, -1},
      {{{kRight, 6}}},
      {{{kRight, 12}}},
      {{{kRight, 24}}},
      {{{kRight, 36}}},
      {{{kRight, 18}, {{}, 1}, {kLeft, 12}}, false, -1},
      {{{kRight, 10}, {kLeft, 10}, {kRight, 10}}},
      {{{kRight, 20}, {kBoth, 3}, {kRight, 12}}},
      {{{kRight, 20}, {kBoth, 3}, {{}, 1}}},
  };
  return s_patterns;
}

/// Position of the player's Object after each tick of the pattern, and whether a direction was held.
struct Track {
  std::vector<double> x;
  std::vector<bool> held;
};

Track follow(const std::string& game, const Pattern& pattern, const KeyMethod& method,
             const TypedKeyboard::Options& keyboard) {
  Track track;
  withPlayer(game, 1, [&](df::World& world, std::uint32_t ann) {
    if (game == "platformer") removeAll(world, "Spikes");
    if (game == "breakout") objectOf(world, ann)->setPosition(df::Vector(7, 23));
    if (game == "lander") {
      objectOf(world, ann)->setPosition(df::Vector(30, 3));
      objectOf(world, ann)->setVelocity(df::Vector());
    }
    Typist typist(world, ann, method, keyboard);
    // First holds a key that the games ignore, from which methods that learn get the keyboard's repeat delay.
    typist.hold({Key::X});
    for (int t = 0; t < 30; ++t) typist.tick();
    typist.hold({});
    for (int t = 0; t < 6; ++t) typist.tick();
    if (game == "lander") {
      objectOf(world, ann)->setPosition(df::Vector(30, 3));
      objectOf(world, ann)->setVelocity(df::Vector());
    }
    const auto go = [&](const Keys& keys, int ticks) {
      typist.hold(keys);
      for (int t = 0; t < ticks; ++t) {
        if (game == "saucershoot") removeAll(world, "Saucer");
        typist.tick();
        track.x.push_back(objectOf(world, ann)->getPosition().x());
        track.held.push_back(keys.contains(Key::RIGHTARROW) || keys.contains(Key::LEFTARROW));
      }
    };
    go({}, 1);
    for (const Stroke& stroke : pattern.strokes) go(stroke.keys, stroke.ticks);
    go({}, kSettle);
  });
  return track;
}

}  // namespace

const std::vector<std::string>& keyGames() {
  static const std::vector<std::string> s_games = {"platformer", "breakout", "lander", "saucershoot"};
  return s_games;
}

PatternFigures runPatterns(const std::string& game, const KeyMethod& method,
                           const TypedKeyboard::Options& keyboard) {
  PatternFigures figures;
  KeyMethod real;
  real.kitty = true;
  int taps = 0, holds = 0;
  for (const Pattern& pattern : patterns()) {
    const Track is = follow(game, pattern, method, keyboard);
    const Track should = follow(game, pattern, real, keyboard);
    const double off = pattern.direction * (is.x.back() - should.x.back());
    (pattern.tap ? taps : holds) += 1;
    (pattern.tap ? figures.tap_over : figures.hold_over) += std::max(off, 0.0);
    if (!pattern.tap) figures.behind += std::max(-off, 0.0);
    double moved = 0;
    for (std::size_t i = 1; i < is.x.size(); ++i) {
      const double step = std::abs(is.x[i] - is.x[i - 1]);
      moved += step;
      if (!pattern.tap && is.held[i] && step < 1e-9 && std::abs(should.x[i] - should.x[i - 1]) > 1e-9)
        figures.stalled += Typist::kTick.count();
    }
    if (moved < 1e-9) ++figures.missed;
  }
  figures.tap_over /= taps;
  figures.hold_over /= holds;
  figures.behind /= holds;
  figures.stalled /= holds;
  return figures;
}

// --- simulated players

namespace {

/// Fingers not faster than a person's: a pressed key stays down for at least kMinPress ticks.
class Hands {
 public:
  explicit Hands(Typist& typist) : m_typist(typist) {}

  void want(Keys keys) {
    for (const Key key : m_typist.fingers())
      if (m_age[key] < kMinPress) keys.insert(key);
    m_typist.hold(keys);
    for (const Key key : keys) ++m_age[key];
    for (auto& [key, age] : m_age)
      if (!keys.contains(key)) age = 0;
  }
  /// Returns how long the key has been down, in ticks.
  int age(Key key) { return m_age[key]; }

 private:
  static constexpr int kMinPress = 3;
  Typist& m_typist;
  std::map<Key, int> m_age;
};

/// Releases a held key and presses it again if nothing moves although it should, like people do.
class Impatience {
 public:
  /// True if the key should be released for now.
  bool gaveUp(bool wanted, bool moves, int key_age) {
    if (m_lift > 0) return --m_lift, true;
    m_still = wanted && !moves ? m_still + 1 : 0;
    // The cause may be the keyboard's repeat delay, which players know.
    if (m_still < kReaction || (key_age > 3 && key_age < kPause)) return false;
    m_still = 0;
    m_lift = 2;
    return true;
  }

 private:
  static constexpr int kReaction = 7;
  static constexpr int kPause = 18;
  int m_still = 0;
  int m_lift = 0;
};

/// Plays for this many ticks with the keys that `think` chooses for each.
PlayFigures play(Typist& typist, int ticks,
                 const std::function<Keys(int tick, Hands& hands, PlayFigures& figures)>& think) {
  PlayFigures figures;
  Hands hands(typist);
  for (int t = 0; t < ticks; ++t) {
    hands.want(think(t, hands, figures));
    typist.tick();
  }
  return figures;
}

/// Runs to the right and jumps over gaps and spikes.
PlayFigures playPlatformer(df::World& world, std::uint32_t ann, Typist& typist, df::Random& random) {
  Impatience impatience;
  double before = 0, ahead = 1.5;
  bool moved = false;
  int score = 0;
  return play(typist, kMinute, [&](int, Hands& hands, PlayFigures& figures) {
    const df::Object* p_runner = objectOf(world, ann);
    Keys keys;
    if (p_runner != nullptr) {
      const df::Vector at = p_runner->getPosition();
      const bool moves = at.x() > before;
      const bool step = isThere(df::Box(at + df::Vector(0.6, -0.3), 1, 0.6), "Ground");
      // People do not always jump at an equal distance.
      if (moves != moved) ahead = 0.3 + 0.05 * random.below(8);
      const bool gap = !isThere(df::Box(at + df::Vector(ahead, 0.6), 0.9, 1), "Ground");
      const bool sharp = isThere(df::Box(at + df::Vector(0.6, -0.3), ahead + 1.2, 0.6), "Spikes");
      const bool flies = p_runner->getVelocity().y() != 0;
      if (!impatience.gaveUp(true, moves, hands.age(Key::RIGHTARROW))) keys.insert(Key::RIGHTARROW);
      if ((step || ((gap || sharp) && moves)) && !flies) keys.insert(Key::SPACE);
      const int now = world.views().player(ann)->getScore();
      if (now >= score + 100) {
        ++figures.good;
      } else if (at.x() < before - 10) {
        ++figures.bad;
      }
      score = now;
      before = at.x();
      moved = moves;
    }
    return keys;
  });
}

/// Keeps the paddle under the ball: taps if it is near, holds if it is far.
PlayFigures playBreakout(df::World& world, std::uint32_t ann, Typist& typist, df::Random&) {
  Key way = df::Keyboard::UNDEFINED_KEY;
  bool flew = false;
  int bricks = world.objects().objectsOfType("Brick").getCount();
  return play(typist, kMinute, [&](int t, Hands&, PlayFigures& figures) {
    const df::ObjectList balls = world.objects().objectsOfType("Ball");
    const df::Object* p_paddle = objectOf(world, ann);
    Keys keys;
    if (!balls.isEmpty() && p_paddle != nullptr) {
      const df::Vector at = balls[0]->getPosition();
      const df::Vector v = balls[0]->getVelocity();
      const bool flies = v != df::Vector();
      if (flew && !flies) ++figures.bad;
      flew = flies;
      // The point where the ball comes down, if it hits no wall before.
      const double ticks = v.y() > 0 ? (22 - at.y()) / v.y() : 0;
      const double off =
          std::clamp(at.x() + v.x() * ticks, 5.0, 74.0) + (t / 90 % 5 - 2) - p_paddle->getPosition().x();
      const double enough = way == df::Keyboard::UNDEFINED_KEY ? 3 : 1;
      way = !flies || std::abs(off) < enough ? df::Keyboard::UNDEFINED_KEY
            : off > 0                        ? Key::RIGHTARROW
                                             : Key::LEFTARROW;
      if (way != df::Keyboard::UNDEFINED_KEY) keys.insert(way);
    }
    const int now = world.objects().objectsOfType("Brick").getCount();
    figures.good += std::max(bricks - now, 0);
    bricks = now;
    return keys;
  });
}

std::optional<df::Vector> nearestPad(df::World& world, double x) {
  std::optional<df::Vector> best;
  const df::ObjectList list = world.objects().objectsOfType("Ground");
  std::map<int, int> tops;
  for (int i = 0; i < list.getCount(); ++i)
    tops[static_cast<int>(list[i]->getPosition().x())] = static_cast<int>(list[i]->getPosition().y());
  for (const auto& [column, top] : tops) {
    // Pads are flat and eight wide, one in each stretch of 20.
    if (column % 20 != 6) continue;
    const df::Vector pad(column + 3.5, top);
    if (!best || std::abs(pad.x() - x) < std::abs(best->x() - x)) best = pad;
  }
  return best;
}

/// Flies by the instruments: first across, then down, slower near the ground.
PlayFigures playLander(df::World& world, std::uint32_t ann, Typist& typist, df::Random&) {
  bool wrecked = false;
  int score = 0;
  return play(typist, 2 * kMinute, [&](int, Hands&, PlayFigures& figures) {
    const df::Object* p_ship = objectOf(world, ann);
    Keys keys;
    if (p_ship != nullptr) {
      const bool wreck = p_ship->getSolidness() == df::SPECTRAL;
      if (wreck && !wrecked) ++figures.bad;
      wrecked = wreck;
      const df::Vector at = p_ship->getPosition(), v = p_ship->getVelocity();
      const auto pad = nearestPad(world, at.x());
      const double aside = pad->x() - at.x(), height = pad->y() - 1.5 - at.y();
      const double across = std::clamp(aside * 0.4, -2.5, 2.5) / 30;
      const double down = (std::abs(aside) > 2.5 ? 0.3 : std::clamp(height * 0.4, 0.8, 2.5)) / 30;
      const bool burns = typist.fingers().contains(Key::UPARROW);
      if (!wreck && v.y() > down - (burns ? 0.01 : 0)) keys.insert(Key::UPARROW);
      if (!wreck && v.x() > across + 0.02) keys.insert(Key::LEFTARROW);
      if (!wreck && v.x() < across - 0.02) keys.insert(Key::RIGHTARROW);
    }
    const int now = world.views().player(ann)->getScore();
    if (now > score) ++figures.good;
    score = now;
    return keys;
  });
}

/// Moves to the row of the nearest saucer and shoots.
PlayFigures playSaucerShoot(df::World& world, std::uint32_t ann, Typist& typist, df::Random&) {
  bool lost = false;
  int score = 0;
  return play(typist, kMinute, [&](int t, Hands&, PlayFigures& figures) {
    const df::Object* p_ship = objectOf(world, ann);
    Keys keys;
    if (p_ship == nullptr) {
      tap(world, ann, df::Keyboard::P);  // starts another round
    } else {
      if (!p_ship->isVisible() && !lost) ++figures.bad;
      lost = !p_ship->isVisible();
      const df::Vector at = p_ship->getPosition();
      const df::ObjectList saucers = world.objects().objectsOfType("Saucer");
      std::optional<df::Vector> target;
      for (int i = 0; i < saucers.getCount(); ++i) {
        const df::Vector s = saucers[i]->getPosition();
        if (s.x() < at.x() + 8 || s.x() > 78) continue;
        if (!target || s.x() < target->x()) target = s;
      }
      const bool moves = typist.fingers().contains(Key::UPARROW) || typist.fingers().contains(Key::DOWNARROW);
      const double dy = target ? target->y() - at.y() : 0;
      if (std::abs(dy) > (moves ? 0.8 : 1.8)) keys.insert(dy > 0 ? Key::DOWNARROW : Key::UPARROW);
      if (target && std::abs(dy) < 2 && t % 10 < 3) keys.insert(Key::SPACE);
      const int now = world.views().player(ann)->getScore();
      figures.good += std::max(now - score, 0);
      score = now;
    }
    return keys;
  });
}

}  // namespace

PlayFigures playGame(const std::string& game, const KeyMethod& method,
                     const TypedKeyboard::Options& keyboard) {
  PlayFigures sum;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    withPlayer(game, seed, [&](df::World& world, std::uint32_t ann) {
      Typist typist(world, ann, method, keyboard);
      const auto bot = game == "platformer" ? playPlatformer
                       : game == "breakout" ? playBreakout
                       : game == "lander"   ? playLander
                                            : playSaucerShoot;
      df::Random random(seed);
      const PlayFigures figures = bot(world, ann, typist, random);
      sum.good += figures.good;
      sum.bad += figures.bad;
    });
  }
  return sum;
}

}  // namespace naiad
