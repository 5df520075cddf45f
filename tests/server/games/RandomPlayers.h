// Players that press random keys, join and leave at random, and a hash of the pictures that they see.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Canvas.h"
#include "Random.h"
#include "World.h"
#include "engine/world/InputQueue.h"

namespace naiad {

/// Sends random key and mouse inputs, and lets players join and leave at random.
class RandomPlayers {
 public:
  RandomPlayers(df::World& world, std::uint64_t seed, std::size_t most)
      : m_world(world), m_random(seed), m_most(most) {}

  void play() {
    if (m_players.empty() || (m_players.size() < m_most && m_random.below(120) == 0)) join();
    if (m_players.size() > 1 && m_random.below(200) == 0) {
      m_world.input().leave(m_players.front());
      m_players.erase(m_players.begin());
    }
    for (const std::uint32_t player : m_players) {
      using df::Keyboard::Key;
      static constexpr Key kKeys[] = {
          df::Keyboard::SPACE,   df::Keyboard::W,         df::Keyboard::A,         df::Keyboard::S,
          df::Keyboard::D,       df::Keyboard::P,         df::Keyboard::LEFTARROW, df::Keyboard::RIGHTARROW,
          df::Keyboard::UPARROW, df::Keyboard::DOWNARROW, df::Keyboard::RETURN,    df::Keyboard::N};
      // Draws one number per statement, because the order in which arguments are evaluated is unspecified.
      if (m_random.below(4) == 0) {
        const auto action = static_cast<df::EventKeyboardAction>(m_random.below(3));
        const Key key = kKeys[m_random.below(12)];
        m_world.input().key(player, key, action);
      }
      if (m_random.below(16) == 0) {
        const int y = m_random.below(24);
        const int x = m_random.below(80);
        const auto action = static_cast<df::EventMouseAction>(m_random.below(3));
        m_world.input().mouse(player, action, df::Mouse::LEFT, x, y);
      }
    }
  }
  const std::vector<std::uint32_t>& players() const { return m_players; }

 private:
  void join() {
    const auto color = static_cast<df::Color>(df::RED + m_random.below(7));
    m_players.push_back(m_world.input().join("bot" + std::to_string(m_players.size()), color));
  }

  df::World& m_world;
  df::Random m_random;
  std::size_t m_most;
  std::vector<std::uint32_t> m_players;
};

/// A FNV-1a hash of the characters of pictures.
class PictureHash {
 public:
  void add(const df::Canvas& canvas) {
    for (const char ch : canvas.text()) m_sum = (m_sum ^ static_cast<unsigned char>(ch)) * 1099511628211u;
  }
  std::uint64_t value() const { return m_sum; }

 private:
  std::uint64_t m_sum = 14695981039346656037u;
};

}  // namespace naiad
