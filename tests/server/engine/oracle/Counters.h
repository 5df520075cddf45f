// What happened in the oracle's world so far, to show that a test covered every case.
#pragma once

#include <cstdint>

namespace oracle {

struct Counters {
  std::int64_t moves = 0;         ///< calls of moveObject, by update and by handlers
  std::int64_t nested_moves = 0;  ///< of those: from a handler of another move
  std::int64_t too_deep = 0;      ///< of those: refused for the depth
  std::int64_t blocked_hard = 0;  ///< of those: refused, HARD onto HARD
  std::int64_t blocked_soft = 0;  ///< of those: refused, no soft onto SOFT
  std::int64_t met_soft = 0;      ///< of those: collided with SOFT, as mover or as other
  std::int64_t outs = 0;          ///< of those: sent an out event
  std::int64_t collisions = 0;    ///< pairs of mover and other that were sent collision events

  // Beyond the book.
  std::int64_t swept_moves = 0;       ///< of moves: tested along the whole path
  std::int64_t swept_blocked = 0;     ///< of those: refused
  std::int64_t swept_stopped = 0;     ///< of those: placed before what blocked, not where it began
  std::int64_t swept_passed_on = 0;   ///< searches of the rest of the path, because what blocked was gone
  std::int64_t precise_pairs = 0;     ///< pairs with touching boxes and compared masks
  std::int64_t precise_rejected = 0;  ///< of those: shared no cell
  std::int64_t rest_moves = 0;        ///< of moves: by update, of Objects that stand still
  std::int64_t rest_contacts = 0;     ///< of those: touched another
  std::int64_t moved_out = 0;         ///< pairs that would have blocked, but for the mover moving out

  Counters& operator+=(const Counters& other) {
    for (const auto member :
         {&Counters::moves, &Counters::nested_moves, &Counters::too_deep, &Counters::blocked_hard,
          &Counters::blocked_soft, &Counters::met_soft, &Counters::outs, &Counters::collisions,
          &Counters::swept_moves, &Counters::swept_blocked, &Counters::swept_stopped,
          &Counters::swept_passed_on, &Counters::precise_pairs, &Counters::precise_rejected,
          &Counters::rest_moves, &Counters::rest_contacts, &Counters::moved_out}) {
      this->*member += other.*member;
    }
    return *this;
  }
};

}  // namespace oracle
