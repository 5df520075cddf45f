// Pauses the game when its key is pressed, and lets it go on when it is pressed again: no step events,
// nothing moves, no input but to Pause objects; the picture stays.
//
// With several players it is a vote: more than half of the players have to press the key, each once, within
// ten seconds of the one before. All of them read the count ("pause: 1 of 3"). A player that leaves loses
// their vote, and the others are counted again. When the last player leaves, the pause ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "EventKeyboard.h"
#include "Object.h"

/// The key that pauses if none is given.
#define DF_PAUSE_KEY df::Keyboard::PAUSE

namespace df {

class Pause : public Object {
 public:
  /// Pauses the game, and goes on, at this key (Keyboard::Key).
  explicit Pause(int init_pause_key = DF_PAUSE_KEY);
  /// The game goes on.
  ~Pause() override;
  Pause(const Pause&) = delete;
  Pause& operator=(const Pause&) = delete;

  int eventHandler(const Event* p_e) override;

 private:
  void vote(std::uint32_t player);
  void leave(std::uint32_t player);
  void count(std::size_t voters, bool announce);

  int m_pause_key;
  std::vector<std::uint32_t> m_votes;  ///< for the other state: players
  int m_voted_at = 0;                  ///< the step of the newest
};

}  // namespace df
