// A small random world that reports itself as the engine does. Publisher and sender are tested against it. It
// has no collisions or game rules, only the contents of a WorldView.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "engine/world/WorldView.h"
#include "host/snapshot/Publisher.h"
#include "shared/replica/Look.h"
#include "shared/values/Canvas.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {

struct WorldConfig {
  int width = 100;  ///< width of the boundary, in cells; objects wander beyond it
  int height = 40;
  int view_width = 40;
  int view_height = 20;
  std::size_t objects = 40;  ///< average number of live objects
  std::size_t players = 1;
  double turn = 0.03;      ///< probability, per object and tick, of a new velocity
  double block = 0.05;     ///< probability, per object and tick, of being blocked
  double restyle = 0.02;   ///< probability, per object and tick, of a new look
  double reshape = 0.01;   ///< probability, per object and tick, of a new box, solidness or altitude
  double vanish = 0.01;    ///< probability, per object and tick, of its death
  double animate = 0.15;   ///< share of looks that are animated
  double hide = 0.01;      ///< probability, per object and tick, of hiding or reappearing
  double scribble = 0.05;  ///< probability, per tick, of drawing outside all objects
  double speech = 0.05;    ///< probability, per tick, that a player's text changes
  double refollow = 0.01;  ///< probability, per tick, that a view follows another object or none
};

class SimulatedWorld {
 public:
  SimulatedWorld(const WorldConfig& config, std::uint64_t seed);

  /// Runs one tick. If `quiet`, nothing new happens and the objects only continue their motion.
  void tick(bool quiet = false);
  const df::WorldView& view() const { return m_view; }
  std::uint32_t tickNumber() const { return m_view.tick; }
  /// Returns the picture that a player should see: this tick's commands, drawn in order, then the texts.
  df::Canvas picture(std::size_t player) const;

 private:
  struct Thing {
    df::ObjectFacts facts;
    bool alive = false;
    df::FixedVector velocity;  ///< intended velocity; the facts say zero while it is blocked
    df::FixedVector acceleration;
    std::vector<df::DrawCommand> look;   ///< draw commands relative to the position
    std::shared_ptr<const Look> p_told;  ///< frames that replace `look` if it is animated
  };

  double between(double low, double high) { return low + m_rng.unit() * (high - low); }
  bool chance(double p) { return m_rng.unit() < p; }
  void bear();
  void kill(std::uint32_t slot);
  void follow(df::PlayerFacts& player);
  void turn(Thing& thing);
  void restyle(Thing& thing);
  void animate(Thing& thing);
  Selector pace(std::size_t frames);
  bool meddle(Thing& thing);
  bool move(Thing& thing, bool quiet);
  void scribble();
  void speak();
  void draw();

  WorldConfig m_config;
  SplitMix64 m_rng;
  std::vector<Thing> m_things;
  std::deque<std::uint32_t> m_free;
  std::vector<std::uint32_t> m_order;  ///< slots in creation order
  std::uint64_t m_next_order = 1;
  df::WorldView m_view;
};

/// A simulated world and its published models.
struct PublishedWorld : SimulatedWorld {
  using SimulatedWorld::SimulatedWorld;
  void tick(bool quiet = false) {
    SimulatedWorld::tick(quiet);
    publisher.update(view());
  }
  const df::PlayerFacts& player(std::size_t index = 0) const { return view().players[index]; }

  Publisher publisher;
};

/// Returns, as text for failure messages, the rows of both canvases that differ.
std::string explain(const df::Canvas& wanted, const df::Canvas& seen);

}  // namespace naiad::test
