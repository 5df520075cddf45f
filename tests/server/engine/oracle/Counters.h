// Counters of what happened in the oracle's world, to show that a test covered every case.
#pragma once

#include <cstdint>

namespace oracle {

struct Counters {
  std::int64_t moves = 0;         ///< calls of moveObject(), by update() and by handlers
  std::int64_t nested_moves = 0;  ///< moves made in a handler of another move
  std::int64_t too_deep = 0;      ///< moves refused because of kDeepestMove
  std::int64_t blocked_hard = 0;  ///< moves refused because a HARD mover touched a HARD Object
  std::int64_t blocked_soft = 0;  ///< moves refused because a no_soft mover touched a SOFT Object
  std::int64_t met_soft = 0;      ///< moves with collisions of a SOFT mover or other
  std::int64_t outs = 0;          ///< moves that sent an out event
  std::int64_t collisions = 0;    ///< pairs of mover and other to which collision events were sent

  // Options beyond the book.
  std::int64_t swept_moves = 0;       ///< moves tested along the whole path
  std::int64_t swept_blocked = 0;     ///< swept moves that were refused
  std::int64_t swept_stopped = 0;     ///< refused swept moves that advanced along the path
  std::int64_t swept_passed_on = 0;   ///< further searches after no pair blocked
  std::int64_t precise_pairs = 0;     ///< pairs with touching boxes and compared masks
  std::int64_t precise_rejected = 0;  ///< precise pairs that shared no cell
  std::int64_t rest_moves = 0;        ///< moves of resting Objects, made by update()
  std::int64_t rest_contacts = 0;     ///< rest moves that touched another Object
  std::int64_t moved_out = 0;         ///< pairs that did not block only because the mover moved out

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
