// Pauses the game when its key is pressed, and continues it when the key is pressed again. In between there
// are no step events, nothing moves, and only Pause objects get input; the picture stays.
//
// With several players it is a vote: more than half of the players have to press the key, each within ten
// seconds of the vote before. All of them read the count ("pause: 1 of 3"). A player that leaves loses their
// vote, and the others are counted again. When the last player leaves, the pause ends.
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
  /// Pauses and continues the game with this key (Keyboard::Key).
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
  std::vector<std::uint32_t> m_votes;  ///< players that want the other state
  int m_voted_at = 0;                  ///< step of the newest vote
};

}  // namespace df
