#include "Crowd.h"

#include <algorithm>
#include <cstdlib>

namespace bench::path {
namespace {

constexpr int kRight = (kWidth - 1) * kUnits;
constexpr int kBottom = (kHeight - 1) * kUnits;
constexpr int kAcross = kUnits / 2;  // fastest walk: half a cell per tick
constexpr int kDown = kUnits / 4;

constexpr std::uint32_t kTurnPerMille = 10;
constexpr std::uint32_t kChangePerMille = 20;
constexpr std::uint32_t kDiePerMille = 2;

}  // namespace

Crowd::Crowd(std::uint64_t seed) : m_state(seed * 0x9E3779B97F4A7C15u + 1) {
  for (int i = 0; i < kCrowd; ++i) m_walkers.push_back(newborn());
}

void Crowd::tick() {
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

bool Crowd::decide(Walker& walker) {
  if (chance(kDiePerMille)) return false;
  if (chance(kTurnPerMille)) turn(walker);
  if (chance(kChangePerMille)) walker.ch = static_cast<char>('A' + random(26));
  if (walker.x + walker.vx < 0 || walker.x + walker.vx > kRight) walker.vx = -walker.vx;
  if (walker.y + walker.vy < 0 || walker.y + walker.vy > kBottom) walker.vy = -walker.vy;
  return true;
}

void Crowd::turn(Walker& walker) {
  if (std::abs(walker.vx) == kUnits) {
    walker.vx = -walker.vx;
  } else if (walker.vx != 0 || walker.vy != 0) {
    walker.vx = within(kAcross);
    walker.vy = within(kDown);
  }
}

// Makes a walker so far from the edges that its first move stays inside.
Walker Crowd::newborn() {
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

int Crowd::within(int range) {
  return static_cast<int>(random(static_cast<std::uint32_t>(2 * range + 1))) - range;
}

// xorshift64*, Vigna 2016; the bias of the multiplication is below 2⁻²⁰ here.
std::uint32_t Crowd::random(std::uint32_t below) {
  m_state ^= m_state >> 12;
  m_state ^= m_state << 25;
  m_state ^= m_state >> 27;
  const std::uint64_t high = (m_state * 0x2545F4914F6CDD1Du) >> 32;
  return static_cast<std::uint32_t>((high * below) >> 32);
}

}  // namespace bench::path
