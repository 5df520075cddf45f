// What ships shoot: flies straight on until it hits a saucer or leaves the screen. Friends are not hit.
#pragma once

#include <cstdint>

#include "Color.h"
#include "Object.h"

class Bullet : public df::Object {
 public:
  /// Cells per tick across the screen.
  static constexpr double kSpeed = 2;

  /// Shot by `player`, from `position` in `direction` (of any length but zero).
  Bullet(std::uint32_t player, df::Color color, df::Vector position, df::Vector direction);

  int eventHandler(const df::Event* p_e) override;

 private:
  void hit(df::Object* p_other);

  std::uint32_t m_player;
  bool m_spent = false;
};
