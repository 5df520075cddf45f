// A small random world that reports itself as the engine does: the truth that publisher and sender are tested
// against. It knows nothing of collisions or games, only of what a WorldView may contain.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "engine/world/WorldView.h"
#include "shared/replica/Look.h"
#include "shared/values/Canvas.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {

struct WorldConfig {
  int width = 100;  ///< of the boundary, in cells; objects wander beyond it
  int height = 40;
  int view_width = 40;
  int view_height = 20;
  std::size_t objects = 40;  ///< alive at a time, about
  std::size_t players = 1;
  double turn = 0.03;      ///< probability per object and tick of a new velocity
  double block = 0.05;     ///< … of not moving though it wants to
  double restyle = 0.02;   ///< … of another look
  double reshape = 0.01;   ///< … of another box, solidness or altitude
  double vanish = 0.01;    ///< … of its death
  double animate = 0.15;   ///< share of the looks that change by themselves
  double hide = 0.01;      ///< … of becoming invisible, or visible again
  double scribble = 0.05;  ///< probability per tick that something draws outside any object
  double speech = 0.05;    ///< … that a player's text changes
  double refollow = 0.01;  ///< … that a player's view follows another object, or none
};

class SimulatedWorld {
 public:
  SimulatedWorld(const WorldConfig& config, std::uint64_t seed);

  /// One tick. `quiet`: nothing new happens, things only fly on.
  void tick(bool quiet = false);
  const df::WorldView& view() const { return m_view; }
  std::uint32_t tickNumber() const { return m_view.tick; }
  /// What a player ought to see: the commands of this tick, drawn in order, then the texts.
  df::Canvas picture(std::size_t player) const;

 private:
  struct Thing {
    df::ObjectFacts facts;
    bool alive = false;
    df::FixedVector velocity;  ///< what it wants; the facts say zero while it is blocked
    df::FixedVector acceleration;
    std::vector<df::DrawCommand> look;   ///< relative to the position
    std::shared_ptr<const Look> p_told;  ///< frames that take turns by themselves, instead
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
  std::vector<std::uint32_t> m_order;  ///< slots by creation order
  std::uint64_t m_next_order = 1;
  df::WorldView m_view;
};

/// A canvas as text, for failure messages: what is wanted and what is there, row by row where they differ.
std::string explain(const df::Canvas& wanted, const df::Canvas& seen);

}  // namespace naiad::test
