// The scene of the suite `path`: 200 coloured characters that walk about on 80×24, 30 times a second. All
// compared programs show this simulation. It depends only on its seed and the number of ticks.
//
// 80 % walk at up to ±0.5 cells per tick across and ±0.25 down, 10 % stand still, 10 % run at ±1 across. In
// each tick 1 % of them turn, 2 % change their character, 0.2 % die while another one is born elsewhere; at
// the edge of the screen they bounce.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "Picture.h"

namespace bench::path {

inline constexpr int kCrowd = 200;             ///< walkers
inline constexpr double kTicksPerSecond = 30;  ///< equal in all programs
inline constexpr int kUnits = 1024;            ///< units of position and velocity per cell

/// One character. Positions and velocities are in 1/1024 cell, so that fixed point and floating point both
/// move it exactly.
struct Walker {
  std::uint32_t id = 0;  ///< ascending by birth, never reused
  int x = 0;             ///< drawn in the cell floor(x / kUnits + 0.5)
  int y = 0;
  int vx = 0;  ///< units per tick
  int vy = 0;
  char ch = ' ';
  std::uint8_t color = 0;
};

class Crowd {
 public:
  explicit Crowd(std::uint64_t seed) : m_state(seed * 0x9E3779B97F4A7C15u + 1) {
    for (int i = 0; i < kCrowd; ++i) m_walkers.push_back(newborn());
  }

  /// First all walkers decide (turn, change, die, bounce), then all move by their velocities.
  void tick() {
    ++m_ticks;
    const auto dead =
        std::remove_if(m_walkers.begin(), m_walkers.end(), [this](Walker& w) { return !decide(w); });
    m_walkers.erase(dead, m_walkers.end());
    while (m_walkers.size() < kCrowd) m_walkers.push_back(newborn());
    for (Walker& walker : m_walkers) {
      walker.x += walker.vx;
      walker.y += walker.vy;
    }
  }
  /// Returns the number of ticks so far.
  std::uint32_t ticks() const { return m_ticks; }
  /// Returns the walkers in order of birth. Later ones are drawn over earlier ones.
  const std::vector<Walker>& walkers() const { return m_walkers; }

 private:
  static constexpr int kRight = (kWidth - 1) * kUnits;
  static constexpr int kBottom = (kHeight - 1) * kUnits;
  static constexpr int kAcross = kUnits / 2;  // fastest walk: half a cell per tick
  static constexpr int kDown = kUnits / 4;

  // xorshift64*, Vigna 2016; the bias of the multiplication is below 2⁻²⁰ here.
  std::uint32_t random(std::uint32_t below) {
    m_state ^= m_state >> 12;
    m_state ^= m_state << 25;
    m_state ^= m_state >> 27;
    const std::uint64_t high = (m_state * 0x2545F4914F6CDD1Du) >> 32;
    return static_cast<std::uint32_t>((high * below) >> 32);
  }
  bool chance(std::uint32_t per_mille) { return random(1000) < per_mille; }
  int within(int range) {
    return static_cast<int>(random(static_cast<std::uint32_t>(2 * range + 1))) - range;
  }
  // Makes a walker so far from the edges that its first move stays inside.
  Walker newborn() {
    Walker walker;
    walker.id = m_next_id++;
    walker.x = kUnits + static_cast<int>(random(kRight - 2 * kUnits));
    walker.y = kUnits + static_cast<int>(random(kBottom - 2 * kUnits));
    walker.ch = static_cast<char>('A' + random(26));
    walker.color = static_cast<std::uint8_t>(1 + random(7));
    const std::uint32_t kind = random(10);
    if (kind == 0) return walker;  // stands
    if (kind == 1) {
      walker.vx = random(2) == 0 ? kUnits : -kUnits;
    } else {
      walker.vx = within(kAcross);
      walker.vy = within(kDown);
    }
    return walker;
  }
  void turn(Walker& walker) {
    if (std::abs(walker.vx) == kUnits) {
      walker.vx = -walker.vx;
    } else if (walker.vx != 0 || walker.vy != 0) {
      walker.vx = within(kAcross);
      walker.vy = within(kDown);
    }
  }
  // Returns false if it died.
  bool decide(Walker& walker) {
    if (chance(2)) return false;
    if (chance(10)) turn(walker);
    if (chance(20)) walker.ch = static_cast<char>('A' + random(26));
    if (walker.x + walker.vx < 0 || walker.x + walker.vx > kRight) walker.vx = -walker.vx;
    if (walker.y + walker.vy < 0 || walker.y + walker.vy > kBottom) walker.vy = -walker.vy;
    return true;
  }

  std::uint64_t m_state;
  std::uint32_t m_ticks = 0;
  std::uint32_t m_next_id = 0;
  std::vector<Walker> m_walkers;
};

}  // namespace bench::path
