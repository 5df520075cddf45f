// A small world in which only the events of a script happen. It reports its state to the publisher like the
// engine does.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "Script.h"
#include "engine/world/WorldView.h"
#include "shared/replica/Look.h"
#include "shared/values/Canvas.h"

namespace naiad::fuzz {

class ScriptedWorld {
 public:
  static constexpr std::size_t kThings = 16;  ///< limit of living objects
  static constexpr int kWidth = 120;          ///< width of the boundary, in cells
  static constexpr int kHeight = 50;
  static constexpr int kViewWidth = 30;
  static constexpr int kViewHeight = 12;

  ScriptedWorld();

  /// Applies one action to one object or the player. Two bytes of the script select the action and the
  /// object; more bytes are the action's parameters.
  void happen(Script& script);
  /// Moves all objects and draws everything.
  void tick();
  const df::WorldView& view() const { return m_view; }
  /// Returns the picture that the player should see.
  df::Canvas picture() const;

 private:
  struct Thing {
    df::ObjectFacts facts;
    bool alive = false;
    bool changed = false;
    std::vector<df::DrawCommand> look;   ///< characters drawn, relative to the position
    std::shared_ptr<const Look> p_told;  ///< animated frames instead of `look`, or null
  };

  void bear(Thing& thing, Script& script);
  void kill(Thing& thing);
  void place(Thing& thing, Script& script);
  void turn(Thing& thing, Script& script);
  void restyle(Thing& thing, Script& script);
  void animate(Thing& thing, Script& script);
  void reshape(Thing& thing, Script& script);
  void follow(const Thing& thing, Script& script);
  void speak(Script& script);
  void noteMoved(const Thing& thing);

  std::array<Thing, kThings> m_things;
  std::vector<df::ObjectKey> m_gone;     ///< objects deleted since the last tick
  std::vector<df::DrawCommand> m_loose;  ///< commands that draw outside any object in the next tick
  std::uint64_t m_next_order = 1;
  df::WorldView m_view;
};

}  // namespace naiad::fuzz
