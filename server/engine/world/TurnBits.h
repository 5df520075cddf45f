// Which turns Objects take in update(), as bits by place in the creation order: entry i has bit i % 64 of
// word i / 64, so that 64 Objects are classified at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace df {

struct TurnBits {
  using Words = std::vector<std::uint64_t>;

  Words turns;    ///< moves in update(): active, with a velocity, an acceleration or contacts at rest
  Words fliers;   ///< of these, SPECTRAL ones that only add their velocity
  Words walkers;  ///< of these, solid ones that use nothing beyond the book's test of where a move ends
  Words sequels;  ///< its slot is the one after that of the entry before
  Words blocked;  ///< its last move in update did not happen
  Words hearers;  ///< solid, active, and its class overrides eventHandler(): hears of collisions
  Words hards;    ///< active and HARD
  Words softs;    ///< active and SOFT

  static bool get(const Words& words, std::size_t i) { return (words[i / 64] >> (i % 64) & 1) != 0; }
  static void set(Words& words, std::size_t i, bool on) {
    const std::uint64_t bit = std::uint64_t{1} << (i % 64);
    std::uint64_t& word = words[i / 64];
    word = on ? word | bit : word & ~bit;
  }
  /// Make room for entry i, the last one.
  void grow(std::size_t i) {
    if (i % 64 != 0) return;
    for (Words* p_words : {&turns, &fliers, &walkers, &sequels, &blocked, &hearers, &hards, &softs})
      p_words->resize(i / 64 + 1);
  }
  /// Entry i is a gap. Its sequel bit stays, and means nothing without a turn.
  void clear(std::size_t i) {
    for (Words* p_words : {&turns, &fliers, &walkers, &blocked, &hearers, &hards, &softs})
      set(*p_words, i, false);
  }
};

}  // namespace df
