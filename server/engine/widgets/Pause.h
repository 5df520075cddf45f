// Pauses the game when its key is pressed, and continues it when the key is pressed again. During a pause
// there are no step events, nothing moves, and only Pause objects get input; the picture stays.
//
// With several players, the key is a vote: more than half of the players have to press it, each within ten
// seconds of the previous vote. All players see the count ("pause: 1 of 3"). When a player leaves, their vote
// is removed and the votes are counted again. When the last player leaves, the pause ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "EventKeyboard.h"
#include "Object.h"

/// Default pause key.
#define DF_PAUSE_KEY df::Keyboard::PAUSE

namespace df {

class Pause : public Object {
 public:
  /// Makes a Pause for this key (a Keyboard::Key).
  explicit Pause(int init_pause_key = DF_PAUSE_KEY);
  /// Ends the pause.
  ~Pause() override;
  Pause(const Pause&) = delete;
  Pause& operator=(const Pause&) = delete;

  int eventHandler(const Event* p_e) override;

 private:
  void vote(std::uint32_t player);
  void leave(std::uint32_t player);
  void count(std::size_t voters, bool announce);

  int m_pause_key;
  std::vector<std::uint32_t> m_votes;  ///< players that voted to pause or, in a pause, to continue
  int m_voted_at = 0;                  ///< getStepCount() at the newest vote
};

}  // namespace df
