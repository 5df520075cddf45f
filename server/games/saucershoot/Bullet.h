// A ship's shot. It flies straight until it hits a saucer or leaves the screen. It does not hit friends.
#pragma once

#include <cstdint>

#include "Color.h"
#include "Object.h"

class Bullet : public df::Object {
 public:
  /// Speed across the screen, in cells per tick.
  static constexpr double kSpeed = 2;

  /// Creates the shot of `player` at `position`, in `direction` (of any length except zero).
  Bullet(std::uint32_t player, df::Color color, df::Vector position, df::Vector direction);

  int eventHandler(const df::Event* p_e) override;

 private:
  void hit(df::Object* p_other);

  std::uint32_t m_player;
  bool m_spent = false;
};
